"""What the machinery around stages takes of a shape: stages that compute nothing, through everything else as it is.

The catalog, planner, runner with its supervision, actors, staging, packer and publishing are those of a true
run. What is left out, and said apart, is what does not grow with the collection: starting Ray and the actors.
"""

import os
import time
from collections import defaultdict
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

import numpy as np

from partwise.store.array_store import ArrayStore
from partwise.store.records import Collection, NewShape
from partwise.workspace.progress import RunProgress
from partwise.workspace.workspace import Workspace, init_collection, open_workspace
from partwise_cli.bench.noop_stage import NOOP, NoopStage, noop_chain
from partwise_cli.bench.processes import ACTORS, DRIVER, Process, core_s_by_role, processes
from partwise_workers.actors import ACCOUNT
from partwise_workers.cluster import connected
from partwise_workers.metrics import RunMetrics
from partwise_workers.plan import plan_tasks
from partwise_workers.runner import StageRunner
from partwise_workers.sentinel import resident_bytes
from partwise_workers.staging import sweep_staging
from partwise_workers.tasks import ShapeTask

COLLECTION = "noop"
INGEST_BATCH = 1000
N_MEMORY_SAMPLES = 20
N_OBJECTS = 256
"""Objects that are staged, read and packed once more at the end, to time each step by itself."""

OnSeconds = Callable[[str, float, float], None]
"""(part, wall seconds, core seconds of this thread)"""


@dataclass(frozen=True, slots=True)
class MemorySample:
    """The driver's resident memory, in megabytes, when so many shapes were done."""

    n_done: int
    driver_mb: float


@dataclass(frozen=True, slots=True)
class SchedulingCost:
    """Milliseconds are per shape, over all of its stages.

    wall_ms : from the first finished shape to the last published block.
    core_ms : processor time of each kind of process, and "total".
    parts_wall_ms, parts_core_ms : of the driver. "rest" is Ray's calls, waiting for them, and book-keeping.
    once_ms : steps of actors and packer, timed one by one in this process: not part of the sums above.
    before_s : making the rows, starting Ray, the time until the first shape is done; the processor time that an actor
    takes to start, which falls due again for every `recycle_after` shapes.
    memory : over the run.
    """

    n_shapes: int
    n_stages: int
    n_actors: int
    n_failed: int
    wall_ms: float
    core_ms: dict[str, float]
    parts_wall_ms: dict[str, float]
    parts_core_ms: dict[str, float]
    once_ms: dict[str, float]
    before_s: dict[str, float]
    memory: tuple[MemorySample, ...]


def measure_scheduling(
    folder: Path, n_shapes: int, n_actors: int, n_stages: int, on_progress: Callable[[RunProgress], None]
) -> SchedulingCost:
    """Runs a chain of no-op stages over so many shapes, in a new workspace in an empty folder."""
    parts, before_s = _Parts(), {}
    init_collection(folder, COLLECTION, ["part"], {})
    with open_workspace(folder) as workspace:
        started = time.perf_counter()
        collection = add_rows(workspace, n_shapes)
        before_s["rows"] = time.perf_counter() - started
        stages = noop_chain(n_stages)
        with parts.timed("count"):
            n_total = sum(1 for _ in plan_tasks(workspace, collection, stages))
        started = time.perf_counter()
        with connected(n_cpus=n_actors):
            before_s["ray"] = time.perf_counter() - started
            run = _Run(workspace, collection, stages, n_actors, parts)
            result = run.go(n_total, on_progress)
        with parts.timed("sweep"):
            sweep_staging(workspace, collection, stages)
        once_s = _steps(workspace.arrays)
    before_s["first shape"] = run.first_at - run.started_at
    before_s["core of an actor's start"] = run.actor_start_core_s
    n_timed = max(1, n_shapes - 1)
    wall_s = run.ended_at - run.first_at
    own = {name: seconds for name, seconds in parts.core_s.items() if name not in ("count", "sweep")}
    driver_s = run.core_s.get(DRIVER, 0.0)
    core = {**run.core_s, "total": sum(run.core_s.values())}
    return SchedulingCost(
        n_shapes, n_stages, n_actors, result.n_failed,
        _ms(wall_s, n_timed),
        {role: _ms(seconds, n_timed) for role, seconds in core.items()},
        {name: _ms(seconds, n_shapes) for name, seconds in parts.wall_s.items()},
        {
            **{name: _ms(seconds, n_shapes) for name, seconds in parts.core_s.items()},
            "rest": _ms(max(0.0, driver_s - sum(own.values())), n_timed),
        },
        {name: round(1000 * seconds, 3) for name, seconds in once_s.items()},
        {name: round(seconds, 2) for name, seconds in before_s.items()},
        tuple(run.memory),
    )  # fmt: skip


def add_rows(workspace: Workspace, n_shapes: int) -> Collection:
    """Shapes without files: no-op stages never look at them."""
    collection = workspace.catalog.get_collection(COLLECTION)
    for start in range(0, n_shapes, INGEST_BATCH):
        numbers = range(start, min(start + INGEST_BATCH, n_shapes))
        workspace.catalog.add_shapes(
            collection.id, [NewShape(f"{number:07d}.off", f"{number:064x}", ".off") for number in numbers]
        )
    return collection


class _Parts:
    """Adds up the time of parts that take turns in one thread. A part within a part counts for the inner one."""

    def __init__(self) -> None:
        self.wall_s: dict[str, float] = defaultdict(float)
        self.core_s: dict[str, float] = defaultdict(float)
        self._open: list[str] = []
        self._at = (0.0, 0.0)

    def timed(self, name: str) -> "_Part":
        return _Part(self, name)

    def enter(self, name: str) -> None:
        self._settle()
        self._open.append(name)

    def leave(self) -> None:
        self._settle()
        self._open.pop()

    def _settle(self) -> None:
        now = (time.perf_counter(), time.thread_time())
        if self._open:
            self.wall_s[self._open[-1]] += now[0] - self._at[0]
            self.core_s[self._open[-1]] += now[1] - self._at[1]
        self._at = now


@dataclass(frozen=True, slots=True)
class _Part:
    parts: _Parts
    name: str

    def __enter__(self) -> None:
        self.parts.enter(self.name)

    def __exit__(self, *_: object) -> None:
        self.parts.leave()


class _Timed:
    """Stands in for a store: passes every call on and times it."""

    def __init__(self, inner: Any, parts: _Parts, name: str, on_publish: Callable[[], None] = lambda: None) -> None:
        self._inner = inner
        self._parts = parts
        self._name = name
        self._on_publish = on_publish

    def __getattr__(self, name: str) -> Any:
        method = getattr(self._inner, name)

        def timed(*args: Any, **kwargs: Any) -> Any:
            with self._parts.timed(self._name):
                result = method(*args, **kwargs)
            if name == "publish_block":
                self._on_publish()
            return result

        return timed


@dataclass(slots=True)
class _Run:
    """One run, with its clock started by the first shape that is done."""

    workspace: Workspace
    collection: Collection
    stages: tuple[NoopStage, ...]
    n_actors: int
    parts: _Parts
    started_at: float = 0.0
    first_at: float = 0.0
    ended_at: float = 0.0
    core_s: dict[str, float] = field(default_factory=dict)
    memory: list[MemorySample] = field(default_factory=list)
    _before: list[Process] = field(default_factory=list)
    _n_left: int = 0

    def go(self, n_total: int, on_progress: Callable[[RunProgress], None]) -> RunProgress:
        catalog: Any = _Timed(self.workspace.catalog, self.parts, "catalog", self._note_block)
        # an actor that is replaced is a start, not a shape: starts are said apart
        config = replace(self.workspace.config.workers, n_actors=self.n_actors, recycle_after=n_total + 1)
        url = self.workspace.array_url
        runner = StageRunner(catalog, self.workspace.arrays, url, self.stages, config, on_event=RunMetrics())

        def note(progress: RunProgress) -> None:
            self._note(progress)
            on_progress(progress)

        self._sample(0)
        self.started_at = time.perf_counter()
        return runner.run(self._tasks(replace(self.workspace, catalog=catalog)), n_total, note)

    def _tasks(self, workspace: Workspace) -> Iterator[ShapeTask]:
        tasks = plan_tasks(workspace, self.collection, self.stages)
        while True:
            with self.parts.timed("plan"):
                task = next(tasks, None)
            if task is None:
                return
            yield task

    def _note(self, progress: RunProgress) -> None:
        n_done = progress.n_done + progress.n_failed
        self._n_left = progress.n_total - n_done
        if n_done == 1:
            self._before = processes()
            self.first_at = time.perf_counter()
        if n_done % max(1, progress.n_total // N_MEMORY_SAMPLES) == 0 or self._n_left == 0:
            self._sample(n_done)

    @property
    def actor_start_core_s(self) -> float:
        """Processor seconds of an actor until the first shape was done."""
        return sum(process.core_s for process in self._before if process.role == ACTORS) / self.n_actors

    def _note_block(self) -> None:
        self.ended_at = time.perf_counter()
        if self._n_left == 0:
            self.core_s = core_s_by_role(self._before, processes())

    def _sample(self, n_done: int) -> None:
        self.memory.append(MemorySample(n_done, round(resident_bytes(os.getpid()) / 1e6, 1)))


def _steps(arrays: ArrayStore) -> dict[str, float]:
    """Seconds of one object's staging, reading and deletion, and of a block's writing for each of its shapes."""
    content = {"nothing": np.zeros((), dtype=np.uint8), ACCOUNT: np.zeros(64, dtype=np.uint8)}
    names = [f"step/{number}" for number in range(N_OBJECTS)]
    seconds = {}
    for step, do in (
        ("stage", lambda name: arrays.stage(name, content)),
        ("read staged", arrays.read_staged),
        ("delete staged", arrays.delete_staged),
    ):
        started = time.perf_counter()
        for name in names:
            do(name)
        seconds[step] = (time.perf_counter() - started) / N_OBJECTS
    shapes = [{"nothing": content["nothing"]}] * 64
    started = time.perf_counter()
    for _ in range(4):
        arrays.write_block(NOOP, shapes)
    seconds["write block, for each of 64 shapes"] = (time.perf_counter() - started) / (4 * 64)
    return seconds


def _ms(seconds: float, n_shapes: int) -> float:
    return round(1000 * seconds / n_shapes, 4)
