"""Shapes that people gave back for good, and why."""

from collections.abc import Sequence

from sqlalchemy import Connection, select, text

from partwise.store import tables as t
from partwise.store.records import LeaseOutcome, SkippedShape
from partwise.store.sql.collections import schema_version


def skips(connection: Connection, collection_id: int, before: int | None, limit: int) -> Sequence[SkippedShape]:
    schema_version(connection, collection_id)
    lease = t.lease.c
    query = (
        select(
            lease.id,
            lease.shape_id,
            t.shape.c.source_key,
            lease.person_id,
            t.person.c.name,
            lease.reason,
            lease.released_at,
        )
        .join_from(t.lease, t.shape, t.shape.c.id == lease.shape_id)
        .join(t.person, t.person.c.id == lease.person_id)
        # written out: a partial index serves only a query whose text repeats its condition
        .where(lease.collection_id == collection_id, text(f"lease.outcome = '{LeaseOutcome.SKIPPED}'"))
        .order_by(lease.id.desc())
        .limit(limit)
    )
    if before is not None:
        query = query.where(lease.id < before)
    return [SkippedShape(*row) for row in connection.execute(query)]
