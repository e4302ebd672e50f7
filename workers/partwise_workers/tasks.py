"""What driver and actors tell each other: ids, keys and small summaries, never arrays."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from partwise.store.records import StageRun


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
class StageFailure:
    """Why a stage gave up on a shape: one line for people, and the traceback where the cause was unforeseen."""

    stage: str
    key: str
    reason: str
    seconds: float
    detail: str = ""


@dataclass(frozen=True, slots=True)
class ShapeOutcome:
    """What became of one task; stages after a failure did not run."""

    shape_id: int
    results: tuple[StagedResult, ...]
    failure: StageFailure | None = None


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
