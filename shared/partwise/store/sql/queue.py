"""The queue: claims, by rank and by name."""

from datetime import datetime
from typing import Any

from sqlalchemy import ColumnElement, Connection, Row, and_, exists, func, or_, select, update

from partwise.errors import ConflictError
from partwise.store import tables as t
from partwise.store.records import (
    Lease,
    LeaseOutcome,
    LeasePurpose,
    NewClaim,
    ShapeState,
    check_lease_time,
)
from partwise.store.sql import leases
from partwise.store.sql.events import append_events
from partwise.store.sql.honeypots import claim_honeypot
from partwise.store.sql.places import collection_queue_settings, current_round, following_places
from partwise.store.sql.shapes import lock_labels, refuse_unknown_shapes
from partwise.store.sql.told import TOLD, told_instead, told_of

_TRIES = 20  # each fails only if someone took the very same place in the same moment


def claim_next(connection: Connection, claim: NewClaim, now: datetime) -> Lease | None:
    settings = collection_queue_settings(connection, claim.collection_id)
    leases.person_name(connection, claim.person_id, for_update=True)
    events = leases.expire(connection, claim.person_id, now)
    held = leases.leases_of(connection, claim.person_id)
    ahead = next((each for each in held if each.is_prefetched), None)
    taken: Lease | None
    if ahead is not None and ahead.collection_id == claim.collection_id:
        taken = leases.renew(connection, ahead.id, claim.person_id, claim.lease_s, claim.is_prefetch, now)
    else:
        if not claim.is_prefetch:
            leases.refuse_more(connection, held)
        elif ahead is not None:  # one is loaded ahead, of the collection that the person is at now
            own = leases.own_active(connection, ahead.id, claim.person_id)
            events.append(leases.end(connection, own, LeaseOutcome.RELEASED, now)[1])
        taken = None
        if claim.draw < settings.honeypot_share:
            place = _first_free_place(connection, claim, is_waiting=False)
            taken = claim_honeypot(connection, claim, claim.draw / settings.honeypot_share, place, now)
        taken = taken or _claim_by_rank(connection, claim, now)
        if taken is not None:
            events.append(leases.queue_event(taken, "claimed"))
    append_events(connection, events, now)
    return taken


def _claim_by_rank(connection: Connection, claim: NewClaim, now: datetime) -> Lease | None:
    for _ in range(_TRIES):
        place = _first_free_place(connection, claim, is_waiting=False)
        # passed over may be what a ranking holds for a moment: nothing is left only if waiting for it finds nothing
        place = place or _first_free_place(connection, claim, is_waiting=True)
        if place is None:
            return None
        taken = _take(connection, place, claim.person_id, claim.lease_s, now, is_prefetched=claim.is_prefetch)
        if taken is not None:
            return taken
    return None


def _first_free_place(connection: Connection, claim: NewClaim, *, is_waiting: bool) -> Row[Any] | None:
    """Of those kept for this person, else of those for anyone."""
    person_id = t.queue_rank.c.person_id
    own, anyones = and_(person_id == claim.person_id, person_id.is_not(None)), person_id.is_(None)
    return _first_place(connection, claim, own, is_waiting) or _first_place(connection, claim, anyones, is_waiting)


def _first_place(
    connection: Connection, claim: NewClaim, is_for_them: ColumnElement[bool], is_waiting: bool
) -> Row[Any] | None:
    """The first free place that this person may have, locked; those that others have locked are passed over or
    waited for.
    """
    place, past = t.queue_rank, t.lease
    is_over_for_them = and_(
        past.c.round == place.c.round,
        past.c.outcome.in_([LeaseOutcome.SKIPPED.value, LeaseOutcome.COMPLETED.value]),
    )
    had = exists().where(
        past.c.person_id == claim.person_id,
        past.c.shape_id == place.c.shape_id,
        or_(past.c.released_at.is_(None), is_over_for_them),
    )
    is_taken = exists().where(  # nobody's place should be free, but one that was would be all that everybody is offered
        past.c.shape_id == place.c.shape_id, past.c.slot == place.c.slot, past.c.released_at.is_(None)
    )
    query = (
        select(place)
        .where(place.c.collection_id == claim.collection_id, place.c.lease_id.is_(None), is_for_them, ~had, ~is_taken)
        .order_by(place.c.rank, place.c.shape_id, place.c.slot)
        .limit(1)
        .with_for_update(skip_locked=not is_waiting, of=place)
    )
    return connection.execute(query).first()


def _take(
    connection: Connection,
    place: Row[Any],
    person_id: int,
    lease_s: float,
    now: datetime,
    *,
    is_prefetched: bool = False,
) -> Lease | None:
    """A lease of a free, locked place."""
    is_for_anyone = place.person_id is None  # what is kept for somebody wants their labels, whatever they had before
    before = _as_before(connection, place, person_id) if is_for_anyone else None
    values = {
        **(before or _as_ranked(connection, place)),
        "collection_id": place.collection_id,
        "shape_id": place.shape_id,
        "slot": place.slot,
        "round": place.round,
        "person_id": person_id,
    }
    taken = leases.acquire(connection, values, lease_s, now, is_prefetched=is_prefetched)
    if taken is not None:
        is_it = and_(t.queue_rank.c.shape_id == place.shape_id, t.queue_rank.c.slot == place.slot)
        connection.execute(update(t.queue_rank).where(is_it).values(lease_id=taken.id))
    return taken


def _as_before(connection: Connection, place: Row[Any], person_id: int) -> dict[str, Any] | None:
    """Purpose and what is told, where this person's last lease of the shape was a blind check that they did not do: the
    same again, as a check would be known by what changes when it is given back and claimed once more.
    """
    past = t.lease.c
    is_theirs = and_(past.person_id == person_id, past.shape_id == place.shape_id, past.round == place.round)
    columns = (past.purpose, past.outcome, *(past[name] for name in TOLD))
    last = connection.execute(select(*columns).where(is_theirs).order_by(past.id.desc()).limit(1)).first()
    if last is None or last.purpose != LeasePurpose.BLIND or last.outcome == LeaseOutcome.COMPLETED:
        return None
    return {"purpose": LeasePurpose.BLIND, **{name: last._mapping[name] for name in TOLD}}


def _as_ranked(connection: Connection, place: Row[Any]) -> dict[str, Any]:
    purpose = LeasePurpose.INDEPENDENT if place.n_slots > 1 else LeasePurpose.LABEL
    return {"purpose": purpose, **_told(connection, place)}


def _told(connection: Connection, place: Row[Any]) -> dict[str, Any]:
    """What is told of a place; of one that checks a model's labels what is told of those about it."""
    is_check = (t.recheck.c.shape_id == place.shape_id) & t.recheck.c.checked_at.is_(None)
    neighbours = []
    if connection.execute(select(t.recheck.c.id).where(is_check)).first() is not None:
        neighbours = [each.shape_id for each in following_places(connection, place, 2)]
    if neighbours:
        return told_instead(connection, place, neighbours)
    return told_of(connection, place.collection_id, place.shape_id, place)


def claim_shape(connection: Connection, shape_id: int, person_id: int, lease_s: float, now: datetime) -> Lease:
    check_lease_time(lease_s)
    leases.person_name(connection, person_id, for_update=True)
    refuse_unknown_shapes(connection, [shape_id])
    lock_labels(connection, [shape_id])  # who reopens it sees this claim, or this one the place that is new
    events = leases.expire(connection, person_id, now)
    own = [each for each in leases.active_of_shape(connection, shape_id) if each.person_id == person_id]
    if own:
        taken = leases.renew(connection, own[0].id, person_id, lease_s, False, now)
    else:
        leases.refuse_another(connection, person_id)
        taken = take_by_name(connection, shape_id, person_id, lease_s, now)
        events.append(leases.queue_event(taken, "claimed"))
    append_events(connection, events, now)
    return taken


def take_by_name(connection: Connection, shape_id: int, person_id: int, lease_s: float, now: datetime) -> Lease:
    """The lease of a free place of a shape that this person may have, or of a shape that wants no more labels."""
    facet = connection.execute(select(t.shape_facet).where(t.shape_facet.c.shape_id == shape_id)).one()
    if facet.state in (ShapeState.NEW, ShapeState.FAILED):
        raise ConflictError(
            f"a shape needs a surface to be labelled but {facet.source_key} is {facet.state}; preprocess it first"
        )
    _refuse_second_answer(connection, facet, person_id)
    place = t.queue_rank
    is_for_them = or_(place.c.person_id.is_(None), place.c.person_id == person_id)
    free = select(place).where(place.c.shape_id == shape_id, place.c.lease_id.is_(None), is_for_them)
    found = connection.execute(free.order_by(place.c.slot).limit(1).with_for_update()).first()
    others = select(place.c.lease_id).where(place.c.shape_id == shape_id).limit(1)
    if found is not None:
        taken = _take(connection, found, person_id, lease_s, now)
    elif (waits := connection.execute(others).first()) is not None:  # what it wants are labels of those people
        whose = "kept for" if waits.lease_id is None else "with"
        raise ConflictError(f"{facet.source_key} is {whose} someone else now; take another, or ask an operator")
    else:
        values = {
            **told_of(connection, facet.collection_id, shape_id, None),
            "collection_id": facet.collection_id,
            "shape_id": shape_id,
            "slot": 0,
            "round": current_round(connection, shape_id),
            "person_id": person_id,
            "purpose": LeasePurpose.LABEL,
        }
        taken = leases.acquire(connection, values, lease_s, now)
    if taken is None:
        raise ConflictError(f"{facet.source_key} is with someone else now; take another, or ask an operator")
    return taken


def _refuse_second_answer(connection: Connection, facet: Row[Any], person_id: int) -> None:
    """Independent labels are different people's: whoever's is in waits until the round is complete."""
    past = t.lease
    is_compared = exists().where(t.queue_rank.c.shape_id == facet.shape_id, t.queue_rank.c.round == past.c.round)
    query = select(func.count()).where(
        past.c.shape_id == facet.shape_id,
        past.c.person_id == person_id,
        past.c.outcome == LeaseOutcome.COMPLETED.value,
        past.c.purpose == LeasePurpose.INDEPENDENT.value,
        is_compared,
    )
    if connection.execute(query).scalar_one():
        raise ConflictError(
            f"independent labels must be different people's but this person's of {facet.source_key} are in; "
            "wait until the others' are"
        )
