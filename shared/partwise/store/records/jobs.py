"""Jobs: work that the service asks for and the workers do."""

from collections.abc import Mapping
from dataclasses import dataclass
from datetime import datetime
from enum import StrEnum
from typing import Any


class JobKind(StrEnum):
    """What is to be done to a collection."""

    PREPROCESS = "preprocess"
    TRAIN = "train"
    EVALUATE = "evaluate"
    REFINE = "refine"
    EXPORT = "export"
    INGEST = "ingest"
    SELECT = "select"  # the first shapes, from an embedding that is fitted anew
    REFILL = "refill"  # of the queue, after the number of labels a shape gets was changed


COALESCED_KINDS = (JobKind.PREPROCESS, JobKind.TRAIN, JobKind.EVALUATE, JobKind.REFINE)
"""Kinds of which one waiting job is enough for all who ask: it works on what is there when it starts."""

BACKGROUND_KINDS = (JobKind.PREPROCESS, JobKind.EVALUATE, JobKind.REFINE)
"""Kinds that may take days, shape by shape: begun after all others, and stopped between two shapes for them."""


WHY = "why"
"""In the result of a job that could not be done: the reason, where it is for operators only."""


class JobState(StrEnum):
    """Where a job stands; the last three are final."""

    PENDING = "pending"
    RUNNING = "running"
    DONE = "done"
    FAILED = "failed"
    CANCELLED = "cancelled"


@dataclass(frozen=True, slots=True)
class Progress:
    """How far a job is. `n_total` is None while that is unknown; `message` is one line for people."""

    n_done: int = 0
    n_failed: int = 0
    n_total: int | None = None
    message: str = ""


@dataclass(frozen=True, slots=True)
class Job:
    """A job on record. `parameters` and `result` are small JSON, which may name files and places on machines.
    `progress` does not, as all who may see the collection read it.

    owner : the process that works on it, or did last. `heartbeat_at` is when it last said so.
    attempts : how often it was begun.
    cancel_requested : its owner is asked to stop.
    """

    id: int
    collection_id: int
    kind: JobKind
    parameters: Mapping[str, Any]
    state: JobState
    owner: str | None
    attempts: int
    progress: Progress
    result: Mapping[str, Any] | None
    cancel_requested: bool
    created_at: datetime
    started_at: datetime | None
    heartbeat_at: datetime | None
    finished_at: datetime | None

    @property
    def full_message(self) -> str:
        """The message with the reason that only operators are told, if there is one."""
        return str((self.result or {}).get(WHY, self.progress.message))

    @property
    def is_over(self) -> bool:
        return self.state in (JobState.DONE, JobState.FAILED, JobState.CANCELLED)


@dataclass(frozen=True, slots=True)
class WorkerUsage:
    """What a process that does jobs takes of its machine, and its run of those of the cluster.

    memory_bytes : of the process itself, in RAM. n_actors, actor_bytes : of the processes that compute for it.
    free_bytes : left on the disk of the array store; None where that is no folder of its machine.
    """

    memory_bytes: int
    n_actors: int = 0
    actor_bytes: int = 0
    free_bytes: int | None = None


@dataclass(frozen=True, slots=True)
class SeenWorker:
    """A process that does jobs. owner : as whose its jobs are on record. is_busy : at one now, of any collection."""

    owner: str
    usage: WorkerUsage
    seen_at: datetime
    is_busy: bool
