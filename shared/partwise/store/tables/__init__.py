"""The catalog's tables as SQLAlchemy Core sees them. The migrations make them; a test checks that the two agree."""

from partwise.store.tables.base import UtcDateTime, metadata
from partwise.store.tables.collections import audit, collection, part, person
from partwise.store.tables.labels import label_part, label_revision, review
from partwise.store.tables.models import embedding, first_shape, model, score
from partwise.store.tables.shapes import block, mesh, shape, shape_mesh, stage_run

__all__ = [
    "UtcDateTime",
    "audit",
    "block",
    "collection",
    "embedding",
    "first_shape",
    "label_part",
    "label_revision",
    "mesh",
    "metadata",
    "model",
    "part",
    "person",
    "review",
    "score",
    "shape",
    "shape_mesh",
    "stage_run",
]
