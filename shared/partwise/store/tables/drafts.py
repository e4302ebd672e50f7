"""Drafts, strokes, and what came of confirmed labels."""

from sqlalchemy import (
    JSON,
    Boolean,
    CheckConstraint,
    Column,
    Double,
    ForeignKey,
    ForeignKeyConstraint,
    Index,
    Integer,
    LargeBinary,
    String,
    Table,
    UniqueConstraint,
    text,
)

from partwise.store.tables.base import UtcDateTime, metadata

draft = Table(
    "draft",
    metadata,
    Column("id", Integer, primary_key=True),
    Column("collection_id", ForeignKey("collection.id"), nullable=False),
    Column("shape_id", ForeignKey("shape.id"), nullable=False),
    Column("slot", Integer, nullable=False),
    Column("round", Integer, nullable=False),
    Column("person_id", ForeignKey("person.id"), nullable=False),
    Column("purpose", String(16), nullable=False),
    Column("mesh_hash", String(64), nullable=False),
    Column("base_revision", ForeignKey("label_revision.id")),
    Column("base_sha256", String(64), nullable=False),
    Column("seen_revision", ForeignKey("label_revision.id")),
    Column("schema_version", Integer, nullable=False),
    Column("n_strokes", Integer, nullable=False),
    Column("created_at", UtcDateTime, nullable=False),
    Column("updated_at", UtcDateTime, nullable=False),
    Column("closed_at", UtcDateTime),
    Column("outcome", String(16)),
    Column("labels_sha256", String(64)),
    Column("active_s", Double),
    Column("n_clicks", Integer),
    ForeignKeyConstraint(["shape_id", "mesh_hash"], ["shape_mesh.shape_id", "shape_mesh.mesh_hash"]),
    CheckConstraint("(closed_at IS NULL) = (outcome IS NULL)", name="closed_has_outcome"),
    Index(None, "shape_id", "mesh_hash"),
)
_IS_OPEN = text("closed_at IS NULL")
Index(
    "uq_draft_open", draft.c.person_id, draft.c.shape_id, unique=True, sqlite_where=_IS_OPEN, postgresql_where=_IS_OPEN
)
_IS_CONFIRMED = text("outcome = 'confirmed'")
Index(
    "ix_draft_confirmed",
    draft.c.collection_id,
    draft.c.closed_at,
    sqlite_where=_IS_CONFIRMED,
    postgresql_where=_IS_CONFIRMED,
)

stroke = Table(  # triggers refuse UPDATE and DELETE
    "stroke",
    metadata,
    Column("draft_id", ForeignKey("draft.id"), primary_key=True),
    Column("sequence", Integer, primary_key=True, autoincrement=False),
    Column("id", String(36), nullable=False),
    Column("payload", JSON, nullable=False),
    Column("recorded_at", UtcDateTime, nullable=False),
    UniqueConstraint("draft_id", "id"),
)

answer = Table(  # triggers refuse UPDATE and DELETE
    "answer",
    metadata,
    Column("id", Integer, primary_key=True),
    Column("shape_id", ForeignKey("shape.id"), nullable=False),
    Column("slot", Integer, nullable=False),
    Column("round", Integer, nullable=False),
    Column("person_id", ForeignKey("person.id"), nullable=False),
    Column("draft_id", ForeignKey("draft.id"), nullable=False, unique=True),
    Column("purpose", String(16), nullable=False),
    Column("mesh_hash", String(64), nullable=False),
    Column("schema_version", Integer, nullable=False),
    Column("labels", LargeBinary, nullable=False),
    Column("n_faces", Integer, nullable=False),
    Column("sha256", String(64), nullable=False),
    Column("created_at", UtcDateTime, nullable=False),
    Index(None, "shape_id", "round"),
)

consensus = Table(
    "consensus",
    metadata,
    Column("id", Integer, primary_key=True),
    Column("shape_id", ForeignKey("shape.id"), nullable=False),
    Column("round", Integer, nullable=False),
    Column("answer_ids", JSON, nullable=False),
    Column("area_agreement", Double, nullable=False),
    Column("part_iou", Double, nullable=False),
    Column("boundary_distance", Double, nullable=False),
    Column("is_agreed", Boolean, nullable=False),
    Column("medoid_id", ForeignKey("answer.id"), nullable=False),
    Column("revision_id", ForeignKey("label_revision.id"), nullable=False),
    Column("settled_at", UtcDateTime, nullable=False),
    UniqueConstraint("shape_id", "round"),
)

blind_check = Table(
    "blind_check",
    metadata,
    Column("id", Integer, primary_key=True),
    Column("collection_id", ForeignKey("collection.id"), nullable=False),
    Column("shape_id", ForeignKey("shape.id"), nullable=False),
    Column("person_id", ForeignKey("person.id"), nullable=False),
    Column("answer_id", ForeignKey("answer.id"), nullable=False, unique=True),
    Column("reference_id", ForeignKey("label_revision.id"), nullable=False),
    Column("area_agreement", Double, nullable=False),
    Column("part_iou", Double, nullable=False),
    Column("boundary_distance", Double, nullable=False),
    Column("checked_at", UtcDateTime, nullable=False),
    Index(None, "collection_id", "id"),
)
