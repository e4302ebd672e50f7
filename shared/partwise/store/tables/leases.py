"""The queue, leases, and the shapes with known labels."""

from sqlalchemy import (
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
    text,
)

from partwise.store.tables.base import UtcDateTime, metadata

lease = Table(
    "lease",
    metadata,
    Column("id", Integer, primary_key=True),
    Column("collection_id", ForeignKey("collection.id"), nullable=False),
    Column("shape_id", ForeignKey("shape.id"), nullable=False),
    Column("slot", Integer, nullable=False),
    Column("round", Integer, nullable=False),
    Column("person_id", ForeignKey("person.id"), nullable=False),
    Column("purpose", String(16), nullable=False),
    Column("is_prefetched", Boolean, nullable=False),
    Column("acquired_at", UtcDateTime, nullable=False),
    Column("expires_at", UtcDateTime, nullable=False),
    Column("released_at", UtcDateTime),
    Column("outcome", String(16)),
    Column("reason", Text),
    Column("rank", BigInteger),
    Column("score_name", String(64)),
    Column("score", Double),
    Column("model_version", Integer),
    CheckConstraint("(released_at IS NULL) = (outcome IS NULL)", name="released_has_outcome"),
    Index(None, "person_id", "shape_id"),
    Index(None, "shape_id", "round"),
    sqlite_autoincrement=True,
)
_IS_ACTIVE = text("released_at IS NULL")
Index(  # the database itself refuses to hand one label of a shape to two
    "uq_lease_active_slot",
    lease.c.shape_id,
    lease.c.slot,
    unique=True,
    sqlite_where=_IS_ACTIVE,
    postgresql_where=_IS_ACTIVE,
)
Index(
    "uq_lease_active_person",
    lease.c.person_id,
    lease.c.shape_id,
    unique=True,
    sqlite_where=_IS_ACTIVE,
    postgresql_where=_IS_ACTIVE,
)
Index("ix_lease_active_expires_at", lease.c.expires_at, sqlite_where=_IS_ACTIVE, postgresql_where=_IS_ACTIVE)
Index(
    "ix_lease_active_collection_id",
    lease.c.collection_id,
    lease.c.id,
    sqlite_where=_IS_ACTIVE,
    postgresql_where=_IS_ACTIVE,
)
_IS_SKIPPED = text("outcome = 'skipped'")
Index("ix_lease_skipped", lease.c.collection_id, lease.c.id, sqlite_where=_IS_SKIPPED, postgresql_where=_IS_SKIPPED)

queue_rank = Table(  # a row for each label that a shape still wants; while somebody is at it, `lease_id` says who
    "queue_rank",
    metadata,
    Column("shape_id", ForeignKey("shape.id"), primary_key=True),
    Column("slot", Integer, primary_key=True, autoincrement=False),
    Column("collection_id", ForeignKey("collection.id"), nullable=False),
    Column("rank", BigInteger, nullable=False),
    Column("round", Integer, nullable=False),
    Column("n_slots", Integer, nullable=False),
    Column("person_id", ForeignKey("person.id")),
    Column("lease_id", ForeignKey("lease.id")),
    Column("opened_at", UtcDateTime, nullable=False),
)
_IS_HELD = text("lease_id IS NOT NULL")
Index(  # only of what is held: an index of all would tempt SQLite to look for free places in it
    "uq_queue_rank_held", queue_rank.c.lease_id, unique=True, sqlite_where=_IS_HELD, postgresql_where=_IS_HELD
)
_IS_FREE = text("lease_id IS NULL AND person_id IS NULL")
_IS_ASSIGNED = text("lease_id IS NULL AND person_id IS NOT NULL")
Index(
    "ix_queue_rank_free",
    queue_rank.c.collection_id,
    queue_rank.c.rank,
    queue_rank.c.shape_id,
    queue_rank.c.slot,
    sqlite_where=_IS_FREE,
    postgresql_where=_IS_FREE,
)
Index(
    "ix_queue_rank_assigned",
    queue_rank.c.collection_id,
    queue_rank.c.person_id,
    queue_rank.c.rank,
    queue_rank.c.shape_id,
    queue_rank.c.slot,
    sqlite_where=_IS_ASSIGNED,
    postgresql_where=_IS_ASSIGNED,
)
Index("ix_queue_rank_collection_id_shape_id", queue_rank.c.collection_id, queue_rank.c.shape_id)

honeypot = Table(  # shapes whose true labels are known, with the newest of them
    "honeypot",
    metadata,
    Column("collection_id", ForeignKey("collection.id"), primary_key=True),
    Column("shape_id", ForeignKey("shape.id"), primary_key=True),
    Column("revision_id", ForeignKey("label_revision.id"), nullable=False),
)
