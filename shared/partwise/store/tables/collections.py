"""Collections, parts, people, the audit trail."""

from sqlalchemy import (
    JSON,
    CheckConstraint,
    Column,
    ForeignKey,
    ForeignKeyConstraint,
    Index,
    Integer,
    String,
    Table,
    Text,
    text,
)

from partwise.store.tables.base import UtcDateTime, metadata

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
