"""Collections, people and the audit trail."""

from collections.abc import Mapping
from dataclasses import dataclass
from datetime import datetime
from typing import Any


@dataclass(frozen=True, slots=True)
class Collection:
    """A set of shapes that share a part schema. `settings` is JSON, such as {"upright": true, "up": "y"}."""

    id: int
    name: str
    settings: Mapping[str, Any]
    schema_version: int
    created_at: datetime


@dataclass(frozen=True, slots=True)
class Person:
    id: int
    name: str
    created_at: datetime


@dataclass(frozen=True, slots=True)
class AuditEntry:
    """Who did what to what; append-only."""

    id: int
    at: datetime
    actor: str
    action: str
    subject: str
    detail: Mapping[str, Any]
