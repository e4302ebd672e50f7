"""What a run tells whoever watches it, as it happens: for metrics and for the view in the terminal.

Events name stages and kinds of failure, never shapes, so that whatever counts them stays small.
"""

from dataclasses import dataclass
from typing import Protocol, TypeAlias

from partwise.store.records import FailureKind


@dataclass(frozen=True, slots=True)
class StageDone:
    """A stage is done for one shape. seconds : its own work, without what was tried in vain before."""

    stage: str
    seconds: float


@dataclass(frozen=True, slots=True)
class StageFailed:
    """A shape is quarantined at a stage, after its last try."""

    stage: str
    kind: FailureKind


@dataclass(frozen=True, slots=True)
class ActorRestarted:
    """A process was replaced. kind : what ended it; None where it had only done its share and was recycled."""

    kind: FailureKind | None


@dataclass(frozen=True, slots=True)
class InFlight:
    """How many shapes are in the hands of the run, at work or between two tries. Told when it changes."""

    n: int


@dataclass(frozen=True, slots=True)
class ActorMemory:
    """Memory in RAM of all processes that work for the run together, as each told it last. Told when it changes."""

    n_actors: int
    resident_bytes: int


RunEvent: TypeAlias = StageDone | StageFailed | ActorRestarted | InFlight | ActorMemory


class OnEvent(Protocol):
    """Called in the driver between two looks at its actors: it should return at once."""

    def __call__(self, event: RunEvent, /) -> None: ...


def ignore_events(event: RunEvent, /) -> None:
    """Nobody watches."""
