"""Reviews: labels that wait for someone to look at them.

An open review is always of the newest human or imported labels of its shape: what takes their place resolves it.
"""

from collections.abc import Sequence
from datetime import datetime
from typing import Any

from sqlalchemy import Connection, Row, insert, select, update

from partwise.errors import ConflictError, LabelError, NotFoundError
from partwise.store import tables as t
from partwise.store.catalog import SHOWN_KINDS
from partwise.store.records import LabelRevision
from partwise.store.reviews import NewReview, Review, ReviewOutcome, ReviewReason
from partwise.store.sql.collections import append_audit, schema_version

MACHINE = "partwise"
"""The actor in the audit trail of what nobody asked for in person."""


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


def lock_labels(connection: Connection, shape_id: int) -> None:
    """Makes others who commit or review labels of the shape wait, so that which are the newest does not change."""
    connection.execute(select(t.shape.c.id).where(t.shape.c.id == shape_id).with_for_update(key_share=True))


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
    lock_labels(connection, found.shape_id)
    kinds = [kind.value for kind in SHOWN_KINDS]
    if found.kind not in kinds:
        raise LabelError(f"only {' and '.join(kinds)} labels are reviewed but revision {revision_id} is {found.kind}")
    newest = (
        select(t.label_revision.c.id)
        .where(t.label_revision.c.shape_id == found.shape_id, t.label_revision.c.kind.in_(kinds))
        .order_by(t.label_revision.c.id.desc())
        .limit(1)
    )
    if (head := connection.execute(newest).scalar_one()) != revision_id:
        raise ConflictError(f"the newest labels are reviewed but revision {revision_id} gave way to {head}; name that")
    return found


def open_reviews(connection: Connection, collection_id: int, after: int, limit: int) -> Sequence[Review]:
    schema_version(connection, collection_id)
    query = (
        select(t.review)
        .where(t.review.c.collection_id == collection_id, t.review.c.resolved_at.is_(None), t.review.c.id > after)
        .order_by(t.review.c.id)
        .limit(limit)
    )
    return [_review(row) for row in connection.execute(query)]


def reviews(connection: Connection, shape_id: int) -> Sequence[Review]:
    query = select(t.review).where(t.review.c.shape_id == shape_id).order_by(t.review.c.id)
    return [_review(row) for row in connection.execute(query)]


def accept_review(connection: Connection, review_id: int, person_id: int, now: datetime) -> Review:
    person = connection.execute(select(t.person.c.name).where(t.person.c.id == person_id)).scalar()
    if person is None:
        raise NotFoundError(f"there is no person with id {person_id}; add them first")
    found = connection.execute(select(t.review).where(t.review.c.id == review_id).with_for_update()).first()
    if found is None:
        raise NotFoundError(f"there is no review {review_id}")
    if found.outcome is not None:
        raise ConflictError(f"a review is resolved once but review {review_id} is {found.outcome} already")
    values = {"resolved_at": now, "resolved_by": person_id, "outcome": ReviewOutcome.ACCEPTED.value}
    statement = update(t.review).where(t.review.c.id == review_id).values(values).returning(t.review)
    review = _review(connection.execute(statement).one())
    detail = {"review_id": review_id, "reason": found.reason, "shape_id": found.shape_id}
    append_audit(connection, person, "accept labels", f"label_revision {found.revision_id}", detail, now)
    return review


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
