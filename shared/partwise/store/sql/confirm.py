"""Confirming: labels, the ends of draft and lease, review, audit, training job and events, all or nothing."""

from dataclasses import replace
from datetime import datetime

import numpy as np
from jaxtyping import Integer
from sqlalchemy import Connection, and_, select, update

from partwise.errors import ConflictError, LabelError
from partwise.labels.encoding import labels_sha256
from partwise.store import tables as t
from partwise.store.catalog import SHOWN_KINDS
from partwise.store.records import (
    Answer,
    Confirmation,
    Draft,
    DraftOutcome,
    EventKind,
    Lease,
    LeaseOutcome,
    LeasePurpose,
    NewConfirmation,
    NewEvent,
    NewRevision,
    RevisionKind,
)
from partwise.store.reviews import NewReview, ReviewReason
from partwise.store.sql import answers, leases
from partwise.store.sql.collections import append_audit
from partwise.store.sql.drafts import close_draft, locked_draft, refuse_closed, refuse_unseen_head, stale
from partwise.store.sql.events import append_events
from partwise.store.sql.labels import commit_revision, head_revisions, labelled_event
from partwise.store.sql.places import collection_queue_settings
from partwise.store.sql.shapes import lock_labels

_LEASE_S = 60.0  # of a lease that is taken up again to be completed at once


def confirm_draft(connection: Connection, new: NewConfirmation, now: datetime) -> Confirmation:
    name = leases.person_name(connection, new.person_id, for_update=True)  # before the draft, as in claims
    draft = locked_draft(connection, new.draft_id, new.person_id)
    sha256 = _checked_sha256(new.labels)
    if draft.outcome is DraftOutcome.CONFIRMED and draft.labels_sha256 == sha256:
        return _known(connection, draft)
    refuse_closed(draft)
    if draft.n_strokes != new.n_strokes:
        message = (
            f"all strokes are confirmed but draft {draft.id} has {draft.n_strokes}, not {new.n_strokes}; fold them"
        )
        raise stale(connection, draft, message)
    lock_labels(connection, [draft.shape_id])
    draft, lease, expired = _with_lease(connection, replace(draft, schema_version=new.schema_version), now)
    confirmation, events = _commit(connection, draft, new, sha256, now)
    if lease is not None:
        events.append(leases.end(connection, lease, LeaseOutcome.COMPLETED, now)[1])
    close_draft(connection, draft.id, DraftOutcome.CONFIRMED, sha256, now, new.cost)
    detail = {
        "shape_id": draft.shape_id,
        "n_strokes": draft.n_strokes,
        "sha256": sha256,
        "purpose": draft.purpose.value,
    }
    append_audit(connection, name, "confirm", f"draft {draft.id}", detail, now)
    done = NewEvent(EventKind.PEOPLE, draft.collection_id, {"person_id": draft.person_id, "what": "confirmed"})
    append_events(connection, [*expired, *events, done], now)
    return confirmation


def _checked_sha256(labels: Integer[np.ndarray, " m"]) -> str:
    if labels.ndim != 1 or not np.issubdtype(labels.dtype, np.integer):
        raise LabelError(f"labels must be one whole number per face but have shape {labels.shape} of {labels.dtype}")
    return labels_sha256(labels.astype(np.uint16))


def _known(connection: Connection, draft: Draft) -> Confirmation:
    """What became of a draft that was confirmed before: for a client that did not get the answer."""
    answer_id = connection.execute(select(t.answer.c.id).where(t.answer.c.draft_id == draft.id)).scalar()
    revision_id = None
    if answer_id is None and draft.purpose is LeasePurpose.LABEL:
        revision = t.label_revision.c
        query = select(revision.id).where(
            revision.shape_id == draft.shape_id,
            revision.kind == RevisionKind.HUMAN.value,
            revision.author_id == draft.person_id,
            revision.sha256 == draft.labels_sha256,
        )
        revision_id = connection.execute(query.order_by(revision.id.desc()).limit(1)).scalar()
    return Confirmation(draft.id, draft.shape_id, draft.labels_sha256 or "", revision_id, answer_id, None)


def _with_lease(connection: Connection, draft: Draft, now: datetime) -> tuple[Draft, Lease | None, list[NewEvent]]:
    """The draft under the lease that its author holds, or takes up again if the place is free; events of what ended.

    Whoever is checked blindly needs none: nobody else's work depends on it.
    """
    for lease in leases.active_of_shape(connection, draft.shape_id):
        if lease.person_id == draft.person_id:
            own = leases.own_active(connection, lease.id, draft.person_id)
            return replace(draft, slot=own.slot, round=own.round, purpose=own.purpose), own, []
    if draft.purpose is LeasePurpose.BLIND:
        return draft, None, []
    # who let theirs expire has no more right to the place than who comes with labels
    still_held, events = leases.end_expired(connection, draft.shape_id, now)
    if still_held and draft.purpose is LeasePurpose.LABEL:
        raise _taken(draft)
    return draft, _taken_up(connection, draft, now), events


def _taken_up(connection: Connection, draft: Draft, now: datetime) -> Lease:
    place = t.queue_rank
    is_it = and_(place.c.shape_id == draft.shape_id, place.c.slot == draft.slot, place.c.round == draft.round)
    found = connection.execute(select(place).where(is_it).with_for_update()).first()
    if (found is None and draft.purpose is LeasePurpose.INDEPENDENT) or (found is not None and found.lease_id):
        raise _taken(draft)
    values = {
        "collection_id": draft.collection_id,
        "shape_id": draft.shape_id,
        "slot": draft.slot,
        "round": draft.round,
        "person_id": draft.person_id,
        "purpose": draft.purpose,
    }
    lease = leases.acquire(connection, values, _LEASE_S, now)
    if lease is None:
        raise _taken(draft)
    connection.execute(update(place).where(is_it).values(lease_id=lease.id))
    return lease


def _taken(draft: Draft) -> ConflictError:
    return ConflictError(
        "labels of a lease that has ended count if nobody else has the shape but someone else has this one now; draft "
        f"{draft.id} is kept: claim the shape when it is free"
    )


def _commit(
    connection: Connection, draft: Draft, new: NewConfirmation, sha256: str, now: datetime
) -> tuple[Confirmation, list[NewEvent]]:
    if draft.purpose is LeasePurpose.BLIND:
        answer = answers.add_answer(connection, draft, new.labels, now)
        if new.blind_check is not None:
            answers.add_blind_check(connection, draft, answer.id, new.blind_check, now)
        return Confirmation(draft.id, draft.shape_id, sha256, None, answer.id, None), [_labelled(draft)]
    refuse_unseen_head(connection, draft)
    if draft.purpose is LeasePurpose.INDEPENDENT:
        return _commit_answer(connection, draft, new, sha256, now)
    needs_check = collection_queue_settings(connection, draft.collection_id).review
    review = NewReview(ReviewReason.CHECK, {"draft_id": draft.id}) if needs_check else None
    revision_id, review_id, events = _commit_revision(connection, draft, draft.person_id, new.labels, review, now)
    return Confirmation(draft.id, draft.shape_id, sha256, revision_id, None, review_id), events


def _labelled(draft: Draft) -> NewEvent:
    return labelled_event(draft.collection_id, draft.shape_id)


def _commit_revision(
    connection: Connection,
    draft: Draft,
    author_id: int,
    labels: Integer[np.ndarray, " m"],
    review: NewReview | None,
    now: datetime,
    schema_version: int | None = None,
) -> tuple[int, int | None, list[NewEvent]]:
    head = head_revisions(connection, [draft.shape_id], SHOWN_KINDS).get(draft.shape_id)
    revision = NewRevision(
        draft.shape_id,
        draft.mesh_hash,
        RevisionKind.HUMAN,
        author_id,
        schema_version or draft.schema_version,
        labels,
        None if head is None else head.id,
    )
    committed, added, events = commit_revision(connection, revision, review, now)
    return committed.id, None if added is None else added.id, events


def _commit_answer(
    connection: Connection, draft: Draft, new: NewConfirmation, sha256: str, now: datetime
) -> tuple[Confirmation, list[NewEvent]]:
    peers = answers.answers_of_round(connection, draft.shape_id, draft.round)
    is_last = answers.n_awaited(connection, draft) == 0
    compared = None if new.consensus is None else set(new.consensus.peers)
    if compared != ({peer.id for peer in peers} if is_last else None):
        message = (
            f"the last of a round's labels are compared with all others but draft {draft.id} was compared with "
            f"{sorted(compared or ())} and there are {[peer.id for peer in peers]}; compare again"
        )
        raise stale(connection, draft, message)
    own = answers.add_answer(connection, draft, new.labels, now)
    if new.consensus is None:
        return Confirmation(draft.id, draft.shape_id, sha256, None, own.id, None), [_labelled(draft)]
    return _settle(connection, draft, new, [*peers, own], now)


def _settle(
    connection: Connection, draft: Draft, new: NewConfirmation, given: list[Answer], now: datetime
) -> tuple[Confirmation, list[NewEvent]]:
    """The labels closest to the others become the shape's, in a review if all are too different."""
    own, consensus = given[-1], new.consensus
    if consensus is None:
        raise ConflictError("a round is settled by a consensus but none was given; compare the labels first")
    medoid = own if consensus.medoid is None else next((each for each in given if each.id == consensus.medoid), None)
    if medoid is None:
        raise ConflictError(f"the medoid must be one of the round's answers but is {consensus.medoid}; compare again")
    settings = collection_queue_settings(connection, draft.collection_id)
    is_agreed = consensus.closeness.area_agreement >= settings.agreement
    detail = {"area_agreement": consensus.closeness.area_agreement, "answer_ids": [each.id for each in given]}
    review = NewReview(ReviewReason.CHECK, detail) if settings.review else None
    if not is_agreed:
        review = NewReview(ReviewReason.DISAGREEMENT, detail)
    of_medoid = replace(draft, mesh_hash=medoid.mesh_hash)
    labels = answers.answer_labels(connection, medoid.id)
    revision_id, review_id, events = _commit_revision(
        connection, of_medoid, medoid.person_id, labels, review, now, medoid.schema_version
    )
    answers.add_consensus(
        connection,
        draft,
        consensus,
        [each.id for each in given],
        medoid.id,
        revision_id,
        is_agreed=is_agreed,
        now=now,
    )
    confirmation = Confirmation(
        draft.id, draft.shape_id, labels_sha256(new.labels.astype(np.uint16)), revision_id, own.id, review_id
    )
    return confirmation, events
