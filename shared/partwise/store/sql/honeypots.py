"""Shapes whose true labels are known, handed out like any other, so that nobody can tell them from other work.

Only shapes that wait in the queue are, in the state of all that waits. What the lease tells of rank and score is what
that of the shape would be, or nearly, in whose place it is handed out.
"""

from datetime import datetime
from typing import Any

from sqlalchemy import ColumnElement, Connection, Row, and_, exists, func, or_, select, update

from partwise.store import tables as t
from partwise.store.records import Lease, LeasePurpose, NewClaim, ShapeState
from partwise.store.sql import leases
from partwise.store.sql.places import following_places
from partwise.store.sql.told import told_instead, told_of


def claim_honeypot(
    connection: Connection, claim: NewClaim, where: float, instead_of: Row[Any] | None, now: datetime
) -> Lease | None:
    """A shape that waits, with reference labels on its present mesh, that this person never had; None without one.

    where : uniform in [0, 1): it is the first such shape from that far between the lowest and the highest id.
    instead_of : the place that the person would get otherwise; None if there is none.
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
    place = _first(connection, claim, pot.shape_id >= pivot) or _first(connection, claim, pot.shape_id < pivot)
    return None if place is None else _take(connection, place, claim, instead_of, now)


def _first(connection: Connection, claim: NewClaim, is_in_reach: ColumnElement[bool]) -> Row[Any] | None:
    """The first free place of such a shape, locked."""
    held = exists().where(
        t.lease.c.shape_id == t.honeypot.c.shape_id,
        or_(t.lease.c.released_at.is_(None), t.lease.c.person_id == claim.person_id),
    )
    place = t.queue_rank
    is_place = and_(place.c.shape_id == t.honeypot.c.shape_id, place.c.lease_id.is_(None), place.c.person_id.is_(None))
    query = (
        select(place)
        .join_from(t.honeypot, place, is_place)
        .join(t.shape_facet, t.shape_facet.c.shape_id == t.honeypot.c.shape_id)
        .join(t.label_revision, t.label_revision.c.id == t.honeypot.c.revision_id)
        .join(
            t.shape,
            and_(t.shape.c.id == t.honeypot.c.shape_id, t.shape.c.mesh_hash == t.label_revision.c.mesh_hash),
        )
        .where(t.honeypot.c.collection_id == claim.collection_id, is_in_reach, ~held)
        .where(t.shape_facet.c.state == ShapeState.READY.value)
        .order_by(t.honeypot.c.shape_id, place.c.slot)
        .limit(1)
        .with_for_update(skip_locked=True, of=place)
    )
    return connection.execute(query).first()


def _take(
    connection: Connection, place: Row[Any], claim: NewClaim, instead_of: Row[Any] | None, now: datetime
) -> Lease | None:
    """The lease, with the shape's place, so that nobody else gets it meanwhile."""
    values = {
        **_told(connection, place, instead_of),
        "collection_id": claim.collection_id,
        "shape_id": place.shape_id,
        "slot": place.slot,
        "round": place.round,
        "person_id": claim.person_id,
        "purpose": LeasePurpose.BLIND,
    }
    taken = leases.acquire(connection, values, claim.lease_s, now, is_prefetched=claim.is_prefetch)
    if taken is not None:
        is_it = and_(t.queue_rank.c.shape_id == place.shape_id, t.queue_rank.c.slot == place.slot)
        connection.execute(update(t.queue_rank).where(is_it).values(lease_id=taken.id))
    return taken


def _told(connection: Connection, place: Row[Any], instead_of: Row[Any] | None) -> dict[str, Any]:
    if instead_of is None or instead_of.shape_id == place.shape_id:
        return told_of(connection, place.collection_id, place.shape_id, place)
    following = (each.shape_id for each in following_places(connection, instead_of, 2))
    neighbours = [instead_of.shape_id, *(shape_id for shape_id in following if shape_id != place.shape_id)]
    return told_instead(connection, instead_of, neighbours)
