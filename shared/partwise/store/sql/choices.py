"""Choosing: of several people's labels a reviewer makes one the shape's."""

from datetime import datetime

from sqlalchemy import Connection

from partwise.errors import ConflictError, NotFoundError
from partwise.store.records import LabelRevision, NewRevision, RevisionKind
from partwise.store.reviews import ReviewReason
from partwise.store.sql.answers import answer, answer_labels, consensus_of
from partwise.store.sql.collections import append_audit
from partwise.store.sql.events import append_events
from partwise.store.sql.labels import commit_revision
from partwise.store.sql.leases import person_name
from partwise.store.sql.reviews import locked_review


def choose_answer(
    connection: Connection, review_id: int, answer_id: int, person_id: int, now: datetime
) -> LabelRevision:
    reviewer = person_name(connection, person_id)
    review = locked_review(connection, review_id)
    if review.reason is not ReviewReason.DISAGREEMENT:
        raise ConflictError(
            f"labels are chosen where people disagree but review {review_id} is of reason {review.reason}; accept it, "
            "or send the labels back"
        )
    of_review = (each for each in consensus_of(connection, review.shape_id) if each.revision_id == review.revision_id)
    if not any(answer_id in each.answer_ids for each in of_review):
        raise NotFoundError(f"review {review_id} has no labels {answer_id} to choose; see /disagreements")
    chosen = answer(connection, answer_id)
    revision = NewRevision(
        chosen.shape_id,
        chosen.mesh_hash,
        RevisionKind.HUMAN,
        chosen.person_id,
        chosen.schema_version,
        answer_labels(connection, answer_id),
        review.revision_id,
    )
    committed, _, events = commit_revision(connection, revision, None, now)
    detail = {"answer_id": answer_id, "review_id": review_id}
    append_audit(connection, reviewer, "choose labels", f"shape {review.shape_id}", detail, now)
    append_events(connection, events, now)
    return committed
