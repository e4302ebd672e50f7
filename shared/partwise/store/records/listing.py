"""The table of shapes: filters, orders, pages, and orders that can be jumped into."""

from dataclasses import dataclass
from datetime import datetime

from partwise.store.records.shapes import Shape, ShapeState


@dataclass(frozen=True, slots=True)
class ShapeFilter:
    """What a shape must meet, all of it; None asks for nothing.

    part_id : its newest shown labels have this part. author_id : who made those. cluster : in the embedding.
    failed_stage : the stage that failed for it.
    """

    state: ShapeState | None = None
    part_id: int | None = None
    cluster: int | None = None
    author_id: int | None = None
    failed_stage: str | None = None


@dataclass(frozen=True, slots=True)
class ShapeOrder:
    """By the score of this name, ties by id, shapes without a score left out; by id where the name is None."""

    score_name: str | None = None
    descending: bool = False


@dataclass(frozen=True, slots=True)
class ListAnchor:
    """Where a page ended. `value` is the score in an order by score, else None."""

    shape_id: int
    value: float | None = None


@dataclass(frozen=True, slots=True)
class ListedShape:
    """A row of the table.

    author_id : of its newest shown labels. cluster : in the embedding. failed_stage : of its latest failure.
    value, model_version : of the score that the list is ordered by.
    """

    shape: Shape
    state: ShapeState
    author_id: int | None
    cluster: int | None
    failed_stage: str | None
    value: float | None
    model_version: int | None

    @property
    def anchor(self) -> ListAnchor:
        return ListAnchor(self.shape.id, self.value)


@dataclass(frozen=True, slots=True)
class Ordering:
    """Dense ranks 0 … n_shapes − 1 of a collection's shapes in an order, as it was at `built_at`.

    They are ascending; rank r of the descending order is n_shapes − 1 − r. `score_name` None is the order of ids.
    """

    id: int
    collection_id: int
    score_name: str | None
    n_shapes: int
    built_at: datetime
