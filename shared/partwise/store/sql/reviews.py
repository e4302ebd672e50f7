"""Reviews: labels that wait for someone to look at them.

An open review is always of the newest human or imported labels of its shape: what takes their place resolves it.
"""

from collections.abc import Collection as SizedIterable
from collections.abc import Sequence
from datetime import datetime
from typing import Any

from sqlalchemy import ColumnElement, Connection, Row, func, insert, select, update

from partwise.errors import ConflictError, LabelError, NotFoundError, ParameterError
from partwise.store import tables as t
from partwise.store.catalog import SHOWN_KINDS
from partwise.store.records import EventKind, LabelRevision, NewEvent, ShapeState
from partwise.store.reviews import FOR_REVIEWERS, NewReview, Review, ReviewOutcome, ReviewReason
from partwise.store.sql.collections import append_audit, schema_version
from partwise.store.sql.events import append_events
from partwise.store.sql.facets import renew_facets
from partwise.store.sql.leases import person_name
from partwise.store.sql.places import close_places, put_first
from partwise.store.sql.shapes import lock_labels, refuse_unknown_shapes
from partwise.store.sql.tally import count_confirmed

MACHINE = "partwise"
"""The actor in the audit trail of what nobody asked for in person."""

_NOTE_LENGTH = 2_000


def add_review(connection: Connection, revision_id: int, new: NewReview, now: datetime) -> Review:
    found = _refuse_unfit(connection, revision_id)
    is_same = (t.review.c.shape_id == found.shape_id) & (t.review.c.reason == new.reason.value)
    known = connection.execute(select(t.review).where(is_same, t.review.c.resolved_at.is_(None))).first()
    if known is not None:
        return _review(known)
    values = {
        "collection_id": found.collection_id,
        "shape_id": found.shape_id,
        "revision_id": revision_id,
        "reason": new.reason.value,
        "detail": dict(new.detail),
        "created_at": now,
    }
    return _review(connection.execute(insert(t.review).values(values).returning(t.review)).one())


def _refuse_unfit(connection: Connection, revision_id: int) -> Row[Any, Any, Any]:
    """The shape and collection of a revision that may be reviewed: the newest that is shown."""
    columns = (t.label_revision.c.shape_id, t.label_revision.c.kind, t.shape.c.collection_id)
    of_revision = (
        select(*columns)
        .join_from(t.label_revision, t.shape, t.shape.c.id == t.label_revision.c.shape_id)
        .where(t.label_revision.c.id == revision_id)
    )
    found = connection.execute(of_revision).first()
    if found is None:
        raise NotFoundError(f"there is no label revision {revision_id}")
    lock_labels(connection, [found.shape_id])
    kinds = [kind.value for kind in SHOWN_KINDS]
    if found.kind not in kinds:
        raise LabelError(f"only {' and '.join(kinds)} labels are reviewed but revision {revision_id} is {found.kind}")
    if (head := _head_id(connection, found.shape_id)) != revision_id:
        raise ConflictError(f"the newest labels are reviewed but revision {revision_id} gave way to {head}; name that")
    return found


def _head_id(connection: Connection, shape_id: int) -> int | None:
    """The newest revision of a shape that is shown."""
    revision = t.label_revision.c
    of_shape = select(func.max(revision.id)).where(revision.shape_id == shape_id)
    return connection.execute(of_shape.where(revision.kind.in_([kind.value for kind in SHOWN_KINDS]))).scalar()


def open_reviews(
    connection: Connection, collection_id: int, after: int, limit: int, reasons: SizedIterable[ReviewReason]
) -> Sequence[Review]:
    schema_version(connection, collection_id)
    query = select(t.review).where(*_is_open(collection_id, reasons), t.review.c.id > after)
    return [_review(row) for row in connection.execute(query.order_by(t.review.c.id).limit(limit))]


def count_open_reviews(connection: Connection, collection_id: int, reasons: SizedIterable[ReviewReason]) -> int:
    schema_version(connection, collection_id)
    query = select(func.count()).select_from(t.review).where(*_is_open(collection_id, reasons))
    return connection.execute(query).scalar_one()


def _is_open(collection_id: int, reasons: SizedIterable[ReviewReason]) -> list[ColumnElement[bool]]:
    review = t.review.c
    is_of_reason = [] if set(reasons) == set(ReviewReason) else [review.reason.in_([each.value for each in reasons])]
    return [review.collection_id == collection_id, review.resolved_at.is_(None), *is_of_reason]


def reviews(connection: Connection, shape_id: int) -> Sequence[Review]:
    query = select(t.review).where(t.review.c.shape_id == shape_id).order_by(t.review.c.id)
    return [_review(row) for row in connection.execute(query)]


def open_review(connection: Connection, revision_id: int, new: NewReview, now: datetime) -> Review:
    review = add_review(connection, revision_id, new, now)
    append_events(connection, [_renewed(connection, review)], now)
    return review


def accept_review(connection: Connection, review_id: int, person_id: int, now: datetime) -> Review:
    person = person_name(connection, person_id)
    found = locked_review(connection, review_id)
    review = _resolved(connection, review_id, person_id, ReviewOutcome.ACCEPTED, now)
    detail = {"review_id": review_id, "reason": found.reason.value, "shape_id": found.shape_id}
    append_audit(connection, person, "accept labels", f"label_revision {found.revision_id}", detail, now)
    if found.reason is ReviewReason.REWORK:
        close_places(connection, found.shape_id)
    event = _renewed(connection, review)
    events = [event]
    if event.payload["state"] == ShapeState.CONFIRMED:
        events = [*count_confirmed(connection, found.collection_id, now), event]
    append_events(connection, events, now)
    return review


def accept_reviews(
    connection: Connection, collection_id: int, reason: ReviewReason, person_id: int, limit: int, now: datetime
) -> int:
    if reason not in FOR_REVIEWERS:
        raise ParameterError(f"labels that were sent back wait for better ones but reason is {reason}; name another")
    schema_version(connection, collection_id)
    person = person_name(connection, person_id)
    waiting = select(t.review.c.id, t.review.c.shape_id).where(*_is_open(collection_id, (reason,)))
    page = connection.execute(waiting.order_by(t.review.c.id).limit(limit)).all()
    if not page:
        return 0
    lock_labels(connection, [row.shape_id for row in page])
    schema_version(connection, collection_id, for_share=True)
    is_it = t.review.c.id.in_([row.id for row in page]) & t.review.c.resolved_at.is_(None)
    values = {"resolved_at": now, "resolved_by": person_id, "outcome": ReviewOutcome.ACCEPTED.value}
    statement = update(t.review).where(is_it).values(values).returning(t.review.c.shape_id)
    shape_ids = sorted(connection.execute(statement).scalars())
    renew_facets(connection, shape_ids)
    detail = {"reason": reason.value, "n_shapes": len(shape_ids), "shape_ids": shape_ids[:100]}
    append_audit(connection, person, "accept labels", f"collection {collection_id}", detail, now)
    payload = {"what": "labels accepted", "n_shapes": len(shape_ids)}
    events = [NewEvent(EventKind.SHAPE, collection_id, payload)]
    if n_confirmed := _n_confirmed(connection, shape_ids):
        events = [*count_confirmed(connection, collection_id, now, n_confirmed), *events]
    append_events(connection, events, now)
    return len(shape_ids)


def _n_confirmed(connection: Connection, shape_ids: Sequence[int]) -> int:
    facet = t.shape_facet.c
    query = select(func.count()).where(facet.shape_id.in_(shape_ids), facet.state == ShapeState.CONFIRMED.value)
    return connection.execute(query).scalar_one()


def reject_review(
    connection: Connection, review_id: int, person_id: int, note: str, *, for_author: bool, now: datetime
) -> Review:
    found = locked_review(connection, review_id)
    return _reject(connection, found, person_id, note, for_author=for_author, now=now)


def reject_labels(
    connection: Connection, shape_id: int, person_id: int, note: str, *, for_author: bool, now: datetime
) -> Review:
    refuse_unknown_shapes(connection, [shape_id])
    lock_labels(connection, [shape_id])
    of_shape = select(t.shape.c.collection_id).where(t.shape.c.id == shape_id)
    schema_version(connection, connection.execute(of_shape).scalar_one(), for_share=True)  # as `locked_review`
    opened = [review for review in reviews(connection, shape_id) if review.resolved_at is None]
    if any(review.reason is ReviewReason.REWORK for review in opened):
        raise ConflictError(f"labels are sent back once but those of shape {shape_id} were already; await better ones")
    if opened:
        review = opened[0]
    else:
        if (head_id := _head_id(connection, shape_id)) is None:
            raise NotFoundError(f"shape {shape_id} has no labels to send back")
        review = add_review(connection, head_id, NewReview(ReviewReason.CHECK), now)
    return _reject(connection, review, person_id, note, for_author=for_author, now=now)


def _reject(
    connection: Connection, found: Review, person_id: int, note: str, *, for_author: bool, now: datetime
) -> Review:
    """Ends an open review whose shape is locked; the review of reason rework that follows it."""
    if not note.strip() or len(note) > _NOTE_LENGTH:
        raise ParameterError(
            f"labels are sent back with a note of at most {_NOTE_LENGTH} characters; say what is wrong"
        )
    person = person_name(connection, person_id)
    _resolved(connection, found.id, person_id, ReviewOutcome.REJECTED, now)
    author = select(t.label_revision.c.author_id).where(t.label_revision.c.id == found.revision_id)
    author_id = connection.execute(author).scalar_one()
    queued = put_first(connection, found.shape_id, author_id if for_author else None, now)
    detail = {"note": note.strip(), "reviewer_id": person_id, "review_id": found.id, "reason": found.reason.value}
    rework = add_review(connection, found.revision_id, NewReview(ReviewReason.REWORK, detail), now)
    append_audit(connection, person, "reject labels", f"label_revision {found.revision_id}", detail, now)
    append_events(connection, [*queued, _renewed(connection, rework)], now)
    return rework


def locked_review(connection: Connection, review_id: int) -> Review:
    """An open review, locked after its shape and collection, as whoever commits labels does it."""
    about = select(t.review.c.shape_id, t.review.c.collection_id).where(t.review.c.id == review_id)
    known = connection.execute(about).first()
    if known is None:
        raise NotFoundError(f"there is no review {review_id}")
    lock_labels(connection, [known.shape_id])
    schema_version(connection, known.collection_id, for_share=True)  # no parts change while labels are found right
    found = _review(connection.execute(select(t.review).where(t.review.c.id == review_id).with_for_update()).one())
    if found.outcome is not None:
        raise ConflictError(f"a review is resolved once but review {review_id} is {found.outcome} already")
    return found


def _resolved(connection: Connection, review_id: int, person_id: int, outcome: ReviewOutcome, now: datetime) -> Review:
    values = {"resolved_at": now, "resolved_by": person_id, "outcome": outcome.value}
    statement = update(t.review).where(t.review.c.id == review_id).values(values).returning(t.review)
    return _review(connection.execute(statement).one())


def _renewed(connection: Connection, about: Review) -> NewEvent:
    """Brings the table of shapes up to date; the event that says so."""
    renew_facets(connection, [about.shape_id])
    facet = t.shape_facet.c
    state = connection.execute(select(facet.state).where(facet.shape_id == about.shape_id)).scalar_one()
    payload = {"shape_id": about.shape_id, "state": state, "review_id": about.id}
    return NewEvent(EventKind.SHAPE, about.collection_id, payload)


def succeed_reviews(connection: Connection, successor: LabelRevision, now: datetime) -> None:
    """Resolves what was open of the shape, as the new revision takes the place of the one under review.

    Labels that were merely moved keep the reviews that have nothing to do with the move.
    """
    is_open = (t.review.c.shape_id == successor.shape_id) & t.review.c.resolved_at.is_(None)
    pending = [_review(row) for row in connection.execute(select(t.review).where(is_open).order_by(t.review.c.id))]
    if not pending:
        return
    is_moved = successor.origin is not None
    outcome = ReviewOutcome.SUPERSEDED if is_moved else ReviewOutcome.CORRECTED
    values = {
        "resolved_at": now,
        "resolved_by": None if is_moved else successor.author_id,
        "outcome": outcome.value,
    }
    connection.execute(update(t.review).where(is_open).values(values))
    for review in pending:
        if is_moved and review.reason is not ReviewReason.MAP_BACK:
            add_review(connection, successor.id, NewReview(review.reason, review.detail), now)


def _review(row: Row[Any]) -> Review:
    outcome = None if row.outcome is None else ReviewOutcome(row.outcome)
    return Review(**{**row._mapping, "reason": ReviewReason(row.reason), "outcome": outcome})
