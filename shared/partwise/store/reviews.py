"""Labels that moved to another mesh, and labels that wait for someone to look at them again: frozen rows."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from datetime import datetime
from enum import StrEnum
from typing import Any

from partwise.errors import ParameterError


@dataclass(frozen=True, slots=True)
class RevisionOrigin:
    """How a revision came about that nobody made: the labels of `source_id`, on mesh `moved_from`, moved here.

    agreement : share of the labelled area in [0, 1] whose label survives from there to here and back.

    Raises
    ------
    ParameterError : agreement outside [0, 1].
    """

    moved_from: str
    source_id: int
    agreement: float

    def __post_init__(self) -> None:
        if not 0 <= self.agreement <= 1:  # also refuses NaN
            raise ParameterError(f"agreement must be a share in [0, 1] but is {self.agreement}; divide by the area")


class ReviewReason(StrEnum):
    """Why labels wait for someone to look at them.

    map-back : they were moved to another mesh and too little of them survived the way.
    schema : they were made under a part schema that has changed since.
    check : the collection has a reviewer look at everything that is confirmed.
    disagreement : several people labelled the shape, and too differently; these are the labels closest to the others.
    rework : a reviewer sent them back; better ones are awaited.
    """

    MAP_BACK = "map-back"
    SCHEMA = "schema"
    CHECK = "check"
    DISAGREEMENT = "disagreement"
    REWORK = "rework"


FOR_REVIEWERS = tuple(reason for reason in ReviewReason if reason is not ReviewReason.REWORK)
"""What a reviewer decides; labels that were sent back wait for whoever labels them anew."""


class ReviewOutcome(StrEnum):
    """How a review ended.

    accepted : someone looked and found the labels right as they are.
    corrected : newer labels took their place.
    superseded : the labels were moved to yet another mesh, where a review of its own opens if need be.
    rejected : someone looked and sent them back, which opens a review of reason rework.
    """

    ACCEPTED = "accepted"
    CORRECTED = "corrected"
    SUPERSEDED = "superseded"
    REJECTED = "rejected"


@dataclass(frozen=True, slots=True)
class NewReview:
    """Why a revision is to be looked at. `detail` is small JSON."""

    reason: ReviewReason
    detail: Mapping[str, Any] = field(default_factory=dict)


@dataclass(frozen=True, slots=True)
class Review:
    """A revision that waits, or waited, for someone to look at it; open while `resolved_at` is None.

    resolved_by : a person's id; None while open, or where the machine resolved it.
    """

    id: int
    collection_id: int
    shape_id: int
    revision_id: int
    reason: ReviewReason
    detail: Mapping[str, Any]
    created_at: datetime
    resolved_at: datetime | None
    resolved_by: int | None
    outcome: ReviewOutcome | None
