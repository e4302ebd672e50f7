"""What driver and actors tell each other: ids, keys and small summaries, never arrays."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

from partwise.store.records import FailureKind, StageRun


@dataclass(frozen=True, slots=True)
class BlockRow:
    """Where a finished stage's arrays of one shape are: a published block and the shape's row in it."""

    block_name: str
    row: int


def block_row(run: StageRun | None) -> BlockRow | None:
    """Where a stage run's arrays are; None without a run or without arrays."""
    if run is None or run.block_name is None or run.row is None:
        return None
    return BlockRow(run.block_name, run.row)


@dataclass(frozen=True, slots=True)
class ShapeTask:
    """Stages to run on one shape, in order, each with its key; and where earlier stages' arrays are."""

    shape_id: int
    source_key: str
    source_object: str
    stage_keys: tuple[tuple[str, str], ...]
    finished: Mapping[str, BlockRow]


@dataclass(frozen=True, slots=True)
class StagedResult:
    """One stage's result of one shape, waiting in the staging area to be packed; `n_bytes` is that of its arrays."""

    stage: str
    key: str
    staged_as: str
    n_bytes: int
    seconds: float
    summary: Mapping[str, Any]


@dataclass(frozen=True, slots=True)
class StageCall:
    """One stage of a task, for one actor. Of earlier tries `failed_steps` ended the process, each with why.

    refused_steps : that earlier tries got through and the stage refused, each with its record of it.
    """

    task: ShapeTask
    stage: str
    key: str
    failed_steps: Mapping[str, str]
    refused_steps: Mapping[str, Mapping[str, Any]] = field(default_factory=dict)

    @property
    def name(self) -> "StagedName":
        """Where its result is staged."""
        return StagedName(self.stage, self.task.shape_id, self.key)


@dataclass(frozen=True, slots=True)
class StageFailure:
    """Why a stage gave up on a shape: one line for people; in `detail`, JSON-able, what else is known.

    detail : `traceback` where the cause was unforeseen; of a process that died `log`, the end of what it printed;
    `steps`, those that ended a process, each with why.
    """

    stage: str
    key: str
    kind: FailureKind
    reason: str
    seconds: float
    detail: Mapping[str, Any] = field(default_factory=dict)


@dataclass(frozen=True, slots=True)
class Started:
    """What an actor says once it is ready: the memory of its process, and the node that it is on, by Ray's name."""

    resident_bytes: int
    node_id: str


@dataclass(frozen=True, slots=True)
class StageReport:
    """What an actor says of a call: its result or its failure, and the memory that its process is left with."""

    result: StagedResult | StageFailure
    resident_bytes: int


@dataclass(frozen=True, slots=True)
class ShapeOutcome:
    """What became of one task; stages after a failure did not run. `tries` : of each stage."""

    shape_id: int
    results: tuple[StagedResult, ...]
    failure: StageFailure | None
    tries: Mapping[str, int]


@dataclass(frozen=True, slots=True)
class StagedName:
    """Where a result is staged. It holds the key, so that a restarted run finds what an earlier one had made."""

    stage: str
    shape_id: int
    key: str

    def __str__(self) -> str:
        return f"{self.stage}/{self.shape_id}-{self.key}"

    @classmethod
    def parse(cls, staged_as: str) -> "StagedName | None":
        """The inverse of `str`; None for a name of another make."""
        stage, slash, rest = staged_as.rpartition("/")
        shape_id, dash, key = rest.partition("-")
        return cls(stage, int(shape_id), key) if slash and dash and shape_id.isdecimal() else None
