"""Drives tasks through actors: one shape per actor at a time, results packed into blocks, each published at once.

The driver holds ids and small summaries, never arrays, and takes tasks from an iterator as actors become free. An actor
that dies or outlasts its deadline is replaced and its shape tried again, a bounded number of times.
"""

import logging
import time
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field
from typing import Any

import ray
from ray.exceptions import RayError

from partwise.config import WorkersConfig
from partwise.store.array_store import ArrayStore, BlockAddress
from partwise.store.catalog import StageCatalog
from partwise.store.records import NewBlock, NewFailure, NewMesh, NewScore, NewStageRun
from partwise.workspace.progress import OnRunProgress, RunProgress
from partwise_workers.actors import Packer, ShapeOutcome, ShapeTask, StagedResult, StageFailure, StageWorker
from partwise_workers.cluster import ONE_THREAD, n_cores
from partwise_workers.stage import Stage

logger = logging.getLogger(__name__)

Actor = Any  # Ray gives the methods of actors no types

POLL_S = 1.0
"""How often deadlines are looked at while no actor has anything to report."""


@dataclass(frozen=True, slots=True)
class Published:
    """What else a stage's result puts on record beside its run: meshes it made, scores it gave."""

    meshes: tuple[NewMesh, ...] = ()
    scores: tuple[NewScore, ...] = ()


AlsoPublish = Callable[[int, StagedResult, int], Published]
"""(shape id, result, row in its block) → what else to publish with it."""


def nothing_else(shape_id: int, result: StagedResult, row: int) -> Published:  # noqa: ARG001 - the signature of AlsoPublish
    """For stages whose results are arrays only."""
    return Published()


@dataclass(slots=True)
class _Attempt:
    task: ShapeTask
    actor: Actor
    started: float
    number: int


@dataclass(slots=True)
class _Waiting:
    """Results of one stage that wait to fill a block."""

    results: list[tuple[int, StagedResult]] = field(default_factory=list)


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
        self._arrays = arrays
        self._array_url = array_url
        self._stages = {stage.name: stage for stage in stages}
        self._config = config
        self._also_publish = also_publish
        self._waiting = {stage.name: _Waiting() for stage in stages}
        self._running: dict[ray.ObjectRef[ShapeOutcome], _Attempt] = {}
        self._idle: list[Actor] = []
        self._packer: Actor | None = None

    def run(self, tasks: Iterator[ShapeTask], n_total: int, on_progress: OnRunProgress) -> RunProgress:
        """Works through the tasks. On Ctrl-C what is finished is still published before the interrupt goes on."""
        n_actors = min(self._config.n_actors or n_cores(), max(1, n_total))
        n_done = n_failed = 0
        try:
            self._packer = Packer.options(num_cpus=0).remote(self._array_url)
            self._idle = [self._new_actor() for _ in range(n_actors)]
            self._feed(tasks)
            while self._running:
                for outcome in self._finished():
                    self._collect(outcome)
                    n_done += outcome.failure is None
                    n_failed += outcome.failure is not None
                    on_progress(RunProgress(n_done, n_failed, n_total))
                self._feed(tasks)
        finally:
            self._publish_all()
            self._release()
        return RunProgress(n_done, n_failed, n_total)

    def _new_actor(self) -> Actor:
        options = StageWorker.options(num_cpus=1, max_restarts=0, runtime_env={"env_vars": ONE_THREAD})
        return options.remote(self._array_url, list(self._stages.values()))

    def _feed(self, tasks: Iterator[ShapeTask]) -> None:
        while self._idle:
            task = next(tasks, None)
            if task is None:
                return
            self._start(task, self._idle.pop(), number=1)

    def _start(self, task: ShapeTask, actor: Actor, number: int) -> None:
        self._running[actor.run.remote(task)] = _Attempt(task, actor, time.monotonic(), number)

    def _finished(self) -> list[ShapeOutcome]:
        """Outcomes that have come in; attempts whose actor died or was too slow are started again or given up."""
        ready, _ = ray.wait(list(self._running), num_returns=1, timeout=POLL_S)
        outcomes = []
        for reference in ready:
            attempt = self._running.pop(reference)
            try:
                outcomes.append(ray.get(reference))
                self._idle.append(attempt.actor)
            except RayError as error:
                outcomes += self._again(attempt, f"its process died: {_first_line(error)}")
        now = time.monotonic()
        late = [r for r, a in self._running.items() if now - a.started > self._config.deadline_s]
        for reference in late:
            attempt = self._running.pop(reference)
            ray.kill(attempt.actor)
            outcomes += self._again(attempt, f"it took longer than deadline_s = {self._config.deadline_s:g}")
        return outcomes

    def _again(self, attempt: _Attempt, why: str) -> list[ShapeOutcome]:
        logger.warning(
            "attempt failed", extra={"shape": attempt.task.source_key, "attempt": attempt.number, "why": why}
        )
        actor = self._new_actor()
        if attempt.number < self._config.max_attempts:
            self._start(attempt.task, actor, attempt.number + 1)
            return []
        self._idle.append(actor)
        stage, key = attempt.task.stage_keys[0]
        reason = f"{why}, {attempt.number} times; raise [workers] deadline_s or look at this shape's file"
        seconds = time.monotonic() - attempt.started
        return [ShapeOutcome(attempt.task.shape_id, (), StageFailure(stage, key, reason, seconds))]

    def _collect(self, outcome: ShapeOutcome) -> None:
        if outcome.failure is not None:
            f = outcome.failure
            detail = {"traceback": f.detail} if f.detail else {}
            self._catalog.record_failure(
                NewFailure(outcome.shape_id, f.stage, f.key, f.reason, seconds=f.seconds, detail=detail)
            )
        for result in outcome.results:
            waiting = self._waiting[result.stage].results
            waiting.append((outcome.shape_id, result))
            if len(waiting) >= self._config.block_shapes:
                self._publish(result.stage)

    def _publish_all(self) -> None:
        for stage in self._stages:
            self._publish(stage)

    def _publish(self, stage: str) -> None:
        """Packs what waits into one block and commits it; only then are the staged copies let go."""
        results, self._waiting[stage].results = self._waiting[stage].results, []
        if not results or self._packer is None:
            return
        kind = self._stages[stage].block_kind
        address: BlockAddress = ray.get(self._packer.pack.remote(kind, [result.staged_as for _, result in results]))
        extras = [self._also_publish(shape_id, result, row) for row, (shape_id, result) in enumerate(results)]
        self._catalog.publish_block(
            NewBlock(address.name, kind.name, address.n_shapes, address.n_bytes, address.checksum),
            [
                NewStageRun(shape_id, stage, result.key, row, seconds=result.seconds, summary=result.summary)
                for row, (shape_id, result) in enumerate(results)
            ],
            scores=[score for extra in extras for score in extra.scores],
            meshes=[mesh for extra in extras for mesh in extra.meshes],
        )
        for _, result in results:
            self._arrays.delete_staged(result.staged_as)

    def _release(self) -> None:
        for actor in [*self._idle, *(attempt.actor for attempt in self._running.values()), self._packer]:
            if actor is not None:
                ray.kill(actor)
        self._idle, self._running, self._packer = [], {}, None


def _first_line(error: Exception) -> str:
    lines = [line.strip() for line in str(error).splitlines() if line.strip()]
    return lines[0] if lines else type(error).__name__
