"""Tokens and login codes, by the hashes of their secrets."""

from sqlalchemy import JSON, Boolean, CheckConstraint, Column, ForeignKey, Integer, String, Table, Text

from partwise.store.tables.base import UtcDateTime, metadata

token = Table(
    "token",
    metadata,
    Column("id", Integer, primary_key=True),
    Column("person_id", ForeignKey("person.id"), nullable=False, index=True),
    Column("role", String(16), nullable=False),
    Column("scope", JSON(none_as_null=True)),
    Column("note", Text, nullable=False),
    Column("secret_sha256", String(64), nullable=False, unique=True),
    Column("is_session", Boolean, nullable=False),
    Column("parent_id", ForeignKey("token.id"), index=True),
    Column("created_at", UtcDateTime, nullable=False),
    Column("expires_at", UtcDateTime, nullable=False),
    Column("revoked_at", UtcDateTime),
    Column("last_used_at", UtcDateTime),
    CheckConstraint("role IN ('annotator', 'reviewer', 'operator', 'admin')", name="role"),
)

login_code = Table(
    "login_code",
    metadata,
    Column("id", Integer, primary_key=True),
    Column("token_id", ForeignKey("token.id"), nullable=False, index=True),
    Column("code_sha256", String(64), nullable=False, unique=True),
    Column("created_at", UtcDateTime, nullable=False),
    Column("expires_at", UtcDateTime, nullable=False),
    Column("used_at", UtcDateTime),
)
