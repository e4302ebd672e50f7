"""Leases: who holds what, for how long, and how that ends."""

from collections.abc import Collection as SizedIterable
from collections.abc import Mapping, Sequence
from datetime import datetime, timedelta
from typing import Any

from sqlalchemy import Connection, Row, Select, and_, bindparam, delete, select, update

from partwise.errors import ConflictError, NotFoundError, ParameterError
from partwise.store import tables as t
from partwise.store.records import (
    MAX_HELD,
    EventKind,
    Lease,
    LeasedShape,
    LeaseOutcome,
    LeasePurpose,
    NewEvent,
    ShapeState,
    check_lease_time,
)
from partwise.store.sql.collections import append_audit
from partwise.store.sql.dialect import batches, insert_for
from partwise.store.sql.draft_binding import bind_draft
from partwise.store.sql.events import append_events

_EXPIRED_AT_ONCE = 100  # the next claims find the others: a claim must not grow with how many left
_REASON_LENGTH = 2_000


def lease(connection: Connection, lease_id: int) -> Lease:
    return _found(connection.execute(select(t.lease).where(t.lease.c.id == lease_id)).first(), lease_id)


def leases_of(connection: Connection, person_id: int) -> list[Lease]:
    found = connection.execute(_HELD, {"of_person": person_id})
    return sorted((to_lease(row) for row in found), key=lambda each: each.id)


def leased_by(connection: Connection, person_id: int) -> list[LeasedShape]:
    found = connection.execute(_LEASED_BY, {"of_person": person_id})
    return sorted((_leased(row) for row in found), key=lambda each: each.lease.id)


def leased_shapes(connection: Connection, lease_ids: SizedIterable[int]) -> dict[int, LeasedShape]:
    found = {}
    for some in batches(lease_ids):
        found.update({row.id: _leased(row) for row in connection.execute(_LEASED, {"ids": some})})
    return found


def active_leases(connection: Connection, collection_id: int, after: int, limit: int) -> list[Lease]:
    query = (
        select(t.lease)
        .where(t.lease.c.collection_id == collection_id, t.lease.c.released_at.is_(None), t.lease.c.id > after)
        .order_by(t.lease.c.id)
        .limit(limit)
    )
    return [to_lease(row) for row in connection.execute(query)]


def held_shapes(connection: Connection, shape_ids: SizedIterable[int]) -> dict[int, list[Lease]]:
    found: dict[int, list[Lease]] = {}
    for some in batches(shape_ids):
        query = select(t.lease).where(t.lease.c.shape_id.in_(some), t.lease.c.released_at.is_(None))
        for row in connection.execute(query.order_by(t.lease.c.id)):
            found.setdefault(row.shape_id, []).append(to_lease(row))
    return found


def acquire(
    connection: Connection, values: dict[str, Any], lease_s: float, now: datetime, *, is_prefetched: bool = False
) -> Lease | None:
    """A new lease; None if the place or the shape has become another's, or this person's, in this very moment.

    values : collection_id, shape_id, slot, round, person_id, purpose. The person's open draft goes on under them.
    """
    row = {
        **values,
        "purpose": values["purpose"].value,
        "is_prefetched": is_prefetched,
        "acquired_at": now,
        "expires_at": now + timedelta(seconds=lease_s),
    }
    statement = insert_for(connection, t.lease).values(row).on_conflict_do_nothing().returning(t.lease)
    found = connection.execute(statement).first()
    if found is None:
        return None
    acquired = to_lease(found)
    bind_draft(connection, acquired)
    return acquired


def expire(connection: Connection, person_id: int, now: datetime) -> list[NewEvent]:
    """Ends leases of others than this person that were not renewed in time; their places are free then."""
    query = (
        select(t.lease)
        .where(t.lease.c.released_at.is_(None), t.lease.c.expires_at < now, t.lease.c.person_id != person_id)
        .order_by(t.lease.c.expires_at)
        .limit(_EXPIRED_AT_ONCE)
        .with_for_update(skip_locked=True)
    )
    lost = [to_lease(row) for row in connection.execute(query)]
    return [end(connection, each, LeaseOutcome.EXPIRED, now)[1] for each in lost]


def renew(
    connection: Connection, lease_id: int, person_id: int, lease_s: float, is_prefetched: bool | None, now: datetime
) -> Lease:
    check_lease_time(lease_s)
    if is_prefetched is False:  # before the lease, as in claims: two at once must not both find room for one more
        person_name(connection, person_id, for_update=True)
    known = own_active(connection, lease_id, person_id)
    if known.is_prefetched and is_prefetched is False:
        refuse_another(connection, person_id)
    values = {
        "expires_at": now + timedelta(seconds=lease_s),
        "is_prefetched": known.is_prefetched and is_prefetched is not False,
    }
    statement = update(t.lease).where(t.lease.c.id == lease_id).values(values).returning(t.lease)
    return to_lease(connection.execute(statement).one())


def refuse_another(connection: Connection, person_id: int) -> None:
    """Let nobody hold more than `MAX_HELD` shapes beside the prefetched one."""
    refuse_more(connection, leases_of(connection, person_id))


def refuse_more(connection: Connection, held: Sequence[Lease]) -> None:
    """As `refuse_another`. held : all that the person holds."""
    at_hand = [each.shape_id for each in held if not each.is_prefetched]
    if len(at_hand) >= MAX_HELD:
        name = select(t.shape.c.source_key).where(t.shape.c.id.in_(at_hand))
        shapes = ", ".join(connection.scalars(name.order_by(t.shape.c.id)))
        raise ConflictError(
            f"a person holds at most {MAX_HELD} shapes and holds {shapes}; confirm or release one first"
        )


def release(connection: Connection, lease_id: int, person_id: int, now: datetime) -> Lease:
    known = _own(connection, lease_id, person_id)
    if known.released_at is not None:
        return known
    ended, event = end(connection, known, LeaseOutcome.RELEASED, now)
    append_events(connection, [event], now)
    return ended


def skip(connection: Connection, lease_id: int, person_id: int, reason: str, now: datetime) -> Lease:
    if not reason.strip() or len(reason) > _REASON_LENGTH:
        raise ParameterError(f"a skip needs a reason of at most {_REASON_LENGTH} characters; say what is wrong with it")
    known = own_active(connection, lease_id, person_id)
    ended, event = end(connection, known, LeaseOutcome.SKIPPED, now, reason.strip())
    append_events(connection, [event], now)
    return ended


def clear(connection: Connection, lease_id: int, operator_id: int, now: datetime) -> Lease:
    known = _locked(connection, lease_id)
    operator = person_name(connection, operator_id)
    if known.released_at is not None:
        return known
    ended, event = end(connection, known, LeaseOutcome.CLEARED, now)
    detail = {"shape_id": known.shape_id, "person_id": known.person_id}
    append_audit(connection, operator, "clear lease", f"lease {lease_id}", detail, now)
    append_events(connection, [event], now)
    return ended


def end(
    connection: Connection, known: Lease, outcome: LeaseOutcome, now: datetime, reason: str | None = None
) -> tuple[Lease, NewEvent]:
    """Ends an active, locked lease and gives its place back, or takes it away if its label is in."""
    values = {"released_at": now, "outcome": outcome.value, "reason": reason}
    statement = update(t.lease).where(t.lease.c.id == known.id).values(values).returning(t.lease)
    ended = to_lease(connection.execute(statement).one())
    of_lease = t.queue_rank.c.lease_id == known.id
    if outcome is LeaseOutcome.COMPLETED and known.purpose is not LeasePurpose.BLIND:
        connection.execute(delete(t.queue_rank).where(of_lease))
    else:
        connection.execute(update(t.queue_rank).where(of_lease).values(lease_id=None))
    return ended, queue_event(ended, outcome.value)


def queue_event(about: Lease, what: str) -> NewEvent:
    """Says that a shape was taken or given back."""
    payload = {"shape_id": about.shape_id, "person_id": about.person_id, "what": what}
    return NewEvent(EventKind.QUEUE, about.collection_id, payload)


def person_name(connection: Connection, person_id: int, *, for_update: bool = False) -> str:
    """The person's name. `for_update` makes what else this person asks for wait."""
    query = select(t.person.c.name).where(t.person.c.id == person_id)
    name = connection.execute(query.with_for_update(key_share=True) if for_update else query).scalar()
    if name is None:
        raise NotFoundError(f"there is no person with id {person_id}; add them first")
    return name


def own_active(connection: Connection, lease_id: int, person_id: int) -> Lease:
    """A person's lease that has not ended, locked. `ConflictError` otherwise."""
    known = _own(connection, lease_id, person_id)
    if known.outcome is not None:
        raise ConflictError(
            f"a lease must last for this but lease {lease_id} is {known.outcome}; claim the shape again"
        )
    return known


def _own(connection: Connection, lease_id: int, person_id: int) -> Lease:
    known = _locked(connection, lease_id)
    if known.person_id != person_id:
        raise ConflictError(f"a lease is used by its holder only but lease {lease_id} is another person's")
    return known


def _locked(connection: Connection, lease_id: int) -> Lease:
    query = select(t.lease).where(t.lease.c.id == lease_id).with_for_update()
    return _found(connection.execute(query).first(), lease_id)


def _found(row: Row[Any] | None, lease_id: int) -> Lease:
    if row is None:
        raise NotFoundError(f"there is no lease {lease_id}; was it another workspace's?")
    return to_lease(row)


def to_lease(row: Row[Any]) -> Lease:
    return _lease({**row._mapping})


def _lease(columns: Mapping[str, Any]) -> Lease:
    outcome = None if columns["outcome"] is None else LeaseOutcome(columns["outcome"])
    return Lease(**{**columns, "purpose": LeasePurpose(columns["purpose"]), "outcome": outcome})


def active_of_shape(connection: Connection, shape_id: int) -> Sequence[Lease]:
    """The leases of a shape that have not ended."""
    return held_shapes(connection, [shape_id]).get(shape_id, [])


def end_expired(connection: Connection, shape_id: int, now: datetime) -> tuple[list[Lease], list[NewEvent]]:
    """Ends a shape's leases that were not renewed in time; those that go on, and the events.

    Lock the labels of the shape before, and its places afterwards, as whoever ends a lease does.
    """
    held, events = list[Lease](), list[NewEvent]()
    for known in active_of_shape(connection, shape_id):
        locked = _locked(connection, known.id)
        if locked.outcome is not None:
            continue
        if locked.expires_at < now:
            events.append(end(connection, locked, LeaseOutcome.EXPIRED, now)[1])
        else:
            held.append(locked)
    return held, events


def _leased(row: Row[Any]) -> LeasedShape:
    lease_row = {name: row._mapping[name] for name in _LEASE_COLUMNS}
    return LeasedShape(_lease(lease_row), row.source_key, ShapeState(row.state), row.mesh_hash, row.draft_id)


def _with_shapes() -> Select[Any]:
    """Leases beside their shapes and their holders' open drafts of these."""
    known, draft = t.lease.c, t.draft.c
    is_theirs = and_(draft.person_id == known.person_id, draft.shape_id == known.shape_id, draft.closed_at.is_(None))
    shape = (t.shape.c.source_key, t.shape.c.mesh_hash, t.shape_facet.c.state)
    return (
        select(t.lease, *shape, draft.id.label("draft_id"))
        .join_from(t.lease, t.shape, t.shape.c.id == known.shape_id)
        .join(t.shape_facet, t.shape_facet.c.shape_id == known.shape_id)
        .join(t.draft, is_theirs, isouter=True)
    )


# Built once, as everybody at work asks them every few seconds.
_LEASE_COLUMNS = t.lease.c.keys()
_IS_HELD = and_(t.lease.c.person_id == bindparam("of_person"), t.lease.c.released_at.is_(None))
_HELD = select(t.lease).where(_IS_HELD)
_LEASED_BY = _with_shapes().where(_IS_HELD)
_LEASED = _with_shapes().where(t.lease.c.id.in_(bindparam("ids", expanding=True)))
