"""What goes into and comes out of the catalog: frozen rows.

`New…` records are what a caller hands in; the others are what the catalog returns. Times are aware UTC datetimes.
"""

from partwise.store.records.collections import AuditEntry, Collection, Person
from partwise.store.records.labels import LabelRevision, NewRevision, RevisionKind
from partwise.store.records.models import Embedding, FirstShape, Model, NewModel, QueueAnchor, QueueRow
from partwise.store.records.shapes import (
    IngestedShape,
    IngestOutcome,
    Mesh,
    MeshRole,
    NewMesh,
    NewShape,
    Shape,
    ShapeState,
)
from partwise.store.records.stages import (
    Block,
    Failure,
    FailureKind,
    NewBlock,
    NewFailure,
    NewScore,
    NewStageRun,
    RunStatus,
    Score,
    StageCount,
    StageRun,
)

__all__ = [
    "AuditEntry",
    "Block",
    "Collection",
    "Embedding",
    "Failure",
    "FailureKind",
    "FirstShape",
    "IngestOutcome",
    "IngestedShape",
    "LabelRevision",
    "Mesh",
    "MeshRole",
    "Model",
    "NewBlock",
    "NewFailure",
    "NewMesh",
    "NewModel",
    "NewRevision",
    "NewScore",
    "NewShape",
    "NewStageRun",
    "Person",
    "QueueAnchor",
    "QueueRow",
    "RevisionKind",
    "RunStatus",
    "Score",
    "Shape",
    "ShapeState",
    "StageCount",
    "StageRun",
]
