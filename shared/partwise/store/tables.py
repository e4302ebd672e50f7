"""The catalog's tables as SQLAlchemy Core sees them. The migrations make them; a test checks that the two agree."""

from datetime import UTC, datetime
from typing import Any

from sqlalchemy import (
    JSON,
    BigInteger,
    Boolean,
    CheckConstraint,
    Column,
    DateTime,
    Dialect,
    Double,
    ForeignKey,
    ForeignKeyConstraint,
    Index,
    Integer,
    LargeBinary,
    MetaData,
    String,
    Table,
    Text,
    UniqueConstraint,
    text,
)
from sqlalchemy.types import TypeDecorator


class UtcDateTime(TypeDecorator[datetime]):
    """An aware UTC datetime; SQLite, which knows no zones, holds it without one."""

    impl = DateTime(timezone=True)
    cache_ok = True

    def process_bind_param(self, value: datetime | None, dialect: Dialect) -> datetime | None:  # noqa: ARG002 # as named by SQLAlchemy
        return None if value is None else value.astimezone(UTC)

    def process_result_value(self, value: Any | None, dialect: Dialect) -> datetime | None:  # noqa: ARG002 # as named by SQLAlchemy
        if value is None:
            return None
        return value.replace(tzinfo=UTC) if value.tzinfo is None else value.astimezone(UTC)


metadata = MetaData(
    naming_convention={
        "ix": "ix_%(table_name)s_%(column_0_N_name)s",
        "uq": "uq_%(table_name)s_%(column_0_N_name)s",
        "ck": "ck_%(table_name)s_%(constraint_name)s",
        "fk": "fk_%(table_name)s_%(column_0_N_name)s",
        "pk": "pk_%(table_name)s",
    }
)

collection = Table(
    "collection",
    metadata,
    Column("id", Integer, primary_key=True),
    Column("name", String(200), nullable=False, unique=True),
    Column("settings", JSON, nullable=False),
    Column("schema_version", Integer, nullable=False),
    Column("created_at", UtcDateTime, nullable=False),
)

part = Table(
    "part",
    metadata,
    Column("collection_id", ForeignKey("collection.id"), primary_key=True),
    Column("id", Integer, primary_key=True, autoincrement=False),
    Column("name", String(64), nullable=False),
    Column("colour", String(7), nullable=False),
    Column("gloss", Text, nullable=False),
    Column("ordinal", Integer, nullable=False),
    Column("schema_version_added", Integer, nullable=False),
    Column("schema_version_removed", Integer),
    Column("parent_id", Integer),
    CheckConstraint("id >= 1 AND id <= 65535", name="id"),
    ForeignKeyConstraint(["collection_id", "parent_id"], ["part.collection_id", "part.id"]),
)
Index(  # a removed part's name may be given to a new part
    "uq_part_current_name",
    part.c.collection_id,
    part.c.name,
    unique=True,
    sqlite_where=text("schema_version_removed IS NULL"),
    postgresql_where=text("schema_version_removed IS NULL"),
)

person = Table(
    "person",
    metadata,
    Column("id", Integer, primary_key=True),
    Column("name", String(200), nullable=False, unique=True),
    Column("created_at", UtcDateTime, nullable=False),
)

shape = Table(
    "shape",
    metadata,
    Column("id", Integer, primary_key=True),
    Column("collection_id", ForeignKey("collection.id"), nullable=False),
    Column("source_key", Text, nullable=False),
    Column("source_hash", String(64), nullable=False),
    Column("source_suffix", String(16), nullable=False),
    Column("ingested_at", UtcDateTime, nullable=False),
    Column("mesh_hash", ForeignKey("mesh.hash")),
    Column("original_mesh_hash", ForeignKey("mesh.hash")),
    UniqueConstraint("collection_id", "source_key"),
    Index(None, "collection_id", "id"),
)

block = Table(
    "block",
    metadata,
    Column("id", Integer, primary_key=True),
    Column("name", String(200), nullable=False, unique=True),
    Column("kind", String(64), nullable=False),
    Column("n_shapes", Integer, nullable=False),
    Column("n_bytes", BigInteger, nullable=False),
    Column("checksum", String(64), nullable=False),
    Column("created_at", UtcDateTime, nullable=False),
    sqlite_autoincrement=True,  # a later block has a larger id, even after the last was deleted
)

mesh = Table(
    "mesh",
    metadata,
    Column("hash", String(64), primary_key=True),
    Column("n_vertices", Integer, nullable=False),
    Column("n_faces", Integer, nullable=False),
    Column("kept_key", Text),
    Column("created_at", UtcDateTime, nullable=False),
)

shape_mesh = Table(  # one mesh may belong to several shapes: the same file under two names
    "shape_mesh",
    metadata,
    Column("shape_id", ForeignKey("shape.id"), primary_key=True),
    Column("mesh_hash", ForeignKey("mesh.hash"), primary_key=True),
    Column("block_id", ForeignKey("block.id"), index=True),
    Column("row", Integer),
    Index(None, "mesh_hash"),
)

stage_run = Table(
    "stage_run",
    metadata,
    Column("id", Integer, primary_key=True),
    Column("shape_id", ForeignKey("shape.id"), nullable=False),
    Column("stage", String(64), nullable=False),
    Column("key", String(64), nullable=False),
    Column("status", String(8), nullable=False),
    Column("reason", Text),
    Column("attempts", Integer, nullable=False),
    Column("seconds", Double, nullable=False),
    Column("summary", JSON, nullable=False),
    Column("block_id", ForeignKey("block.id"), index=True),
    Column("row", Integer),
    Column("finished_at", UtcDateTime, nullable=False),
    Column("is_superseded", Boolean, nullable=False),
    UniqueConstraint("shape_id", "stage", "key"),
    CheckConstraint("status IN ('done', 'failed')", name="status"),
    CheckConstraint("status = 'done' OR block_id IS NULL", name="failed_has_no_block"),
)
Index(  # at most one current run of a stage for a shape: the database itself refuses a second
    "uq_stage_run_current",
    stage_run.c.shape_id,
    stage_run.c.stage,
    unique=True,
    sqlite_where=text("status = 'done' AND is_superseded = 0"),
    postgresql_where=text("status = 'done' AND NOT is_superseded"),
)
Index(
    "ix_stage_run_failed",
    stage_run.c.shape_id,
    stage_run.c.stage,
    sqlite_where=text("status = 'failed'"),
    postgresql_where=text("status = 'failed'"),
)

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

model = Table(
    "model",
    metadata,
    Column("id", Integer, primary_key=True),
    Column("collection_id", ForeignKey("collection.id"), nullable=False),
    Column("version", Integer, nullable=False),
    Column("recipe", JSON, nullable=False),
    Column("weights_key", Text, nullable=False),
    Column("revision_ids", JSON, nullable=False),
    Column("n_shapes", Integer, nullable=False),
    Column("trained_at", UtcDateTime, nullable=False),
    UniqueConstraint("collection_id", "version"),
)

score = Table(  # the latest of each name only: history of every shape under every model would outgrow the rest
    "score",
    metadata,
    Column("shape_id", ForeignKey("shape.id"), primary_key=True),
    Column("name", String(64), primary_key=True),
    Column("model_id", ForeignKey("model.id"), nullable=False),
    Column("value", Double, nullable=False),
    Column("scored_at", UtcDateTime, nullable=False),
    Column("collection_id", ForeignKey("collection.id"), nullable=False),
    Index(None, "collection_id", "name", "value", "shape_id"),
)

first_shape = Table(
    "first_shape",
    metadata,
    Column("collection_id", ForeignKey("collection.id"), primary_key=True),
    Column("ordinal", Integer, primary_key=True, autoincrement=False),
    Column("shape_id", ForeignKey("shape.id"), nullable=False),
    Column("cluster", Integer, nullable=False),
)

embedding = Table(
    "embedding",
    metadata,
    Column("collection_id", ForeignKey("collection.id"), primary_key=True),
    Column("key", Text, nullable=False),
    Column("created_at", UtcDateTime, nullable=False),
)

audit = Table(  # triggers refuse UPDATE and DELETE
    "audit",
    metadata,
    Column("id", Integer, primary_key=True),
    Column("at", UtcDateTime, nullable=False),
    Column("actor", String(200), nullable=False),
    Column("action", String(64), nullable=False),
    Column("subject", Text, nullable=False),
    Column("detail", JSON, nullable=False),
)
