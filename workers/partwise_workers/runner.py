"""Drives tasks through actors and their results into blocks.

The driver holds ids and small summaries, never arrays, and takes tasks from an iterator as actors become free, so its
memory does not grow with the collection. Blocks are packed and published while actors work on.
"""

import logging
import time
from collections.abc import Iterator, Sequence

import ray

from partwise.config import WorkersConfig
from partwise.store.array_store import ArrayStore
from partwise.store.catalog import StageCatalog
from partwise.store.records import NewFailure
from partwise.workspace.progress import OnRunProgress, RunProgress
from partwise_workers.actors import Packer, StageWorker
from partwise_workers.cluster import Crew, cores, thread_environment
from partwise_workers.pool import Actor, ActorPool, Finished
from partwise_workers.publishing import AlsoPublish, Publisher, nothing_else
from partwise_workers.stage import Stage
from partwise_workers.tasks import ShapeTask

logger = logging.getLogger(__name__)

POLL_S = 1.0
"""How often deadlines are looked at while no actor has anything to report."""

PATIENCE_S = 60.0
"""Seconds without any process at work after which the log says what is waited for."""


class StageRunner:
    """One run of stages over many shapes. Use once: `run`, from within `cluster.connected()`."""

    def __init__(
        self,
        catalog: StageCatalog,
        arrays: ArrayStore,
        array_url: str,
        stages: Sequence[Stage],
        config: WorkersConfig,
        also_publish: AlsoPublish = nothing_else,
    ) -> None:
        self._catalog = catalog
        self._array_url = array_url
        self._stages = list(stages)
        self._config = config
        self._publisher = Publisher(catalog, arrays, self._new_packer, stages, config.block_shapes, also_publish)
        self._n_done = self._n_failed = 0

    def run(self, tasks: Iterator[ShapeTask], n_total: int, on_progress: OnRunProgress) -> RunProgress:
        """Works through the tasks. On Ctrl-C what is finished is still published before the interrupt goes on.

        Raises
        ------
        StoreError : a store is full or cannot be reached. Finished shapes stay staged: the next run takes them over.
        WorkerError : processes do not start, or the packer keeps dying.
        PartwiseError : a stage cannot be opened, as by a model that is not there.
        """
        crew = Crew.of(cores(), n_total, self._config.n_actors)
        pool = ActorPool(
            lambda: self._new_worker(crew.n_threads), crew.n_actors, self._config.deadline_s, self._config.max_attempts
        )
        try:
            self._work(pool, tasks, n_total, on_progress)
            self._publisher.flush()
        except KeyboardInterrupt:
            self._publisher.flush()
            raise
        finally:
            self._publisher.close()
            pool.close()
        return RunProgress(self._n_done, self._n_failed, n_total)

    def _work(self, pool: ActorPool, tasks: Iterator[ShapeTask], n_total: int, on_progress: OnRunProgress) -> None:
        task = next(tasks, None)
        active_at = time.monotonic()
        while task is not None or not pool.is_done:
            while task is not None and pool.has_room and self._publisher.has_room:
                pool.submit(task)
                task = next(tasks, None)
            active_at = self._note_idleness(pool, active_at)
            ready, _ = ray.wait([*pool.references(), *self._publisher.references()], num_returns=1, timeout=POLL_S)
            self._publisher.collect(ready)
            for finished in pool.collect(ready):
                self._record(finished)
                on_progress(RunProgress(self._n_done, self._n_failed, n_total))

    def _record(self, finished: Finished) -> None:
        outcome, failure = finished.outcome, finished.outcome.failure
        for result in outcome.results:
            self._publisher.add(outcome.shape_id, result, finished.attempts)
        if failure is None:
            self._n_done += 1
            return
        self._n_failed += 1
        detail = {"traceback": failure.detail} if failure.detail else {}
        self._catalog.record_failure(
            NewFailure(
                outcome.shape_id,
                failure.stage,
                failure.key,
                failure.reason,
                finished.attempts,
                failure.seconds,
                detail,
            )
        )

    def _note_idleness(self, pool: ActorPool, active_at: float) -> float:
        """Says so once a minute while no process could be started yet; returns since when nothing runs."""
        now = time.monotonic()
        if not pool.is_done or now - active_at < PATIENCE_S:
            return active_at if pool.is_done else now
        logger.warning("waiting for worker processes to start; has the cluster a free core?")
        return now

    def _new_worker(self, n_threads: int) -> Actor:
        environment = {"env_vars": thread_environment(n_threads)}
        options = StageWorker.options(num_cpus=n_threads, max_restarts=0, runtime_env=environment)
        return options.remote(self._array_url, self._stages)

    def _new_packer(self) -> Actor:
        environment = {"env_vars": thread_environment(1)}
        return Packer.options(num_cpus=0, max_restarts=0, runtime_env=environment).remote(self._array_url)
