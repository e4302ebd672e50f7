"""A chain of two cheap stages whose behaviour is written in the source file, and workspaces to run it on.

The workers get the stages by value, as they cannot import this module.
"""

import ctypes
import errno
import mmap
import os
import signal
import sys
import threading
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import AbstractContextManager, ExitStack, contextmanager
from dataclasses import dataclass, field, replace
from functools import partial
from pathlib import Path

import numpy as np
import pytest
from ray import cloudpickle

from partwise.config import StageLimits
from partwise.errors import MeshError, NotFoundError
from partwise.store.array_store import ArrayStore
from partwise.store.blocks import BlockKind, Domain, Quantity
from partwise.store.records import Collection, StageRun
from partwise.workspace.ingest import ingest_folder
from partwise.workspace.progress import OnRunProgress, RunProgress
from partwise.workspace.workspace import Workspace, init_workspace, open_workspace
from partwise_workers.events import OnEvent, ignore_events
from partwise_workers.plan import plan_tasks
from partwise_workers.publishing import AlsoPublish, nothing_else
from partwise_workers.runner import StageRunner
from partwise_workers.stage import RunStage, ShapeInputs, Stage, StageResult

cloudpickle.register_pickle_by_value(sys.modules[__name__])

KIND = BlockKind("fake", (Quantity("values", Domain.FACE, "int64"),))


@dataclass(frozen=True)
class FakeStage:
    """The source says, as `stage: behaviour`, what happens there; without a word about a stage it does its work.

    log : folder that gets one file for every time that the stage does its work.
    """

    name: str
    reads: str | None
    log: str
    parameter: int = 0
    block_kind: BlockKind = KIND
    n_steps: int = 1
    opens: str = ""

    @property
    def identity(self) -> Mapping[str, object]:
        return {"parameter": self.parameter}

    @contextmanager
    def open(self, arrays: ArrayStore) -> Iterator[RunStage]:
        if self.opens == "refuses":
            raise NotFoundError("the model must be there but is not; train one")
        if self.opens == "lacks a library":
            raise ImportError("No module named 'embreex'")
        yield self._run
        note(self.log, f"closed-{self.name}")

    def _run(self, inputs: ShapeInputs) -> StageResult:
        data, source_key = inputs.source()
        behaviours = dict(line.split(": ") for line in data.decode().splitlines() if ": " in line)
        self._behave(behaviours.get(self.name, ""))
        self._take_steps(inputs, behaviours)
        note(self.log, f"{self.name}-{source_key}")
        values = np.frombuffer(data, dtype=np.uint8).astype(np.int64)
        if self.reads is not None:
            values = values + inputs.array(self.reads, "values")
        passed_over = {"failed_steps": dict(inputs.failed_steps), "refused_steps": dict(inputs.refused_steps)}
        summary = {"sum": int(values.sum()), **passed_over}
        return StageResult({"values": values * (1 + self.parameter)}, summary)

    def _take_steps(self, inputs: ShapeInputs, behaviours: Mapping[str, str]) -> None:
        """Steps `0`, `1`, …, until one does not fail; the source has their behaviour as `stage 0: behaviour`.

        The stage goes on after one that `is refused`.
        """
        if self.n_steps == 1:
            return
        for step in map(str, range(self.n_steps)):
            if step in inputs.failed_steps or step in inputs.refused_steps:
                continue
            behaviour = behaviours.get(f"{self.name} {step}", "")
            inputs.begin(step)
            self._behave(behaviour)
            if behaviour != "is refused":
                return
            note(self.log, f"refused-{step}")
            inputs.refuse(step, {"why": "it is not near enough"})
        raise MeshError("a step must be left but none is; look at the file")

    def _behave(self, behaviour: str) -> None:
        if behaviour:
            print(f"{self.name}: it {behaviour} now")  # noqa: T201 - what the log's tail is to hold
        if behaviour == "refuses":
            raise MeshError("a mesh must have faces but has none; was it cut off?")
        if behaviour == "crashes":
            raise ZeroDivisionError("first line\nsecond line")
        if behaviour == "dies" or (behaviour == "dies once" and note(self.log, f"died-{os.getpid()}", most=1)):
            os.kill(os.getpid(), signal.SIGKILL)
        if behaviour == "hangs":
            threading.Event().wait()
        if behaviour == "fills the disk":
            os.replace = os.fsync = refuse_for_want_of_room
        if behaviour in NATIVE:
            NATIVE[behaviour]()


def hang_with_the_interpreter() -> None:
    ctypes.PyDLL(None).sleep(10**6)  # unlike CDLL, holds the interpreter's lock all the while


def read_address_zero() -> None:
    ctypes.string_at(0)


def memory(n_bytes: int) -> mmap.mmap:
    """Memory that is there at once: to touch it page by page takes long on a busy machine."""
    return mmap.mmap(-1, n_bytes, flags=mmap.MAP_PRIVATE | mmap.MAP_ANONYMOUS | mmap.MAP_POPULATE)


def allocate_without_end() -> None:
    kept = []
    while True:
        kept.append(memory(32 * 1024**2))


def swell() -> None:
    threading.main_thread().kept = memory(250_000_000)  # as long as the process lives


NATIVE: dict[str, Callable[[], object]] = {
    "hangs with the interpreter": hang_with_the_interpreter,
    "reads address zero": read_address_zero,
    "allocates without end": allocate_without_end,
    "swells": swell,
    "aborts": os.abort,
    "exits": partial(os._exit, 7),
    "leaves": partial(sys.exit, 7),
}


def refuse_for_want_of_room(*_: object) -> None:
    raise OSError(errno.ENOSPC, "No space left on device")


def note(log: str, name: str, most: int = 10**6) -> bool:
    """Writes one more file `<name>.<number>`, unless there are `most` with the same word before the first dash."""
    folder = Path(log)
    n_before = sum(1 for path in folder.iterdir() if path.name.split("-")[0] == name.split("-")[0])
    if n_before >= most:
        return False
    (folder / f"{name}.{n_before}").touch()
    return True


@dataclass(frozen=True)
class Bench:
    """A workspace with one collection of fake shapes, and the chain of stages to run on it."""

    workspace: Workspace
    collection: Collection
    log: Path
    shapes: Mapping[str, int]
    stages: tuple[FakeStage, ...]
    limits: StageLimits = field(default_factory=StageLimits)

    def with_stages(self, **changes: Mapping[str, object]) -> "Bench":
        """The same bench with other stages: keyword `second={"parameter": 1}` changes the stage `second`."""
        return replace(self, stages=tuple(replace(stage, **changes.get(stage.name, {})) for stage in self.stages))

    def with_workers(self, **changes: object) -> "Bench":
        """The same bench with other `[workers]` settings."""
        config = self.workspace.config
        workers = replace(config.workers, **changes)
        return replace(self, workspace=replace(self.workspace, config=replace(config, workers=workers)))

    def with_limits(self, **changes: float) -> "Bench":
        """The same bench with other limits for all its stages."""
        return replace(self, limits=replace(self.limits, **changes))

    def run(
        self,
        on_progress: OnRunProgress = lambda progress: None,
        also_publish: AlsoPublish = nothing_else,
        on_event: OnEvent = ignore_events,
    ) -> RunProgress:
        """Runs what is not done yet on the connected Ray."""
        n_total = sum(1 for _ in self.plan())
        ws = self.workspace
        runner = StageRunner(
            ws.catalog, ws.arrays, ws.array_url, self.stages, ws.config.workers, also_publish, on_event, self.limits
        )
        return runner.run(self.plan(), n_total, on_progress)

    def plan(self, stages: Sequence[Stage] | None = None, earlier: Sequence[Stage] = ()) -> Iterator:
        return plan_tasks(self.workspace, self.collection, self.stages if stages is None else stages, earlier)

    def done(self, stage: str) -> dict[str, StageRun]:
        """The current run of each shape, by source key."""
        runs = self.workspace.catalog.stage_runs(self.shapes.values(), stage)
        return {key: runs[shape_id] for key, shape_id in self.shapes.items() if shape_id in runs}

    def failed(self, stage: str) -> dict[str, StageRun]:
        runs = self.workspace.catalog.failed_runs(self.shapes.values(), stage)
        return {key: runs[shape_id] for key, shape_id in self.shapes.items() if shape_id in runs}

    def values(self, stage: str, source_key: str) -> np.ndarray:
        run = self.done(stage)[source_key]
        assert run.block_name is not None
        assert run.row is not None
        return self.workspace.arrays.read(run.block_name, run.row, "values")

    def n_noted(self, word: str) -> int:
        """How often a stage did its work, or what else was noted by its first word."""
        return sum(1 for path in self.log.iterdir() if path.name.split("-")[0] == word)


MakeBench = Callable[[Mapping[str, str]], Bench]


@contextmanager
def open_bench(folder: Path, sources: Mapping[str, str]) -> Iterator[Bench]:
    """A workspace in `folder` with one shape per source: its key and what its file says."""
    for key, text in sources.items():
        path = folder / "sources" / key
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(f"this is {key}\n{text}\n", encoding="utf-8")
    log = folder / "log"
    log.mkdir()
    init_workspace(folder / "workspace")
    with open_workspace(folder / "workspace") as workspace:
        collection = workspace.catalog.create_collection("fakes", ["part"])
        ingest_folder(workspace, collection, folder / "sources")
        shapes = {shape.source_key: shape.id for shape in workspace.catalog.shapes(collection.id)}
        stages = (FakeStage("first", None, str(log)), FakeStage("second", "first", str(log)))
        yield Bench(workspace, collection, log, shapes, stages)


@pytest.fixture
def make_bench(tmp_path: Path) -> Iterator[MakeBench]:
    """Makes a bench of the sources given; once a test."""
    with ExitStack() as stack:
        yield lambda sources: stack.enter_context(open_bench(tmp_path, sources))


@pytest.fixture(scope="session")
def bench_in() -> Callable[[Path, Mapping[str, str]], AbstractContextManager[Bench]]:
    """As `make_bench`, for fixtures that last longer than a test."""
    return open_bench
