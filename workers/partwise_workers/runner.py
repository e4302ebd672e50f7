"""Drives tasks through actors and their results into blocks.

The driver holds ids and small summaries, never arrays, and takes tasks from an iterator as actors become free, so its
memory does not grow with the collection. Blocks are packed and published while actors work on.
"""

import logging
import time
from collections.abc import Iterator, Sequence

import ray

from partwise.config import StageLimits, WorkersConfig
from partwise.store.array_store import ArrayStore
from partwise.store.catalog import StageCatalog
from partwise.store.records import NewFailure
from partwise.workspace.progress import OnRunProgress, RunProgress
from partwise_workers.actors import Packer, StageWorker
from partwise_workers.cluster import Crew, cores, require_living_node, thread_environment
from partwise_workers.events import InFlight, OnEvent, StageDone, StageFailed, ignore_events
from partwise_workers.pool import Actor, ActorPool
from partwise_workers.publishing import AlsoPublish, Publisher, nothing_else
from partwise_workers.stage import Stage
from partwise_workers.supervision import Rules, limits_of
from partwise_workers.tasks import ShapeOutcome, ShapeTask

logger = logging.getLogger(__name__)

POLL_S = 1.0
"""How often deadlines are looked at while no actor has anything to report."""

MOURNING_POLL_S = 0.2
"""How often last words are looked for: they come through the array store, which announces nothing."""

UNRECORDED = {"enable_task_events": False}
"""Ray's own record of every call, which would outgrow all that the driver keeps; the catalog has what matters."""

PATIENCE_S = 60.0
"""Seconds without any process at work after which the log says what is waited for."""


class StageRunner:
    """One run of stages over many shapes. Use once: `run`, from within `cluster.connected()`.

    default_limits : of stages that the configuration does not know.
    """

    def __init__(
        self,
        catalog: StageCatalog,
        arrays: ArrayStore,
        array_url: str,
        stages: Sequence[Stage],
        config: WorkersConfig,
        also_publish: AlsoPublish = nothing_else,
        on_event: OnEvent = ignore_events,
        default_limits: StageLimits | None = None,
    ) -> None:
        self._catalog = catalog
        self._arrays = arrays
        self._array_url = array_url
        self._stages = list(stages)
        self._config = config
        self._publisher = Publisher(catalog, self._new_packer, stages, config.block_shapes, also_publish)
        self._on_event = on_event
        self._rules = Rules(
            {stage.name: limits_of(config.limits, stage.name, default_limits or StageLimits()) for stage in stages},
            {stage.name: stage.n_steps for stage in stages},
            config.max_attempts,
            config.recycle_after,
        )
        self._n_done = self._n_failed = self._n_in_flight = 0

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
            lambda actor_id: self._new_worker(actor_id, crew.n_threads),
            crew.n_actors,
            self._rules,
            self._arrays,
            self._on_event,
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
            self._note_in_flight(pool.n_in_flight)
            active_at = self._note_idleness(pool, active_at)
            timeout = MOURNING_POLL_S if pool.is_mourning else POLL_S
            ready, _ = ray.wait([*pool.references(), *self._publisher.references()], num_returns=1, timeout=timeout)
            self._publisher.collect(ready)
            for outcome in pool.collect(ready):
                self._record(outcome)
                on_progress(RunProgress(self._n_done, self._n_failed, n_total))
        self._note_in_flight(0)

    def _record(self, outcome: ShapeOutcome) -> None:
        failure = outcome.failure
        for result in outcome.results:
            self._publisher.add(outcome.shape_id, result, outcome.tries[result.stage])
            self._on_event(StageDone(result.stage, result.seconds))
        if failure is None:
            self._n_done += 1
            return
        self._n_failed += 1
        n_tries = outcome.tries[failure.stage]
        self._catalog.record_failure(
            NewFailure(
                outcome.shape_id, failure.stage, failure.key, failure.reason, n_tries, failure.seconds, failure.detail
            )
        )
        self._on_event(StageFailed(failure.stage, failure.kind))

    def _note_in_flight(self, n_in_flight: int) -> None:
        if n_in_flight != self._n_in_flight:
            self._n_in_flight = n_in_flight
            self._on_event(InFlight(n_in_flight))

    def _note_idleness(self, pool: ActorPool, active_at: float) -> float:
        """Says so once a minute while no process could be started yet; returns since when nothing runs.

        Raises WorkerError where none can be.
        """
        now = time.monotonic()
        if not pool.is_done or now - active_at < PATIENCE_S:
            return active_at if pool.is_done else now
        require_living_node()
        logger.warning("waiting for worker processes to start; has the cluster a free core?")
        return now

    def _new_worker(self, actor_id: str, n_threads: int) -> Actor:
        environment = {"env_vars": thread_environment(n_threads)}
        options = StageWorker.options(num_cpus=n_threads, max_restarts=0, runtime_env=environment, **UNRECORDED)
        return options.remote(self._array_url, self._stages, actor_id, self._rules.limits)

    def _new_packer(self) -> Actor:
        environment = {"env_vars": thread_environment(1)}
        return Packer.options(num_cpus=0, max_restarts=0, runtime_env=environment, **UNRECORDED).remote(self._array_url)
