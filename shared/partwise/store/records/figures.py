"""How a collection is doing, counted."""

from dataclasses import dataclass
from datetime import datetime


@dataclass(frozen=True, slots=True)
class LeaseCounts:
    """Leases that last, those of them of shapes loaded ahead, those past their time, and how many people hold one."""

    n_active: int
    n_prefetched: int
    n_expired: int
    n_people: int


@dataclass(frozen=True, slots=True)
class BlockTotal:
    """Blocks of one kind, of all collections."""

    kind: str
    n_blocks: int
    n_bytes: int


@dataclass(frozen=True, slots=True)
class PersonFigures:
    """What a person confirmed in some time.

    n_timed : of the confirmed, those of which it is known what they cost: seconds at work, presses.
    n_checks, area_agreement : blind checks, and their mean; None without any.
    """

    person_id: int
    name: str
    n_confirmed: int
    n_timed: int
    active_s: float
    n_clicks: int
    last_at: datetime
    n_checks: int
    area_agreement: float | None


@dataclass(frozen=True, slots=True)
class ModelRound:
    """A model, and how things were until the next one.

    train_s : seconds that training took, None if nobody noted it. n_scores, mean_score : of all shapes it scored.
    n_checks, area_agreement : blind checks while it was the newest, and their mean; None without any.
    """

    version: int
    trained_at: datetime
    train_s: float | None
    n_shapes: int
    n_scores: int
    mean_score: float | None
    n_checks: int
    area_agreement: float | None
