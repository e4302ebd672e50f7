"""Shapes and their meshes."""

from dataclasses import dataclass
from datetime import datetime
from enum import StrEnum

from partwise.errors import ParameterError


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
