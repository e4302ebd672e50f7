"""A person's open draft of a shape belongs to the lease under which they work on it now."""

from typing import Any

from sqlalchemy import Connection, Row, update

from partwise.store import tables as t
from partwise.store.records import Lease


def bind_draft(connection: Connection, lease: Lease) -> Row[Any] | None:
    """Gives the holder's open draft of the leased shape the lease's place and purpose; None if they have none."""
    draft = t.draft.c
    statement = (
        update(t.draft)
        .where(draft.person_id == lease.person_id, draft.shape_id == lease.shape_id, draft.closed_at.is_(None))
        .values(slot=lease.slot, round=lease.round, purpose=lease.purpose.value)
        .returning(t.draft)
    )
    return connection.execute(statement).first()
