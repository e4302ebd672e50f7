"""Shapes, meshes, blocks, stage runs."""

from sqlalchemy import (
    JSON,
    BigInteger,
    Boolean,
    CheckConstraint,
    Column,
    Double,
    ForeignKey,
    Index,
    Integer,
    String,
    Table,
    Text,
    UniqueConstraint,
    text,
)

from partwise.store.tables.base import UtcDateTime, metadata

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
