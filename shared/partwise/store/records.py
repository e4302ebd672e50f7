"""What goes into and comes out of the catalog: frozen rows.

`New…` records are what a caller hands in; the others are what the catalog returns. Times are aware UTC datetimes.
"""

from collections.abc import Mapping
from dataclasses import dataclass, field
from datetime import datetime
from enum import StrEnum
from typing import Any

import numpy as np
from jaxtyping import Integer

from partwise.errors import ParameterError
from partwise.store.reviews import RevisionOrigin


class ShapeState(StrEnum):
    """Where a shape stands, derived by one expression in `partwise.store.sql.state`; the first that holds.

    review : its newest human or imported labels wait for someone to look at them again: they are not trained on.
    confirmed : it has a label revision of kind human or imported.
    ready : its describe stage is done, so that it can be predicted, ranked and annotated.
    failed : a stage failed, and nothing above holds.
    new : it was ingested, no more.
    """

    NEW = "new"
    FAILED = "failed"
    READY = "ready"
    REVIEW = "review"
    CONFIRMED = "confirmed"


class RevisionKind(StrEnum):
    """Who made labels. Reference labels are ground truth for experiments: never trained on, never shown."""

    HUMAN = "human"
    IMPORTED = "imported"
    REFERENCE = "reference"


class MeshRole(StrEnum):
    """What a mesh is to its shape. One mesh is both where the original was taken as it is.

    original : the ingested file's own faces.
    working : the surface that is described, predicted and annotated.
    """

    ORIGINAL = "original"
    WORKING = "working"


class IngestOutcome(StrEnum):
    """What `add_shapes` did with one source.

    added : the source key was new.
    unchanged : the key is known and the content is the same.
    changed : the content differs; the row now has the new hash, so the stages after ingest run again.
    conflict : the content differs but a person has labelled the shape; the row is left as it was.
    """

    ADDED = "added"
    UNCHANGED = "unchanged"
    CHANGED = "changed"
    CONFLICT = "conflict"


class RunStatus(StrEnum):
    """How a stage run ended."""

    DONE = "done"
    FAILED = "failed"


class FailureKind(StrEnum):
    """What ended a stage that failed. On record as `kind` in the failure's detail."""

    ERROR = "error"  # it raised: the shape was refused, or nobody foresaw what happened
    DEADLINE = "deadline"
    MEMORY = "memory"
    CRASH = "crash"  # its process died by itself


@dataclass(frozen=True, slots=True)
class Collection:
    """A set of shapes that share a part schema. `settings` is JSON, such as {"upright": true, "up": "y"}."""

    id: int
    name: str
    settings: Mapping[str, Any]
    schema_version: int
    created_at: datetime


@dataclass(frozen=True, slots=True)
class Person:
    id: int
    name: str
    created_at: datetime


@dataclass(frozen=True, slots=True)
class NewShape:
    """A source to ingest: its key within the collection (a relative path), its content hash, its suffix (".off").

    Raises
    ------
    ParameterError : a key that is no plain relative path: files are written under it when labels are exported.
    """

    source_key: str
    source_hash: str
    source_suffix: str

    def __post_init__(self) -> None:
        segments = self.source_key.split("/")
        if not self.source_key.isprintable() or "\\" in self.source_key or {"", ".", ".."} & set(segments):
            raise ParameterError(
                f"a source key must be a relative path of plain names but is {self.source_key!r}; rename the file"
            )


@dataclass(frozen=True, slots=True)
class Shape:
    """An ingested source. The hashes are those of its present working mesh and of the file's own; None before."""

    id: int
    collection_id: int
    source_key: str
    source_hash: str
    source_suffix: str
    ingested_at: datetime
    mesh_hash: str | None = None
    original_mesh_hash: str | None = None


@dataclass(frozen=True, slots=True)
class IngestedShape:
    """What became of one `NewShape`. `previous_hash` is the hash on record when the content differs."""

    shape_id: int
    source_key: str
    outcome: IngestOutcome
    previous_hash: str | None = None


@dataclass(frozen=True, slots=True)
class NewMesh:
    """A mesh of a shape in row `row` of the block that is being published; the shape's present one in that role."""

    shape_id: int
    mesh_hash: str
    n_vertices: int
    n_faces: int
    row: int
    role: MeshRole = MeshRole.WORKING


@dataclass(frozen=True, slots=True)
class Mesh:
    """A mesh that a shape has or had. It lies in row `row` of block `block_name`, or under `kept_key`, or both."""

    shape_id: int
    mesh_hash: str
    n_vertices: int
    n_faces: int
    block_name: str | None
    row: int | None
    kept_key: str | None
    created_at: datetime


@dataclass(frozen=True, slots=True)
class NewBlock:
    """A block as the array store wrote it; `kind` is a block kind's name, `checksum` what the store reported."""

    name: str
    kind: str
    n_shapes: int
    n_bytes: int
    checksum: str


@dataclass(frozen=True, slots=True)
class Block:
    id: int
    name: str
    kind: str
    n_shapes: int
    n_bytes: int
    checksum: str
    created_at: datetime


@dataclass(frozen=True, slots=True)
class NewStageRun:
    """A stage that is done for a shape. `key` hashes input content, parameters and the stage's code version.

    `row` is the shape's row in the block being published, None where the stage has no arrays. `summary` is small JSON.
    """

    shape_id: int
    stage: str
    key: str
    row: int | None = None
    attempts: int = 1
    seconds: float = 0.0
    summary: Mapping[str, Any] = field(default_factory=dict)


@dataclass(frozen=True, slots=True)
class NewFailure:
    """A stage that failed for a shape. `detail` is JSON: the parameters tried, the tail of the log."""

    shape_id: int
    stage: str
    key: str
    reason: str
    attempts: int = 1
    seconds: float = 0.0
    detail: Mapping[str, Any] = field(default_factory=dict)


@dataclass(frozen=True, slots=True)
class StageRun:
    """A stage run on record. For a failed run `summary` is the failure's detail and `reason` says why."""

    id: int
    shape_id: int
    stage: str
    key: str
    status: RunStatus
    reason: str | None
    attempts: int
    seconds: float
    summary: Mapping[str, Any]
    block_id: int | None
    block_name: str | None
    row: int | None
    finished_at: datetime
    is_superseded: bool


@dataclass(frozen=True, slots=True)
class Failure:
    """A failed run with the source it belongs to, for people to read."""

    run: StageRun
    source_key: str


@dataclass(frozen=True, slots=True)
class StageCount:
    """How many shapes of a collection have a current done run of a stage, and how many have a failed one."""

    stage: str
    n_done: int
    n_failed: int


@dataclass(frozen=True, slots=True)
class NewScore:
    """The value of a named acquisition score of a shape under a model."""

    shape_id: int
    model_id: int
    name: str
    value: float


@dataclass(frozen=True, slots=True)
class Score:
    shape_id: int
    model_id: int
    name: str
    value: float
    scored_at: datetime


@dataclass(frozen=True, slots=True, eq=False)
class NewRevision:
    """Labels to commit: (m,) part ids in the face order of the mesh `mesh_hash`, 0 = unlabelled.

    origin : of labels that were moved from another mesh, how; then `parent_id` is the newest revision of its kinds.
    """

    shape_id: int
    mesh_hash: str
    kind: RevisionKind
    author_id: int
    schema_version: int
    labels: Integer[np.ndarray, " m"]
    parent_id: int | None = None
    origin: RevisionOrigin | None = None


@dataclass(frozen=True, slots=True)
class LabelRevision:
    """An immutable revision without its labels; `sha256` is that of the raw uint16 labels.

    origin : None for labels as someone made them; else how they were moved to this mesh.
    """

    id: int
    shape_id: int
    mesh_hash: str
    kind: RevisionKind
    parent_id: int | None
    author_id: int
    schema_version: int
    n_faces: int
    sha256: str
    created_at: datetime
    origin: RevisionOrigin | None = None


@dataclass(frozen=True, slots=True)
class NewModel:
    """A trained model: its recipe (JSON), where its weights are in the array store, and what it was trained on."""

    collection_id: int
    recipe: Mapping[str, Any]
    weights_key: str
    revision_ids: tuple[int, ...]


@dataclass(frozen=True, slots=True)
class Model:
    """`version` counts from 1 within the collection."""

    id: int
    collection_id: int
    version: int
    recipe: Mapping[str, Any]
    weights_key: str
    revision_ids: tuple[int, ...]
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


@dataclass(frozen=True, slots=True)
class AuditEntry:
    """Who did what to what; append-only."""

    id: int
    at: datetime
    actor: str
    action: str
    subject: str
    detail: Mapping[str, Any]
