"""Shapes whose true labels are known, handed out like any other."""

from datetime import datetime

from sqlalchemy import ColumnElement, Connection, and_, exists, func, or_, select, update

from partwise.store import tables as t
from partwise.store.records import Lease, LeasePurpose, NewClaim
from partwise.store.sql import leases
from partwise.store.sql.places import current_round


def claim_honeypot(connection: Connection, claim: NewClaim, where: float, now: datetime) -> Lease | None:
    """A shape with reference labels on its present mesh that this person never had; None if there is none.

    where : uniform in [0, 1): it is the first such shape from that far between the lowest and the highest id.
    """
    pot = t.honeypot.c
    # apart, as only alone each is the end of an index
    lowest = connection.execute(select(func.min(pot.shape_id)).where(pot.collection_id == claim.collection_id)).scalar()
    highest = connection.execute(
        select(func.max(pot.shape_id)).where(pot.collection_id == claim.collection_id)
    ).scalar()
    if lowest is None or highest is None:
        return None
    pivot = lowest + int(where * (highest - lowest + 1))
    shape_id = _first(connection, claim, pot.shape_id >= pivot) or _first(connection, claim, pot.shape_id < pivot)
    if shape_id is None:
        return None
    return _take(connection, shape_id, claim, now)


def _first(connection: Connection, claim: NewClaim, is_in_reach: ColumnElement[bool]) -> int | None:
    held = exists().where(
        t.lease.c.shape_id == t.honeypot.c.shape_id,
        or_(t.lease.c.released_at.is_(None), t.lease.c.person_id == claim.person_id),
    )
    query = (
        select(t.honeypot.c.shape_id)
        .join(t.label_revision, t.label_revision.c.id == t.honeypot.c.revision_id)
        .join(
            t.shape,
            and_(t.shape.c.id == t.honeypot.c.shape_id, t.shape.c.mesh_hash == t.label_revision.c.mesh_hash),
        )
        .where(t.honeypot.c.collection_id == claim.collection_id, is_in_reach, ~held)
        .order_by(t.honeypot.c.shape_id)
        .limit(1)
    )
    return connection.execute(query).scalar()


def _take(connection: Connection, shape_id: int, claim: NewClaim, now: datetime) -> Lease | None:
    """The lease, with the shape's first place if it is in the queue, so that nobody else gets it meanwhile."""
    place = and_(t.queue_rank.c.shape_id == shape_id, t.queue_rank.c.slot == 0)
    if connection.execute(select(t.queue_rank.c.slot).where(place)).first() is not None:
        free = select(t.queue_rank.c.slot).where(place, t.queue_rank.c.lease_id.is_(None))
        if connection.execute(free.with_for_update(skip_locked=True)).first() is None:
            return None
    values = {
        "collection_id": claim.collection_id,
        "shape_id": shape_id,
        "slot": 0,
        "round": current_round(connection, shape_id),
        "person_id": claim.person_id,
        "purpose": LeasePurpose.BLIND,
    }
    taken = leases.acquire(connection, values, claim.lease_s, now, is_prefetched=claim.is_prefetch)
    if taken is not None:
        connection.execute(update(t.queue_rank).where(place).values(lease_id=taken.id))
    return taken
