"""What was done to shapes: stage runs, blocks, scores."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from datetime import datetime
from enum import StrEnum
from typing import Any


class RunStatus(StrEnum):
    """How a stage run ended."""

    DONE = "done"
    FAILED = "failed"


class FailureKind(StrEnum):
    """What ended a stage that failed. On record as `kind` in the failure's detail."""

    ERROR = "error"  # it raised: the shape was refused, or nobody foresaw what happened
    DEADLINE = "deadline"
    MEMORY = "memory"
    CRASH = "crash"  # its process died by itself


@dataclass(frozen=True, slots=True)
class NewBlock:
    """A block as the array store wrote it; `kind` is a block kind's name, `checksum` what the store reported."""

    name: str
    kind: str
    n_shapes: int
    n_bytes: int
    checksum: str


@dataclass(frozen=True, slots=True)
class Block:
    id: int
    name: str
    kind: str
    n_shapes: int
    n_bytes: int
    checksum: str
    created_at: datetime


@dataclass(frozen=True, slots=True)
class NewStageRun:
    """A stage that is done for a shape. `key` hashes input content, parameters and the stage's code version.

    `row` is the shape's row in the block being published, None where the stage has no arrays. `summary` is small JSON.
    """

    shape_id: int
    stage: str
    key: str
    row: int | None = None
    attempts: int = 1
    seconds: float = 0.0
    summary: Mapping[str, Any] = field(default_factory=dict)


@dataclass(frozen=True, slots=True)
class NewFailure:
    """A stage that failed for a shape. `detail` is JSON: the parameters tried, the tail of the log."""

    shape_id: int
    stage: str
    key: str
    reason: str
    attempts: int = 1
    seconds: float = 0.0
    detail: Mapping[str, Any] = field(default_factory=dict)


@dataclass(frozen=True, slots=True)
class StageRun:
    """A stage run on record. For a failed run `summary` is the failure's detail and `reason` says why."""

    id: int
    shape_id: int
    stage: str
    key: str
    status: RunStatus
    reason: str | None
    attempts: int
    seconds: float
    summary: Mapping[str, Any]
    block_id: int | None
    block_name: str | None
    row: int | None
    finished_at: datetime
    is_superseded: bool


@dataclass(frozen=True, slots=True)
class Failure:
    """A failed run with the source it belongs to, for people to read."""

    run: StageRun
    source_key: str


@dataclass(frozen=True, slots=True)
class StageCount:
    """How many shapes of a collection have a current done run of a stage, and how many have a failed one."""

    stage: str
    n_done: int
    n_failed: int


@dataclass(frozen=True, slots=True)
class NewScore:
    """The value of a named acquisition score of a shape under a model."""

    shape_id: int
    model_id: int
    name: str
    value: float


@dataclass(frozen=True, slots=True)
class Score:
    shape_id: int
    model_id: int
    name: str
    value: float
    scored_at: datetime
