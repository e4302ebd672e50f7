"""Events, in the order in which they become visible."""

from collections.abc import Sequence
from datetime import datetime
from typing import Any

from sqlalchemy import Connection, Row, delete, func, insert, or_, select, text

from partwise.store import tables as t
from partwise.store.records import Event, EventBounds, EventKind, NewEvent

_LOCK = 7_046_029_254_386_354  # any number that no other use of the database takes as its advisory lock


def append_events(connection: Connection, events: Sequence[NewEvent], now: datetime) -> list[Event]:
    """Add events; the last thing a transaction does.

    PostgreSQL gives out ids before it commits: a reader could pass over an event that commits late. So whoever adds
    events waits for those before; taken last, the lock is held for a commit only, and nobody waits in a circle.
    """
    if not events:
        return []
    if connection.dialect.name == "postgresql":
        connection.execute(text("SELECT pg_advisory_xact_lock(:lock)"), {"lock": _LOCK})
    rows = [
        {"at": now, "kind": event.kind.value, "collection_id": event.collection_id, "payload": dict(event.payload)}
        for event in events
    ]
    return [_event(row) for row in connection.execute(_APPEND, rows)]


def events(connection: Connection, after: int, collection_ids: Sequence[int] | None, limit: int) -> Sequence[Event]:
    query = select(t.event).where(t.event.c.id > after).order_by(t.event.c.id).limit(limit)
    if collection_ids is not None:
        is_theirs = t.event.c.collection_id.in_(collection_ids)
        query = query.where(or_(is_theirs, t.event.c.collection_id.is_(None)))
    return [_event(row) for row in connection.execute(query)]


def event_bounds(connection: Connection) -> EventBounds:
    oldest = connection.execute(select(func.min(t.event.c.id))).scalar()
    newest = connection.execute(select(func.max(t.event.c.id))).scalar()
    return EventBounds(oldest or 0, newest or 0)


def prune_events(connection: Connection, before: datetime, limit: int) -> int:
    old = select(t.event.c.id).where(t.event.c.at < before).order_by(t.event.c.at).limit(limit)
    return connection.execute(delete(t.event).where(t.event.c.id.in_(old.scalar_subquery()))).rowcount


def _event(row: Row[Any]) -> Event:
    return Event(**{**row._mapping, "kind": EventKind(row.kind)})


_APPEND = insert(t.event).returning(t.event, sort_by_parameter_order=True)
"""However many there are, one statement, which gives them their ids in their order."""
