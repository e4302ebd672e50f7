"""Labels of models accepted in bulk, shapes put first, labels sent back many at a time."""

from datetime import datetime
from enum import StrEnum
from typing import Annotated

from pydantic import Field

from partwise.metrics.proportion import share_interval
from partwise.store.records import AcceptBatch
from partwise.store.reviews import ReviewReason
from partwise_service.schemas.base import NO_NUL, WHOLE, Answer, AnyId, Request

MAX_AT_ONCE = 500
MAX_SELECTED = 5_000
ShapeIds = Annotated[list[AnyId], Field(min_length=1, max_length=MAX_AT_ONCE)]


class ModelLabels(StrEnum):
    """Labels that a model made, before and after the graph cut."""

    PREDICTED = "predicted"
    REFINED = "refined"


class Accept(Request):
    """shape_ids : shapes that wait. recheck : how many of them, drawn at random, are labelled unknowing instead."""

    shape_ids: ShapeIds
    segmentation: Annotated[ModelLabels, Field(strict=False)]
    recheck: Annotated[int, Field(ge=0, le=MAX_AT_ONCE), WHOLE] = 0


class RefusedOut(Answer):
    """A shape that was left as it is, and why."""

    shape_id: int
    why: str


class AcceptedOut(Answer):
    """accepted : shapes whose labels they are now. rechecks : others that wait in the queue, among all that does."""

    batch_id: int
    accepted: list[int]
    refused: list[RefusedOut]
    rechecks: int


class AcceptBatchOut(Answer):
    """What was accepted at once, and how much of it is wrong.

    n_rechecks : shapes drawn to be labelled unknowing. n_rechecked : those that were. n_false : of these, the ones on
    which the accepted labels agree with the person's on less than `agreement` of the area.
    false_accept_rate, interval : n_false / n_rechecked and its 95 % interval (Wilson's); null before there is one.
    """

    id: int
    person_id: int
    person_name: str
    segmentation: ModelLabels
    agreement: float
    accepted_at: datetime
    n_accepted: int
    n_rechecks: int
    n_rechecked: int
    n_false: int
    false_accept_rate: float | None
    interval: tuple[float, float] | None

    @classmethod
    def of(cls, batch: AcceptBatch) -> "AcceptBatchOut":
        """The batch as it is told."""
        n_tried = batch.n_rechecked
        same = ("id", "person_id", "person_name", "segmentation", "agreement", "accepted_at")
        counts = ("n_accepted", "n_rechecked", "n_false")
        return cls(
            **{name: getattr(batch, name) for name in (*same, *counts)},
            n_rechecks=batch.n_drawn,
            false_accept_rate=batch.n_false / n_tried if n_tried else None,
            interval=share_interval(batch.n_false, n_tried) if n_tried else None,
        )


class Selection(Request):
    """Shapes that come first in the queue. k : only so many of them, as far apart on the map as can be."""

    shape_ids: Annotated[list[AnyId], Field(min_length=1, max_length=MAX_SELECTED)]
    k: Annotated[int, Field(ge=1, le=MAX_AT_ONCE), WHOLE] | None = None


class Selected(Answer):
    """Shapes that are first now; those that do not wait are left out."""

    shape_ids: list[int]


class BulkRejection(Request):
    """Why labels of these shapes are sent back. for_author : only whoever made them gets the shape again."""

    shape_ids: ShapeIds
    note: Annotated[str, NO_NUL, Field(min_length=1, max_length=2_000)]
    for_author: bool = False


class Rejected(Answer):
    rejected: list[int]
    refused: list[RefusedOut]


class ReviewAcceptance(Request):
    """Why the labels that are accepted wait; not those that were sent back."""

    reason: Annotated[ReviewReason, Field(strict=False)]


class ReviewsAccepted(Answer):
    n_accepted: int
