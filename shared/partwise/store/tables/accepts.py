"""Labels of models that were accepted in bulk, and the few of them that people label again unknowing."""

from sqlalchemy import (
    Boolean,
    CheckConstraint,
    Column,
    Double,
    ForeignKey,
    Index,
    Integer,
    LargeBinary,
    String,
    Table,
    text,
)

from partwise.store.tables.base import UtcDateTime, metadata

accept_batch = Table(
    "accept_batch",
    metadata,
    Column("id", Integer, primary_key=True),
    Column("collection_id", ForeignKey("collection.id"), nullable=False),
    Column("person_id", ForeignKey("person.id"), nullable=False),
    Column("segmentation", String(16), nullable=False),
    Column("agreement", Double, nullable=False),
    Column("n_accepted", Integer, nullable=False),
    Column("accepted_at", UtcDateTime, nullable=False),
    Index(None, "collection_id", "id"),
    sqlite_autoincrement=True,
)

recheck = Table(
    "recheck",
    metadata,
    Column("id", Integer, primary_key=True),
    Column("batch_id", ForeignKey("accept_batch.id"), nullable=False, index=True),
    Column("collection_id", ForeignKey("collection.id"), nullable=False),
    Column("shape_id", ForeignKey("shape.id"), nullable=False),
    Column("mesh_hash", String(64), nullable=False),
    Column("labels", LargeBinary, nullable=False),
    Column("n_faces", Integer, nullable=False),
    Column("sha256", String(64), nullable=False),
    Column("revision_id", ForeignKey("label_revision.id")),
    Column("area_agreement", Double),
    Column("part_iou", Double),
    Column("boundary_distance", Double),
    Column("is_false", Boolean),
    Column("checked_at", UtcDateTime),
    CheckConstraint("(checked_at IS NULL) = (revision_id IS NULL)", name="checked_has_revision"),
    sqlite_autoincrement=True,
)
_IS_OPEN = text("checked_at IS NULL")
Index("uq_recheck_open", recheck.c.shape_id, unique=True, sqlite_where=_IS_OPEN, postgresql_where=_IS_OPEN)
Index(
    "ix_recheck_open_collection_id",
    recheck.c.collection_id,
    recheck.c.id,
    sqlite_where=_IS_OPEN,
    postgresql_where=_IS_OPEN,
)
