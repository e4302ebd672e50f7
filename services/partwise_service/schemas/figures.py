"""Models, the embedding's map, and how a collection is doing."""

from datetime import datetime

from pydantic import JsonValue

from partwise.store.records import FailureKind, Model, ShapeState
from partwise_service.schemas.base import Answer


class ModelOut(Answer):
    """A trained model. `recipe`: what it was trained with and how well it did inside its training set."""

    id: int
    version: int
    n_shapes: int
    revision_ids: list[int]
    recipe: dict[str, JsonValue]
    trained_at: datetime

    @classmethod
    def of(cls, model: Model) -> "ModelOut":
        """The model as it is told."""
        return cls(**{name: getattr(model, name) for name in cls.model_fields})


class ModelsOut(Answer):
    """Newest first."""

    items: list[ModelOut]


class EmbeddingPage(Answer):
    """A page of the map in columns: shapes by id, where they lie along the two directions of most variance, clusters.

    embedding : changes when the map is made anew: then begin again. cluster : null where none is on record.
    first_shape_ids : those of the page that were chosen to be labelled first.
    """

    embedding: str
    n_shapes: int
    shape_ids: list[int]
    x: list[float]
    y: list[float]
    clusters: list[int | None]
    states: list[ShapeState]
    first_shape_ids: list[int]
    next: str | None


class StageFigures(Answer):
    """done, failed : shapes with a present result, and shapes given up. per_min : done a minute, over `window_min`."""

    stage: str
    done: int
    failed: int
    per_min: float


class QueueFigures(Answer):
    """free, held : labels that wait for a person, and that one is at. oldest_at : since when the oldest waits."""

    free: int
    held: int
    assigned: int
    oldest_at: datetime | None


class OpsOut(Answer):
    """states : shapes by state. failures : failed runs by kind. open_reviews : counted up to 1,000."""

    states: dict[ShapeState, int]
    stages: list[StageFigures]
    window_min: float
    failures: dict[FailureKind, int]
    queue: QueueFigures
    model_version: int | None
    open_reviews: int
