"""Models and the embedding's map."""

from datetime import datetime

from pydantic import JsonValue

from partwise.store.records import Model, ShapeState
from partwise_service.schemas.base import Answer


class ModelOut(Answer):
    """A trained model.

    n_shapes : that it learned from. recipe : what it was trained with and how well it did inside its training set.
    """

    id: int
    version: int
    n_shapes: int
    recipe: dict[str, JsonValue]
    trained_at: datetime

    @classmethod
    def of(cls, model: Model) -> "ModelOut":
        """The model as it is told."""
        return cls(**{name: getattr(model, name) for name in cls.model_fields})


class ModelsPage(Answer):
    """A page of models, newest first. `next` goes into `before` for the next page; null at the end."""

    items: list[ModelOut]
    next: str | None = None


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
