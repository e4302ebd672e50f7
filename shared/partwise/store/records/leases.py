"""Work handed to people: what a claim asks for, and the leases that hold shapes."""

from dataclasses import dataclass
from datetime import datetime
from enum import StrEnum

from partwise.errors import ParameterError
from partwise.store.records.shapes import ShapeState

MAX_HELD = 4
"""Shapes that a person may hold at once, beside one that is prefetched."""


DEFAULT_RANKING = "entropy"
"""The score that ranks where no ranking is on record yet."""


class LeasePurpose(StrEnum):
    """What becomes of the labels that a lease leads to. Never told to the person who holds it.

    label : they are the shape's labels.
    independent : they are one of several people's, which are compared before any becomes the shape's.
    blind : they are measured against a reference, and never become the shape's.
    """

    LABEL = "label"
    INDEPENDENT = "independent"
    BLIND = "blind"


class LeaseOutcome(StrEnum):
    """How a lease ended.

    released : given back. skipped : given back for good, with a reason. completed : its labels were confirmed.
    expired : not renewed in time, and found so by a later claim. cleared : taken away by an operator.
    """

    RELEASED = "released"
    SKIPPED = "skipped"
    COMPLETED = "completed"
    EXPIRED = "expired"
    CLEARED = "cleared"


@dataclass(frozen=True, slots=True)
class NewClaim:
    """A wish for the next shape of a collection.

    lease_s : seconds until the lease expires unless it is renewed, above 0.
    draw : uniform in [0, 1), from the caller's generator: below the collection's `honeypot_share` it asks for a shape
        with a reference.
    is_prefetch : the shape is to be loaded ahead, while the person is still at another.

    Raises
    ------
    ParameterError : lease_s or draw out of range.
    """

    collection_id: int
    person_id: int
    lease_s: float
    draw: float
    is_prefetch: bool = False

    def __post_init__(self) -> None:
        check_lease_time(self.lease_s)
        if not 0 <= self.draw < 1:
            raise ParameterError(f"draw must be in [0, 1) but is {self.draw}; take it from rng.random()")


@dataclass(frozen=True, slots=True)
class Lease:
    """A shape in a person's hands; active while `released_at` is None, and free to others once `expires_at` is past.

    slot : which of the labels that the shape is to get, from 0.
    round : how often the shape went into the queue, from 1; it goes again when labels are sent back.
    reason : of a skip, in the person's words.
    rank : its place in the queue when it was leased, from 1; None if it did not wait there, or far behind.
    score_name, score, model_version : the score that ranks, as it was then, and which model's it was.
    """

    id: int
    collection_id: int
    shape_id: int
    slot: int
    round: int
    person_id: int
    purpose: LeasePurpose
    is_prefetched: bool
    acquired_at: datetime
    expires_at: datetime
    released_at: datetime | None
    outcome: LeaseOutcome | None
    reason: str | None
    rank: int | None = None
    score_name: str | None = None
    score: float | None = None
    model_version: int | None = None


@dataclass(frozen=True, slots=True)
class LeasedShape:
    """A lease with what its holder goes on with. draft_id : the holder's open draft of the shape, None without one."""

    lease: Lease
    source_key: str
    state: ShapeState
    mesh_hash: str | None
    draft_id: int | None


@dataclass(frozen=True, slots=True)
class SkippedShape:
    """A shape that a person gave back for good. reason : in their words."""

    lease_id: int
    shape_id: int
    source_key: str
    person_id: int
    person_name: str
    reason: str
    skipped_at: datetime


@dataclass(frozen=True, slots=True)
class QueueDepth:
    """What waits in a collection's queue.

    n_free, n_held : (shape, slot) pairs; what nobody renewed in time is free. n_assigned : of the free ones, those kept
    for one person.
    oldest_at : since when the free one that has waited longest is there, None if nothing waits.
    """

    n_free: int
    n_held: int
    n_assigned: int
    oldest_at: datetime | None


def check_lease_time(lease_s: float) -> None:
    """Raises `ParameterError` unless the lease lasts more than 0 and at most 86,400 s."""
    if not 0 < lease_s <= 86_400:
        raise ParameterError(f"a lease must last more than 0 and at most 86400 s but is {lease_s}; 300 is usual")
