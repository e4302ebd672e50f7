"""Places in the queue: which labels shapes still want, and in what order."""

from collections.abc import Collection as SizedIterable
from collections.abc import Mapping, Sequence
from datetime import datetime
from typing import Any

from sqlalchemy import BigInteger, Connection, Row, bindparam, cast, delete, exists, func, or_, select, update

from partwise.errors import ConflictError, NotFoundError
from partwise.store import tables as t
from partwise.store.queue_settings import MAX_LABELS_PER_SHAPE, QueueSettings, queue_settings_of
from partwise.store.records import EventKind, LeasePurpose, NewEvent, QueueDepth, ShapeState
from partwise.store.sql import leases
from partwise.store.sql.collections import append_audit
from partwise.store.sql.dialect import batches, insert_for
from partwise.store.sql.events import append_events
from partwise.store.sql.shapes import lock_labels, refuse_unknown_shapes

UNRANKED = 1_000_000_000
"""Shapes that nothing ranked come after all others, in order of their ids."""

FIRST = 0
"""The rank of shapes that were sent back."""

_COLUMNS = ("shape_id", "slot", "collection_id", "rank", "round", "n_slots", "opened_at")


def collection_queue_settings(connection: Connection, collection_id: int) -> QueueSettings:
    """The queue's settings of a collection."""
    settings = connection.execute(select(t.collection.c.settings).where(t.collection.c.id == collection_id)).scalar()
    if settings is None:
        raise NotFoundError(f"there is no collection with id {collection_id}")
    return queue_settings_of(settings)


def current_round(connection: Connection, shape_id: int) -> int:
    """The round that a shape is in, or was in last."""
    place = select(func.max(t.queue_rank.c.round)).where(t.queue_rank.c.shape_id == shape_id)
    past = select(func.max(t.lease.c.round)).where(t.lease.c.shape_id == shape_id)
    return connection.execute(place).scalar() or connection.execute(past).scalar() or 1


def renew_places(connection: Connection, shape_ids: SizedIterable[int], now: datetime) -> None:
    """Puts shapes that have become ready into the queue, and takes those out that are so no more. After facets."""
    for some in batches(shape_ids):
        facet = t.shape_facet
        is_unlabellable = facet.c.state.in_([ShapeState.NEW.value, ShapeState.FAILED.value])
        gone = select(facet.c.shape_id).where(facet.c.shape_id.in_(some), is_unlabellable)
        in_queue = t.queue_rank.c.shape_id.in_(gone.scalar_subquery())
        connection.execute(delete(t.queue_rank).where(in_queue, t.queue_rank.c.lease_id.is_(None)))
        of_ready = select(facet.c.collection_id).where(
            facet.c.shape_id.in_(some), facet.c.state == ShapeState.READY.value
        )
        for collection_id in connection.execute(of_ready.distinct()).scalars().all():
            _add_places(connection, collection_id, some, now)


def _add_places(connection: Connection, collection_id: int, shape_ids: Sequence[int], now: datetime) -> None:
    """Places for the ready shapes among these that have none."""
    n_slots = collection_queue_settings(connection, collection_id).labels_per_shape
    facet = t.shape_facet
    has_places = exists().where(t.queue_rank.c.shape_id == facet.c.shape_id)
    past_round = select(func.max(t.lease.c.round)).where(t.lease.c.shape_id == facet.c.shape_id).scalar_subquery()
    wanting = connection.execute(
        select(facet.c.shape_id, func.coalesce(past_round, 1))
        .where(facet.c.shape_id.in_(shape_ids), facet.c.collection_id == collection_id)
        .where(facet.c.state == ShapeState.READY.value, ~has_places)
    ).all()
    rows = [
        _place(shape_id, slot, collection_id, UNRANKED + shape_id, round_, n_slots, now)
        for shape_id, round_ in wanting
        for slot in range(n_slots)
    ]
    if rows:
        connection.execute(insert_for(connection, t.queue_rank).on_conflict_do_nothing(), rows)


def _place(
    shape_id: int, slot: int, collection_id: int, rank: int, round_: int, n_slots: int, now: datetime
) -> dict[str, object]:
    return dict(zip(_COLUMNS, (shape_id, slot, collection_id, rank, round_, n_slots, now), strict=True))


def close_places(connection: Connection, shape_id: int) -> None:
    """Takes a shape out of the queue; who holds it goes on."""
    connection.execute(delete(t.queue_rank).where(t.queue_rank.c.shape_id == shape_id))


def reopen(connection: Connection, shape_id: int, operator_id: int, for_person_id: int | None, now: datetime) -> None:
    operator = leases.person_name(connection, operator_id)
    events = put_first(connection, shape_id, for_person_id, now)
    detail = {"for_person_id": for_person_id}
    append_audit(connection, operator, "reopen shape", f"shape {shape_id}", detail, now)
    append_events(connection, events, now)


def put_first(connection: Connection, shape_id: int, for_person_id: int | None, now: datetime) -> list[NewEvent]:
    """Another round for a shape, first in the queue; the events are the caller's to add."""
    shape = refuse_unknown_shapes(connection, [shape_id])[shape_id]
    if for_person_id is not None:
        leases.person_name(connection, for_person_id)
    lock_labels(connection, [shape_id])  # and with them claims by name
    _, events = leases.end_expired(connection, shape_id, now)
    place = t.queue_rank
    # claims by rank lock a place first: what they have taken by now is among the leases below
    connection.execute(select(place.c.slot).where(place.c.shape_id == shape_id).with_for_update()).all()
    if held := leases.active_of_shape(connection, shape_id):
        raise ConflictError(
            f"a shape goes back into the queue when nobody works on it but person {held[0].person_id} works on shape "
            f"{shape_id}; wait, or clear lease {held[0].id}"
        )
    state = connection.execute(select(t.shape_facet.c.state).where(t.shape_facet.c.shape_id == shape_id)).scalar_one()
    if state in (ShapeState.NEW, ShapeState.FAILED):
        raise ConflictError(f"shape {shape_id} has no surface to label yet; it is {state}: preprocess it first")
    n_slots = collection_queue_settings(connection, shape.collection_id).labels_per_shape
    past = connection.execute(select(func.max(t.lease.c.round)).where(t.lease.c.shape_id == shape_id)).scalar() or 0
    if for_person_id is not None:
        n_slots = 1
    close_places(connection, shape_id)
    rows = [
        {**_place(shape_id, slot, shape.collection_id, FIRST, past + 1, n_slots, now), "person_id": for_person_id}
        for slot in range(n_slots)
    ]
    connection.execute(insert_for(connection, place), rows)
    return [*events, NewEvent(EventKind.QUEUE, shape.collection_id, {"shape_id": shape_id, "what": "reopened"})]


def assign(
    connection: Connection, shape_ids: Sequence[int], person_id: int | None, operator_id: int, now: datetime
) -> int:
    operator = leases.person_name(connection, operator_id)
    if person_id is not None:
        leases.person_name(connection, person_id)
    shapes = refuse_unknown_shapes(connection, shape_ids)
    n_assigned = 0
    for some in batches(sorted(shape_ids)):
        free = (t.queue_rank.c.shape_id.in_(some)) & t.queue_rank.c.lease_id.is_(None)
        n_assigned += connection.execute(update(t.queue_rank).where(free).values(person_id=person_id)).rowcount
    subject = f"{len(shape_ids)} shapes"
    detail = {"person_id": person_id, "shape_ids": list(shape_ids)[:100]}
    append_audit(connection, operator, "assign shapes", subject, detail, now)
    events = [
        NewEvent(EventKind.QUEUE, collection_id, {"what": "assigned", "person_id": person_id})
        for collection_id in sorted({shape.collection_id for shape in shapes.values()})
    ]
    append_events(connection, events, now)
    return n_assigned


def set_ranks(connection: Connection, collection_id: int, ranks: Mapping[int, int]) -> int:
    place, n_moved = t.queue_rank, 0
    for some in batches(sorted(ranks)):
        # what a claim is just taking is passed over: nobody waits for a ranking, and it waits for nobody
        query = (
            select(place.c.shape_id, place.c.slot, place.c.rank)
            .where(place.c.collection_id == collection_id, place.c.shape_id.in_(some), place.c.rank != FIRST)
            .with_for_update(skip_locked=True)
        )
        moved = [
            {"of_shape": row.shape_id, "in_slot": row.slot, "new_rank": ranks[row.shape_id]}
            for row in connection.execute(query)
            if row.rank != ranks[row.shape_id]
        ]
        if moved:
            is_it = (place.c.shape_id == bindparam("of_shape")) & (place.c.slot == bindparam("in_slot"))
            new_rank = cast(bindparam("new_rank"), BigInteger)
            connection.execute(update(place).where(is_it).values(rank=new_rank), moved)
            n_moved += len(moved)
    return n_moved


def following_places(connection: Connection, place: Row[Any], n_wanted: int) -> list[Row[Any]]:
    """The next free places of other shapes that anybody may have, from the rank of this one on: one for each shape."""
    other = t.queue_rank.c
    query = (
        select(t.queue_rank)
        .where(other.collection_id == place.collection_id, other.lease_id.is_(None), other.person_id.is_(None))
        .where(other.rank >= place.rank, other.shape_id != place.shape_id)
        .order_by(other.rank, other.shape_id, other.slot)
        .limit(n_wanted * MAX_LABELS_PER_SHAPE)
    )
    found: dict[int, Row[Any]] = {}
    for row in connection.execute(query):
        found.setdefault(row.shape_id, row)
    return list(found.values())[:n_wanted]


def fill(connection: Connection, collection_id: int, after: int, limit: int, now: datetime) -> int | None:
    facet = t.shape_facet
    query = (
        select(facet.c.shape_id, facet.c.state)
        .where(facet.c.collection_id == collection_id, facet.c.shape_id > after)
        .order_by(facet.c.shape_id)
        .limit(limit)
    )
    page = connection.execute(query).all()
    if not page:
        return None
    n_slots = collection_queue_settings(connection, collection_id).labels_per_shape
    ready = [row.shape_id for row in page if row.state == ShapeState.READY]
    for some in batches(ready):
        _resize(connection, collection_id, some, n_slots, now)
        _add_places(connection, collection_id, some, now)
    return int(page[-1].shape_id)


def _resize(connection: Connection, collection_id: int, shape_ids: Sequence[int], n_slots: int, now: datetime) -> None:
    """As many places as labels are wanted and not in; one stays at least, so that a round that began can end."""
    place, answer = t.queue_rank, t.answer
    answers: dict[tuple[int, int], set[int]] = {}
    known = select(answer.c.shape_id, answer.c.round, answer.c.slot).where(answer.c.shape_id.in_(shape_ids))
    for row in connection.execute(known.where(answer.c.purpose == LeasePurpose.INDEPENDENT.value)):
        answers.setdefault((row.shape_id, row.round), set()).add(row.slot)
    rows = connection.execute(select(place).where(place.c.shape_id.in_(shape_ids)).with_for_update()).all()
    for shape_id in {row.shape_id for row in rows}:
        own = [row for row in rows if row.shape_id == shape_id]
        if own[0].n_slots == n_slots or own[0].person_id is not None:
            continue
        taken = answers.get((shape_id, own[0].round), set())
        n_places = max(n_slots, len(taken) + 1)
        too_many = (place.c.shape_id == shape_id) & (place.c.slot >= n_places) & place.c.lease_id.is_(None)
        connection.execute(delete(place).where(too_many))
        missing = set(range(n_places)) - taken - {row.slot for row in own}
        first = own[0]
        new = [_place(shape_id, slot, collection_id, first.rank, first.round, n_slots, now) for slot in missing]
        if new:
            connection.execute(insert_for(connection, place).on_conflict_do_nothing(), new)
        connection.execute(update(place).where(place.c.shape_id == shape_id).values(n_slots=n_slots))


def queue_depth(connection: Connection, collection_id: int, now: datetime) -> QueueDepth:
    place, lease = t.queue_rank.c, t.lease.c
    collection_queue_settings(connection, collection_id)
    is_free = or_(place.lease_id.is_(None), lease.expires_at < now)
    query = (
        select(
            func.count().filter(is_free),
            func.count().filter(~is_free),
            func.count().filter(is_free, place.person_id.is_not(None)),
            func.min(place.opened_at).filter(is_free),
        )
        .join_from(t.queue_rank, t.lease, lease.id == place.lease_id, isouter=True)
        .where(place.collection_id == collection_id)
    )
    n_free, n_held, n_assigned, oldest_at = connection.execute(query).one()
    return QueueDepth(n_free, n_held, n_assigned, oldest_at)
