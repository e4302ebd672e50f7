"""The queue: what is asked for, and what is held."""

from datetime import datetime
from typing import Annotated

from pydantic import Field

from partwise.store.records import LeasedShape, LeaseOutcome, QueueDepth, ShapeState
from partwise_service.schemas.base import NO_NUL, Answer, AnyId, Request

MAX_NAMED = 4
MAX_ASSIGNED = 500


class Claim(Request):
    """A wish for work. shape_ids : these shapes; without them, the next of the queue.

    is_prefetch : to be loaded ahead, while the caller is still at another shape.
    """

    collection_id: AnyId
    shape_ids: Annotated[list[AnyId], Field(max_length=MAX_NAMED, default_factory=list)]
    is_prefetch: bool = False


class Renewal(Request):
    """is_prefetched : false once the caller works on a shape that was loaded ahead; null leaves it."""

    is_prefetched: bool | None = None


class Skip(Request):
    """Why a shape cannot be labelled."""

    reason: Annotated[str, Field(min_length=1, max_length=2_000), NO_NUL]


class Reopening(Request):
    """for_person_id : only they get the shape; null: anybody."""

    for_person_id: AnyId | None = None


class Assignment(Request):
    """Shapes that wait, for one person, or with null for anybody again."""

    shape_ids: Annotated[list[AnyId], Field(min_length=1, max_length=MAX_ASSIGNED)]
    person_id: AnyId | None


class Assigned(Answer):
    """n_places : labels that are now kept so. Shapes that do not wait are left as they are."""

    n_places: int


class LeaseOut(Answer):
    """A shape in somebody's hands until `expires_at`; `outcome` once that has ended.

    rank : its place in the queue when it was handed out, from 1; null if it did not wait there, or far behind.
    score_name, score, model_version : the score that the queue is ranked by, as it was then, and the model it comes
        from; null before a model has seen the shape.
    draft_id : the caller's open draft of the shape, to be gone on with.
    """

    id: int
    collection_id: int
    shape_id: int
    source_key: str
    state: ShapeState
    mesh_hash: str | None
    person_id: int
    is_prefetched: bool
    acquired_at: datetime
    expires_at: datetime
    released_at: datetime | None
    outcome: LeaseOutcome | None
    reason: str | None
    rank: int | None
    score_name: str | None
    score: float | None
    model_version: int | None
    draft_id: int | None

    @classmethod
    def of(cls, leased: LeasedShape, caller_id: int) -> "LeaseOut":
        """The lease as it is told: never what it is for, and the draft to its holder only."""
        return cls(
            **{name: getattr(leased.lease, name) for name in _OF_LEASE},
            source_key=leased.source_key,
            state=leased.state,
            mesh_hash=leased.mesh_hash,
            draft_id=leased.draft_id if leased.lease.person_id == caller_id else None,
        )


_OF_LEASE = (
    "id",
    "collection_id",
    "shape_id",
    "person_id",
    "is_prefetched",
    "acquired_at",
    "expires_at",
    "released_at",
    "outcome",
    "reason",
    "rank",
    "score_name",
    "score",
    "model_version",
)


class EndedLease(Answer):
    """Of a refusal because the lease has ended. outcome : how; null if it lasts and something else is in the way."""

    outcome: LeaseOutcome | None


class LeasesOut(Answer):
    items: list[LeaseOut]


class RefusedClaim(Answer):
    """A shape that was asked for by name and not had, and why."""

    shape_id: int
    why: str


class Claimed(Answer):
    """What the caller holds by this claim; nothing if nothing is left for them."""

    items: list[LeaseOut]
    refused: list[RefusedClaim]


class QueueDepthOut(Answer):
    """What waits: labels that shapes still want, those being made, those kept for one person, the oldest one's age."""

    n_free: int
    n_held: int
    n_assigned: int
    oldest_at: datetime | None

    @classmethod
    def of(cls, depth: QueueDepth) -> "QueueDepthOut":
        """The depth as it is told."""
        return cls.model_validate(depth)
