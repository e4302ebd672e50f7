"""Shapes, as rows of the table and one by one, with their meshes, revisions and reviews."""

from datetime import datetime
from typing import Annotated

from pydantic import Field, JsonValue

from partwise.store.records import LabelRevision, ListedShape, Mesh, RevisionKind, Shape, ShapeState
from partwise.store.reviews import Review, ReviewOutcome, ReviewReason
from partwise.workspace.provenance import ProvenanceCard
from partwise_service.schemas.base import NO_NUL, Answer, Request


class ShapeRow(Answer):
    """A row of the table. `score`, `model_version`: of the score that the list is ordered by, and which model's it is.

    author_id : whose the newest labels are. cluster : in the embedding. failed_stage : of the latest failure.
    """

    id: int
    source_key: str
    state: ShapeState
    mesh_hash: str | None
    author_id: int | None
    cluster: int | None
    failed_stage: str | None
    score: float | None
    model_version: int | None

    @classmethod
    def of(cls, row: ListedShape) -> "ShapeRow":
        """The row as it is told."""
        return cls(
            id=row.shape.id,
            source_key=row.shape.source_key,
            state=row.state,
            mesh_hash=row.shape.mesh_hash,
            author_id=row.author_id,
            cluster=row.cluster,
            failed_stage=row.failed_stage,
            score=row.value,
            model_version=row.model_version,
        )


class RankedShapes(Answer):
    """A stretch of an order as it was at `built_at`, from a rank on."""

    n_shapes: int
    built_at: datetime
    items: list[ShapeRow]


class MeshOut(Answer):
    """A mesh; its arrays are at /meshes/{mesh_hash}."""

    mesh_hash: str
    n_vertices: int
    n_faces: int

    @classmethod
    def of(cls, mesh: Mesh) -> "MeshOut":
        """The mesh as it is told."""
        return cls.model_validate(mesh)


class RevisionOut(Answer):
    """Labels on record, which nothing changes any more. `sha256` is that of the labels as little-endian uint16.

    agreement : of labels that were moved here from another mesh, the share of their area that survived.
    """

    id: int
    mesh_hash: str
    kind: RevisionKind
    parent_id: int | None
    author_id: int
    schema_version: int
    n_faces: int
    sha256: str
    created_at: datetime
    agreement: float | None

    @classmethod
    def of(cls, revision: LabelRevision) -> "RevisionOut":
        """The revision as it is told."""
        moved = None if revision.origin is None else revision.origin.agreement
        known = {name: getattr(revision, name) for name in cls.model_fields if name != "agreement"}
        return cls(**known, agreement=moved)


class RevisionsOut(Answer):
    items: list[RevisionOut]


class ReviewOut(Answer):
    """Labels that wait, or waited, for someone to look at them."""

    id: int
    collection_id: int
    shape_id: int
    revision_id: int
    reason: ReviewReason
    detail: dict[str, JsonValue]
    created_at: datetime
    resolved_at: datetime | None
    resolved_by: int | None
    outcome: ReviewOutcome | None

    @classmethod
    def of(cls, review: Review) -> "ReviewOut":
        """The review as it is told."""
        return cls.model_validate(review)


class ReviewsOut(Answer):
    items: list[ReviewOut]


class Rejection(Request):
    """Why labels are sent back. for_author : only whoever made them gets the shape again; else anybody."""

    note: Annotated[str, NO_NUL, Field(min_length=1, max_length=2_000)]
    for_author: bool = False


class ShapeOut(Answer):
    """A shape and how it came to be. `head`: its newest labels."""

    id: int
    collection_id: int
    source_key: str
    ingested_at: datetime
    state: ShapeState
    mesh: MeshOut | None
    original_mesh_hash: str | None
    head: RevisionOut | None
    provenance: ProvenanceCard

    @classmethod
    def of(cls, shape: Shape, mesh: Mesh | None, head: LabelRevision | None, card: ProvenanceCard) -> "ShapeOut":
        """The shape as it is told."""
        return cls(
            id=shape.id,
            collection_id=shape.collection_id,
            source_key=shape.source_key,
            ingested_at=shape.ingested_at,
            state=ShapeState(card.state),
            mesh=None if mesh is None else MeshOut.of(mesh),
            original_mesh_hash=shape.original_mesh_hash,
            head=None if head is None else RevisionOut.of(head),
            provenance=card,
        )
