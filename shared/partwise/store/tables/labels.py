"""Label revisions and their reviews."""

from sqlalchemy import (
    JSON,
    CheckConstraint,
    Column,
    ForeignKey,
    ForeignKeyConstraint,
    Index,
    Integer,
    LargeBinary,
    String,
    Table,
    text,
)

from partwise.store.tables.base import UtcDateTime, metadata

label_revision = Table(  # triggers refuse UPDATE and DELETE
    "label_revision",
    metadata,
    Column("id", Integer, primary_key=True),
    Column("shape_id", ForeignKey("shape.id"), nullable=False),
    Column("mesh_hash", String(64), nullable=False),
    Column("kind", String(16), nullable=False),
    Column("parent_id", ForeignKey("label_revision.id")),
    Column("author_id", ForeignKey("person.id"), nullable=False),
    Column("schema_version", Integer, nullable=False),
    Column("labels", LargeBinary, nullable=False),
    Column("n_faces", Integer, nullable=False),
    Column("sha256", String(64), nullable=False),
    Column("created_at", UtcDateTime, nullable=False),
    Column("origin", JSON(none_as_null=True)),
    ForeignKeyConstraint(["shape_id", "mesh_hash"], ["shape_mesh.shape_id", "shape_mesh.mesh_hash"]),
    CheckConstraint("kind IN ('human', 'imported', 'reference')", name="kind"),
    Index(None, "shape_id", "kind", "id"),
    Index(None, "mesh_hash"),
)

label_part = Table(  # which parts a revision uses, so that a part in use is found without unpacking any labels
    "label_part",
    metadata,
    Column("collection_id", Integer, primary_key=True, autoincrement=False),
    Column("part_id", Integer, primary_key=True, autoincrement=False),
    Column("revision_id", ForeignKey("label_revision.id"), primary_key=True, autoincrement=False),
    ForeignKeyConstraint(["collection_id", "part_id"], ["part.collection_id", "part.id"]),
)

review = Table(  # open ones are of newest revisions only: what takes their place resolves them
    "review",
    metadata,
    Column("id", Integer, primary_key=True),
    Column("collection_id", ForeignKey("collection.id"), nullable=False),
    Column("shape_id", ForeignKey("shape.id"), nullable=False, index=True),
    Column("revision_id", ForeignKey("label_revision.id"), nullable=False),
    Column("reason", String(16), nullable=False),
    Column("detail", JSON, nullable=False),
    Column("created_at", UtcDateTime, nullable=False),
    Column("resolved_at", UtcDateTime),
    Column("resolved_by", ForeignKey("person.id")),
    Column("outcome", String(16)),
    CheckConstraint("(resolved_at IS NULL) = (outcome IS NULL)", name="resolved_has_outcome"),
)
_IS_OPEN = text("resolved_at IS NULL")
Index(
    "uq_review_open", review.c.shape_id, review.c.reason, unique=True, sqlite_where=_IS_OPEN, postgresql_where=_IS_OPEN
)
Index(
    "ix_review_open_collection_id",
    review.c.collection_id,
    review.c.id,
    sqlite_where=_IS_OPEN,
    postgresql_where=_IS_OPEN,
)
