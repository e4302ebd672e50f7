"""Shapes, as rows of the table and one by one, with their meshes, revisions and reviews."""

from datetime import datetime
from enum import StrEnum
from typing import Annotated

from pydantic import Field, JsonValue

from partwise.store.records import Effort, LabelRevision, ListedShape, Mesh, RevisionKind, Shape, ShapeState, ShapeTile
from partwise.store.reviews import Review, ReviewOutcome, ReviewReason
from partwise.workspace.provenance import ProvenanceCard
from partwise_service.schemas.base import NO_NUL, Answer, Request


class HolderOut(Answer):
    """Who has a shape in their hands. Once `expires_at` is past, anybody may claim it."""

    person_id: int
    name: str
    expires_at: datetime


class ShapeRow(Answer):
    """A row of the table: all that its tile shows. rank : its place in the order, from 0, where a jump asked for it.

    score, model_version : the score that the list is ordered by, and which model's it is; null in other orders. Of a
    shape that the caller holds, what its lease tells of that score; null if it tells of another.
    revision_id, author_id, author_name : of its newest confirmed labels. has_confirmed : they are on its present mesh.
    predicted_version, refined_version : the model version of those labels; null where it has none.
    cluster : in the embedding. failed_stage : of its latest failure.
    """

    id: int
    source_key: str
    state: ShapeState
    mesh_hash: str | None
    n_faces: int | None
    revision_id: int | None
    author_id: int | None
    author_name: str | None
    has_confirmed: bool
    predicted_version: int | None
    refined_version: int | None
    cluster: int | None
    failed_stage: str | None
    score: float | None
    model_version: int | None
    rank: int | None
    held_by: list[HolderOut]

    @classmethod
    def of(cls, row: ListedShape, tile: ShapeTile, rank: int | None = None) -> "ShapeRow":
        """The row as it is told."""
        return cls(
            id=row.shape.id,
            source_key=row.shape.source_key,
            state=row.state,
            mesh_hash=row.shape.mesh_hash,
            n_faces=tile.n_faces,
            revision_id=tile.revision_id,
            author_id=row.author_id,
            author_name=tile.author_name,
            has_confirmed=tile.has_confirmed,
            predicted_version=tile.predicted_version,
            refined_version=tile.refined_version,
            cluster=row.cluster,
            failed_stage=row.failed_stage,
            score=row.value,
            model_version=row.model_version,
            rank=rank,
            held_by=[HolderOut.model_validate(holder) for holder in tile.holders],
        )


class ShapeRows(Answer):
    items: list[ShapeRow]


class RankedShapes(Answer):
    """A stretch of an order, from a rank on. n_shapes : in the whole order, under the same filters.

    built_at : when the order was made, where it is one that is made from time to time; null if it is the present one.
    """

    n_shapes: int
    built_at: datetime | None
    items: list[ShapeRow]


class CountOut(Answer):
    """How many shapes meet the filters; in an order by score, those that have it."""

    n_shapes: int


class DirectionName(StrEnum):
    """asc : lowest first. desc : highest first."""

    ASC = "asc"
    DESC = "desc"


class OrderOut(Answer):
    """An order that the table can be in. `name` goes into `order`. is_queues : shapes are handed out by this score."""

    name: str
    label: str
    direction_default: DirectionName
    is_queues: bool


class OrdersOut(Answer):
    """none and name first, then the scores that exist."""

    items: list[OrderOut]


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


class EffortOut(Answer):
    """What labels took whoever made them. active_s : seconds at work, without pauses. n_clicks : presses that count."""

    active_s: float
    n_clicks: int

    @classmethod
    def of(cls, effort: Effort | None) -> "EffortOut | None":
        """The effort as it is told; None if nobody noted it."""
        return None if effort is None else cls.model_validate(effort)


class OpenReviewOut(ReviewOut):
    """Labels that wait, with what they took. effort : null where nobody noted it, as of labels from files."""

    effort: EffortOut | None


class ReviewCount(Answer):
    n_reviews: int


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
