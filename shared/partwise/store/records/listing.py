"""The table of shapes: filters, orders, pages, and orders that can be jumped into."""

from dataclasses import dataclass
from datetime import datetime

from partwise.store.records.shapes import Shape, ShapeState

BY_NAME = "name"
"""In place of a score's name: the order of source keys."""

ANY_STAGE = "any"
"""In place of a stage's name: whichever it was."""


@dataclass(frozen=True, slots=True)
class ShapeFilter:
    """What a shape must meet, all of it; None asks for nothing.

    part_id : its newest shown labels have this part. author_id : who made those. cluster : in the embedding.
    failed_stage : the stage that failed for it, `ANY_STAGE` for whichever.
    name : a part of its source key, the letters A to Z in either case.
    """

    state: ShapeState | None = None
    part_id: int | None = None
    cluster: int | None = None
    author_id: int | None = None
    failed_stage: str | None = None
    name: str | None = None


@dataclass(frozen=True, slots=True)
class ShapeOrder:
    """By the score of this name, ties by id, shapes without a score left out.

    By id where the name is None, by source key where it is `BY_NAME`.
    """

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
class Holder:
    """Who has a shape in their hands. `expires_at` may be past: then it is theirs until somebody else claims it."""

    person_id: int
    name: str
    expires_at: datetime


@dataclass(frozen=True, slots=True)
class ShapeTile:
    """What it takes to draw a shape's tile, beside its row of the table.

    n_faces : of its present mesh. revision_id, author_name : of its newest shown labels.
    has_confirmed : those are on its present mesh.
    predicted_version, refined_version : the model version of its predicted and its refined labels, None where it has
        none on its present mesh.
    """

    n_faces: int | None
    revision_id: int | None
    author_name: str | None
    has_confirmed: bool
    predicted_version: int | None
    refined_version: int | None
    holders: tuple[Holder, ...]


@dataclass(frozen=True, slots=True)
class Ordering:
    """Dense ranks 0 … n_shapes − 1 of a collection's shapes in an order, as it was at `built_at`.

    They are ascending; rank r of the descending order is n_shapes − 1 − r. `score_name` as in `ShapeOrder`.
    """

    id: int
    collection_id: int
    score_name: str | None
    n_shapes: int
    built_at: datetime
