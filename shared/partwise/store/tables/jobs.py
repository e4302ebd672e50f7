"""Jobs, what counts towards the next training, and events."""

from sqlalchemy import (
    JSON,
    BigInteger,
    Boolean,
    CheckConstraint,
    Column,
    ForeignKey,
    Index,
    Integer,
    String,
    Table,
    Text,
    text,
)

from partwise.store.tables.base import UtcDateTime, metadata

job = Table(
    "job",
    metadata,
    Column("id", Integer, primary_key=True),
    Column("collection_id", ForeignKey("collection.id"), nullable=False),
    Column("kind", String(16), nullable=False),
    Column("parameters", JSON, nullable=False),
    Column("state", String(16), nullable=False),
    Column("owner", String(200)),
    Column("attempts", Integer, nullable=False),
    Column("n_done", Integer, nullable=False),
    Column("n_failed", Integer, nullable=False),
    Column("n_total", Integer),
    Column("message", Text, nullable=False),
    Column("result", JSON(none_as_null=True)),
    Column("cancel_requested", Boolean, nullable=False),
    Column("created_at", UtcDateTime, nullable=False),
    Column("started_at", UtcDateTime),
    Column("heartbeat_at", UtcDateTime),
    Column("finished_at", UtcDateTime),
    CheckConstraint("state IN ('pending', 'running', 'done', 'failed', 'cancelled')", name="state"),
    Index(None, "collection_id", "id"),
    sqlite_autoincrement=True,
)
_IS_COALESCED = text("state = 'pending' AND kind IN ('preprocess', 'train', 'evaluate', 'refine')")
_IS_PENDING = text("state = 'pending'")
_IS_RUNNING = text("state = 'running'")
Index(  # at most one waits for all who ask
    "uq_job_pending",
    job.c.collection_id,
    job.c.kind,
    unique=True,
    sqlite_where=_IS_COALESCED,
    postgresql_where=_IS_COALESCED,
)
Index("ix_job_pending", job.c.id, sqlite_where=_IS_PENDING, postgresql_where=_IS_PENDING)
Index("ix_job_running", job.c.collection_id, job.c.kind, sqlite_where=_IS_RUNNING, postgresql_where=_IS_RUNNING)
Index("ix_job_running_heartbeat_at", job.c.heartbeat_at, sqlite_where=_IS_RUNNING, postgresql_where=_IS_RUNNING)

worker = Table(  # processes that do jobs, and what they take of their machines
    "worker",
    metadata,
    Column("owner", String(200), primary_key=True),
    Column("memory_bytes", BigInteger, nullable=False),
    Column("n_actors", Integer, nullable=False),
    Column("actor_bytes", BigInteger, nullable=False),
    Column("free_bytes", BigInteger),
    Column("seen_at", UtcDateTime, nullable=False),
)

training_tally = Table(  # shapes confirmed since the last training began
    "training_tally",
    metadata,
    Column("collection_id", ForeignKey("collection.id"), primary_key=True),
    Column("n_confirmed", Integer, nullable=False),
)

event = Table(
    "event",
    metadata,
    Column("id", Integer, primary_key=True),
    Column("at", UtcDateTime, nullable=False, index=True),
    Column("collection_id", ForeignKey("collection.id")),
    Column("kind", String(16), nullable=False),
    Column("payload", JSON, nullable=False),
    sqlite_autoincrement=True,  # a later event has a larger id, even after the last was pruned
)
