"""Models, the selection, the embedding, and shapes in order of a score."""

from collections.abc import Mapping
from dataclasses import dataclass
from datetime import datetime
from typing import Any

from partwise.store.records.shapes import Shape, ShapeState


@dataclass(frozen=True, slots=True)
class NewModel:
    """A trained model: its recipe (JSON), where its weights are in the array store, and what it was trained on."""

    collection_id: int
    recipe: Mapping[str, Any]
    weights_key: str
    revision_ids: tuple[int, ...]


@dataclass(frozen=True, slots=True)
class Model:
    """`version` counts from 1 within the collection. n_shapes : that it learned from."""

    id: int
    collection_id: int
    version: int
    recipe: Mapping[str, Any]
    weights_key: str
    n_shapes: int
    trained_at: datetime


@dataclass(frozen=True, slots=True)
class FirstShape:
    """A shape proposed to be labelled first; `ordinal` counts from 0, `cluster` is the k-means cluster."""

    shape_id: int
    ordinal: int
    cluster: int


@dataclass(frozen=True, slots=True)
class Embedding:
    """Which stored embedding of a collection is current: a key of the array store."""

    collection_id: int
    key: str
    created_at: datetime


@dataclass(frozen=True, slots=True)
class QueueAnchor:
    """Where a page of the queue ended."""

    value: float
    shape_id: int


@dataclass(frozen=True, slots=True)
class QueueRow:
    """A scored shape in the queue. `anchor` continues the listing after it."""

    shape: Shape
    state: ShapeState
    value: float
    model_id: int
    model_version: int

    @property
    def anchor(self) -> QueueAnchor:
        return QueueAnchor(self.value, self.shape.id)
