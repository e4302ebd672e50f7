"""`Catalog`: everything a person made, and what the machine has done so far, as rows.

Each method is one transaction: when it returns, it is committed. Lists are pages in order of a key: pass the last key
of one page as `after` to get the next; an empty page is the end. Methods raise `NotFoundError` for an id or a name that
is not there and `StoreError` when the database cannot be reached or written, beside what they name themselves.
"""

from collections.abc import Collection as SizedIterable
from collections.abc import Mapping, Sequence
from typing import Any, Protocol

import numpy as np
from jaxtyping import UInt16

from partwise.labels.schema import PartSchema
from partwise.store.records import (
    AuditEntry,
    Block,
    Collection,
    Embedding,
    Failure,
    FailureKind,
    FirstShape,
    IngestedShape,
    LabelRevision,
    Mesh,
    Model,
    NewBlock,
    NewFailure,
    NewMesh,
    NewModel,
    NewRevision,
    NewScore,
    NewShape,
    NewStageRun,
    Person,
    QueueAnchor,
    QueueRow,
    RevisionKind,
    Score,
    Shape,
    ShapeState,
    StageCount,
    StageRun,
)
from partwise.store.reviews import NewReview, Review

SHOWN_KINDS = (RevisionKind.HUMAN, RevisionKind.IMPORTED)
"""Kinds of revision that may be shown and trained on."""


class CollectionCatalog(Protocol):
    """Collections, their parts, and people."""

    def create_collection(
        self, name: str, part_names: Sequence[str], settings: Mapping[str, Any] | None = None
    ) -> Collection:
        """A collection with schema version 1: parts 1 … n in the order given, in default colours.

        Raises `ConflictError` if the name is taken, `LabelError` for a bad or repeated part name.
        """
        ...

    def get_collection(self, name: str) -> Collection: ...

    def list_collections(self) -> Sequence[Collection]:
        """Every collection, by name."""
        ...

    def update_collection_settings(self, collection_id: int, settings: Mapping[str, Any]) -> Collection:
        """Set the keys given, leave the others, and put the change on the audit trail."""
        ...

    def parts(self, collection_id: int, version: int | None = None) -> PartSchema:
        """The part schema, the current version unless another is named."""
        ...

    def add_part(
        self,
        collection_id: int,
        name: str,
        colour: str | None = None,
        gloss: str = "",
        parent_id: int | None = None,
    ) -> PartSchema:
        """Add a part under the next free id and make the next schema version.

        Raises `ConflictError` if the name is taken, `LabelError` for a parent that is not in the schema.
        """
        ...

    def update_part(
        self,
        collection_id: int,
        part_id: int,
        *,
        name: str | None = None,
        colour: str | None = None,
        gloss: str | None = None,
        parent_id: int | None = None,
    ) -> PartSchema:
        """Rename, recolour or explain a part or put it below another; the schema version stays.

        What is None stays as it is; a `parent_id` of 0 puts the part at the top. Raises `ConflictError` if the name is
        taken, `LabelError` for a parent that is not in the schema or is below the part itself.
        """
        ...

    def remove_part(self, collection_id: int, part_id: int) -> PartSchema:
        """Leave a part out of the next schema version. Its id is never used again.

        Raises `ConflictError` for a part that other parts are below, or that the newest human or imported labels of any
        shape use; the message says of how many.
        """
        ...

    def add_person(self, name: str) -> Person:
        """`ConflictError` if the name is taken."""
        ...

    def get_person(self, name: str) -> Person: ...

    def list_people(self) -> Sequence[Person]:
        """Every person, by name."""
        ...


class ShapeCatalog(Protocol):
    """Shapes and their meshes."""

    def add_shapes(self, collection_id: int, batch: Sequence[NewShape]) -> Sequence[IngestedShape]:
        """Add what is new and report on each source in order; safe to repeat. See `IngestOutcome`."""
        ...

    def shape(self, shape_id: int) -> Shape: ...

    def shapes_by_id(self, shape_ids: SizedIterable[int]) -> Mapping[int, Shape]:
        """The shapes of these ids; unknown ids are left out."""
        ...

    def shape_by_key(self, collection_id: int, source_key: str) -> Shape: ...

    def shapes(
        self, collection_id: int, *, after: int = 0, limit: int = 1000, state: ShapeState | None = None
    ) -> Sequence[Shape]:
        """A page of shapes by id, of one state if given."""
        ...

    def shape_states(self, shape_ids: SizedIterable[int]) -> Mapping[int, ShapeState]:
        """The state of each shape; unknown ids are left out."""
        ...

    def state_counts(self, collection_id: int) -> Mapping[ShapeState, int]:
        """How many shapes of the collection are in each state; every state is a key."""
        ...

    def mesh(self, shape_id: int, mesh_hash: str) -> Mesh: ...

    def meshes(self, shape_ids: SizedIterable[int]) -> Mapping[int, Mesh]:
        """The present working mesh of each shape; shapes without one are left out."""
        ...

    def original_meshes(self, shape_ids: SizedIterable[int]) -> Mapping[int, Mesh]:
        """The mesh of each shape's file as it is; shapes of which none is on record are left out."""
        ...

    def keep_mesh(self, mesh_hash: str, kept_key: str) -> None:
        """Record that the bytes of a mesh are also kept under `kept_key`, because labels depend on them."""
        ...


class StageCatalog(Protocol):
    """What was done to each shape, and the blocks that hold the results."""

    def publish_block(
        self,
        block: NewBlock,
        runs: Sequence[NewStageRun],
        scores: Sequence[NewScore] = (),
        meshes: Sequence[NewMesh] = (),
    ) -> int:
        """Make a written block visible and return its id: block, done runs, scores and meshes in one transaction.

        Older done runs of the same shape and stage are superseded and its failed runs of that stage are cleared. A
        score replaces the shape's score of that name unless the one on record comes from a newer model.

        Raises `ConflictError` if the block's name is on record, `ParameterError` for a row outside the block or a score
        that is not finite.
        """
        ...

    def record_done(self, runs: Sequence[NewStageRun], scores: Sequence[NewScore] = ()) -> None:
        """As `publish_block`, for stages that have no arrays."""
        ...

    def record_failure(self, failure: NewFailure) -> None:
        """Quarantine a shape at a stage, with the reason. Never displaces a current done run."""
        ...

    def clear_failures(
        self,
        collection_id: int,
        stage: str | None = None,
        shape_ids: SizedIterable[int] | None = None,
        *,
        kind: FailureKind | None = None,
        reason_contains: str = "",
    ) -> int:
        """Forget failed runs so that they are tried again, those that meet all that is given; returns how many.

        kind : what the failure's detail says. reason_contains : any text, in either case of its letters.
        """
        ...

    def stage_runs(self, shape_ids: SizedIterable[int], stage: str) -> Mapping[int, StageRun]:
        """The current done run of each shape; shapes without one are left out."""
        ...

    def failed_runs(self, shape_ids: SizedIterable[int], stage: str) -> Mapping[int, StageRun]:
        """The latest failed run of each shape; shapes without one are left out."""
        ...

    def failures(
        self, collection_id: int, *, stage: str | None = None, after: int = 0, limit: int = 1000
    ) -> Sequence[Failure]:
        """A page of failed runs by run id."""
        ...

    def stage_counts(self, collection_id: int) -> Sequence[StageCount]:
        """How far each stage is, by stage name."""
        ...

    def block(self, name: str) -> Block: ...

    def visible_blocks(self, *, after: int = 0, limit: int = 1000) -> Sequence[Block]:
        """A page of all blocks on record by id."""
        ...

    def unused_blocks(self, *, limit: int = 1000) -> Sequence[Block]:
        """Blocks that no current run needs and that are not the only place of a mesh somebody labelled."""
        ...

    def supersede_block(self, name: str) -> int:
        """Record that a block's arrays are lost: its runs are current no more, so they will be done again.

        Returns how many runs that were.
        """
        ...

    def delete_blocks(self, names: SizedIterable[str]) -> None:
        """Forget blocks and their superseded runs. `ConflictError` if one is in use: then nothing is deleted."""
        ...


class LabelCatalog(Protocol):
    """Label revisions, which nothing ever changes or deletes."""

    def add_revision(self, revision: NewRevision, review: NewReview | None = None) -> LabelRevision:
        """Commit labels, and with them an audit entry and, if given, a review that keeps them out of training.

        Human or imported labels resolve the open reviews of those whose place they take. Moved labels take over the
        reviews that have nothing to do with the move.

        Raises `LabelError` if the mesh is not one of the shape's, there is not one label per face, an id is not in the
        schema version named, that version does not exist, the parent is not a revision of the same shape, or labels
        that are never shown are to be reviewed. Raises `ConflictError` for moved labels whose parent is not, or no
        longer, the newest revision of the shape.
        """
        ...

    def revision(self, revision_id: int) -> LabelRevision: ...

    def revisions(self, shape_id: int) -> Sequence[LabelRevision]:
        """Every revision of a shape, oldest first."""
        ...

    def labels(self, revision_id: int) -> UInt16[np.ndarray, " m"]:
        """The labels of a revision, checked against their checksum."""
        ...

    def head_revision(self, shape_id: int, kinds: Sequence[RevisionKind] = SHOWN_KINDS) -> LabelRevision | None:
        """The newest revision of these kinds."""
        ...

    def head_revisions(
        self, shape_ids: SizedIterable[int], kinds: Sequence[RevisionKind] = SHOWN_KINDS
    ) -> Mapping[int, LabelRevision]:
        """The newest revision of these kinds for each shape; shapes without one are left out."""
        ...

    def labelled_shapes(
        self,
        collection_id: int,
        *,
        kinds: Sequence[RevisionKind] = SHOWN_KINDS,
        after: int = 0,
        limit: int = 1000,
        leave_out_reviews: bool = False,
    ) -> Sequence[LabelRevision]:
        """A page of head revisions by shape id: every shape of the collection that has labels of these kinds.

        `leave_out_reviews` leaves out shapes whose labels wait for someone to look at them.
        """
        ...

    def add_review(self, revision_id: int, review: NewReview) -> Review:
        """Have someone look at labels before they are trained on. An open review of the same reason stays the one.

        Raises `ConflictError` unless the revision is the newest human or imported one, `LabelError` for reference ones.
        """
        ...

    def open_reviews(self, collection_id: int, *, after: int = 0, limit: int = 1000) -> Sequence[Review]:
        """A page of the reviews that wait for someone, by review id."""
        ...

    def reviews(self, shape_id: int) -> Sequence[Review]:
        """Every review of a shape, open or not, oldest first."""
        ...

    def accept_review(self, review_id: int, person_id: int) -> Review:
        """Record that a person found the labels right as they are. `ConflictError` if the review is resolved already.

        Labels that are not right are corrected by committing better ones, which resolves the review.
        """
        ...


class ModelCatalog(Protocol):
    """Models, scores, the selection and the embedding."""

    def save_model(self, model: NewModel) -> Model:
        """Commit a model under the next version of its collection. `NotFoundError` for an unknown revision."""
        ...

    def latest_model(self, collection_id: int) -> Model | None: ...

    def model(self, collection_id: int, version: int) -> Model: ...

    def models(self, collection_id: int) -> Sequence[Model]:
        """Every model, newest first."""
        ...

    def scores(self, shape_ids: SizedIterable[int], name: str) -> Mapping[int, Score]:
        """The latest score of this name for each shape; shapes without one are left out."""
        ...

    def queue(
        self,
        collection_id: int,
        score_name: str,
        *,
        descending: bool = True,
        limit: int = 100,
        after: QueueAnchor | None = None,
        states: Sequence[ShapeState] | None = None,
    ) -> Sequence[QueueRow]:
        """A page of scored shapes in order of the score, ties by id, of these states if given."""
        ...

    def replace_first_shapes(self, collection_id: int, first_shapes: Sequence[FirstShape]) -> None: ...

    def first_shapes(self, collection_id: int) -> Sequence[FirstShape]:
        """The current selection, by ordinal."""
        ...

    def set_embedding(self, collection_id: int, key: str) -> None: ...

    def embedding(self, collection_id: int) -> Embedding | None: ...


class AuditCatalog(Protocol):
    """The audit trail."""

    def append_audit(self, actor: str, action: str, subject: str, detail: Mapping[str, Any] | None = None) -> None: ...

    def audit(self, *, after: int = 0, limit: int = 1000) -> Sequence[AuditEntry]:
        """A page of the trail, oldest first."""
        ...


class Catalog(CollectionCatalog, ShapeCatalog, StageCatalog, LabelCatalog, ModelCatalog, AuditCatalog, Protocol):
    """The whole catalog. Depend on the smallest of its parts that does."""

    def close(self) -> None: ...
