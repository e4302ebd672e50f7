"""Label revisions: checked, compressed, committed, and never changed."""

from collections.abc import Collection as SizedIterable
from collections.abc import Sequence
from dataclasses import asdict
from datetime import datetime
from typing import Any

import numpy as np
from jaxtyping import UInt16
from sqlalchemy import Connection, Row, Select, exists, func, insert, select

from partwise.errors import ConflictError, LabelError, NotFoundError
from partwise.labels.checks import checked_labels
from partwise.labels.encoding import EncodedLabels, decode_labels, encode_labels
from partwise.store import tables as t
from partwise.store.catalog import SHOWN_KINDS
from partwise.store.records import EventKind, LabelRevision, NewEvent, NewRevision, RevisionKind, ShapeState
from partwise.store.reviews import NewReview, Review, ReviewReason, RevisionOrigin
from partwise.store.sql.collections import append_audit, parts, schema_version
from partwise.store.sql.dialect import batches
from partwise.store.sql.events import append_events
from partwise.store.sql.facets import note_reference, renew_facets, renew_head_parts
from partwise.store.sql.places import close_places
from partwise.store.sql.reviews import MACHINE, add_review, succeed_reviews
from partwise.store.sql.shapes import lock_labels, refuse_unknown_shapes
from partwise.store.sql.tally import count_confirmed
from partwise.unlabelled import NO_PART_ID

_COLUMNS = tuple(column for column in t.label_revision.c if column.name != "labels")  # the blob only when asked for


def add_revision(
    connection: Connection, revision: NewRevision, new_review: NewReview | None, now: datetime
) -> LabelRevision:
    committed, _, events = commit_revision(connection, revision, new_review, now)
    append_events(connection, events, now)
    return committed


def commit_revision(
    connection: Connection, revision: NewRevision, new_review: NewReview | None, now: datetime
) -> tuple[LabelRevision, Review | None, list[NewEvent]]:
    """As `add_revision`; the events are the caller's to add, last."""
    shape = refuse_unknown_shapes(connection, [revision.shape_id])[revision.shape_id]
    author = connection.execute(select(t.person.c.name).where(t.person.c.id == revision.author_id)).scalar()
    if author is None:
        raise NotFoundError(f"there is no person with id {revision.author_id}; add the author first")
    lock_labels(connection, [revision.shape_id])
    # no parts change while labels with them come in
    version = schema_version(connection, shape.collection_id, for_share=True)
    schema = parts(connection, shape.collection_id, revision.schema_version)
    checked = checked_labels(revision.labels, _n_faces(connection, revision), schema)
    if revision.kind in SHOWN_KINDS:
        checked_labels(checked, checked.size, parts(connection, shape.collection_id, version))  # no part that is gone
    encoded = encode_labels(checked)
    _refuse_foreign_parent(connection, revision)
    if revision.origin is not None:
        _refuse_outdated_parent(connection, revision)
    values = {
        "shape_id": revision.shape_id,
        "mesh_hash": revision.mesh_hash,
        "kind": RevisionKind(revision.kind).value,
        "parent_id": revision.parent_id,
        "author_id": revision.author_id,
        "schema_version": revision.schema_version,
        "n_faces": encoded.n_faces,
        "sha256": encoded.sha256,
        "created_at": now,
    }
    origin = None if revision.origin is None else asdict(revision.origin)
    statement = insert(t.label_revision).values(**values, origin=origin, labels=encoded.blob)
    revision_id = connection.execute(statement.returning(t.label_revision.c.id)).scalar_one()
    part_ids = _note_parts(connection, shape.collection_id, revision_id, checked)
    committed = LabelRevision(**{**values, "id": revision_id, "kind": revision.kind, "origin": revision.origin})
    if revision.kind in SHOWN_KINDS:
        succeed_reviews(connection, committed, now)
    wanted = [] if new_review is None else [new_review]
    if revision.kind in SHOWN_KINDS and revision.origin is None and revision.schema_version < version:
        wanted.append(NewReview(ReviewReason.SCHEMA, {"version": version}))  # moved labels take theirs along
    added = [add_review(connection, revision_id, each, now) for each in wanted]
    detail = {"kind": values["kind"], "shape_id": revision.shape_id, "sha256": encoded.sha256}
    actor, action = (author, "label") if origin is None else (MACHINE, "move labels")
    append_audit(connection, actor, action, f"label_revision {revision_id}", detail | (origin or {}), now)
    return (
        committed,
        added[0] if added else None,
        _after_commit(connection, committed, shape.collection_id, part_ids, now),
    )


def _after_commit(
    connection: Connection, committed: LabelRevision, collection_id: int, part_ids: Sequence[int], now: datetime
) -> list[NewEvent]:
    """Brings the table of shapes, the queue and the next training up to date with a revision."""
    if committed.kind is RevisionKind.REFERENCE:
        note_reference(connection, collection_id, committed.shape_id, committed.id)
        return []
    renew_head_parts(connection, collection_id, committed.shape_id, part_ids)
    renew_facets(connection, [committed.shape_id])
    state = connection.execute(
        select(t.shape_facet.c.state).where(t.shape_facet.c.shape_id == committed.shape_id)
    ).scalar_one()
    events = []
    if committed.origin is None:  # labels that merely moved change nothing about what is wanted of people
        close_places(connection, committed.shape_id)
        if committed.kind is RevisionKind.HUMAN and state == ShapeState.CONFIRMED:
            events = count_confirmed(connection, collection_id, now)
    return [*events, labelled_event(collection_id, committed.shape_id)]


def labelled_event(collection_id: int, shape_id: int) -> NewEvent:
    """Says that somebody handed in labels of a shape: the same whatever became of them."""
    return NewEvent(EventKind.SHAPE, collection_id, {"shape_id": shape_id, "what": "labelled"})


def _note_parts(
    connection: Connection, collection_id: int, revision_id: int, labels: UInt16[np.ndarray, " m"]
) -> list[int]:
    part_ids = [part_id for part_id in np.unique(labels).tolist() if part_id != NO_PART_ID]
    rows = [{"collection_id": collection_id, "part_id": part_id, "revision_id": revision_id} for part_id in part_ids]
    if rows:
        connection.execute(insert(t.label_part), rows)
    return part_ids


def _n_faces(connection: Connection, revision: NewRevision) -> int:
    query = (
        select(t.mesh.c.n_faces)
        .join_from(t.mesh, t.shape_mesh)
        .where(t.shape_mesh.c.shape_id == revision.shape_id, t.shape_mesh.c.mesh_hash == revision.mesh_hash)
    )
    n_faces = connection.execute(query).scalar()
    if n_faces is None:
        raise LabelError(
            f"labels must belong to a mesh of their shape but shape {revision.shape_id} has no mesh "
            f"{revision.mesh_hash[:12]}…; were they made on another mesh?"
        )
    return n_faces


def _refuse_foreign_parent(connection: Connection, revision: NewRevision) -> None:
    if revision.parent_id is None:
        return
    query = select(t.label_revision.c.shape_id).where(t.label_revision.c.id == revision.parent_id)
    owner = connection.execute(query).scalar()
    if owner != revision.shape_id:
        belongs = "does not exist" if owner is None else f"belongs to shape {owner}"
        raise LabelError(
            f"a parent must be a revision of the same shape but revision {revision.parent_id} {belongs} "
            f"and the labels are for shape {revision.shape_id}"
        )


def _refuse_outdated_parent(connection: Connection, revision: NewRevision) -> None:
    """Moved labels follow the newest of their kinds only: they must never hide what somebody has just confirmed."""
    kinds = SHOWN_KINDS if revision.kind in SHOWN_KINDS else (revision.kind,)
    head = head_revisions(connection, [revision.shape_id], kinds).get(revision.shape_id)
    if head is None or head.id != revision.parent_id or head.kind is not revision.kind:
        newest = "none" if head is None else f"revision {head.id}, {head.kind}"
        raise ConflictError(
            f"moved labels must follow the newest of shape {revision.shape_id} ({newest}) but are {revision.kind} and "
            f"follow revision {revision.parent_id}; move the newest instead"
        )


def _record(row: Row[Any]) -> LabelRevision:
    origin = None if row.origin is None else RevisionOrigin(**row.origin)
    return LabelRevision(**{**row._mapping, "kind": RevisionKind(row.kind), "origin": origin})


def revision(connection: Connection, revision_id: int) -> LabelRevision:
    row = connection.execute(select(*_COLUMNS).where(t.label_revision.c.id == revision_id)).first()
    if row is None:
        raise NotFoundError(f"there is no label revision {revision_id}")
    return _record(row)


def revisions(connection: Connection, shape_id: int) -> Sequence[LabelRevision]:
    query = select(*_COLUMNS).where(t.label_revision.c.shape_id == shape_id).order_by(t.label_revision.c.id)
    return [_record(row) for row in connection.execute(query)]


def labels(connection: Connection, revision_id: int) -> UInt16[np.ndarray, " m"]:
    columns = (t.label_revision.c.labels, t.label_revision.c.n_faces, t.label_revision.c.sha256)
    row = connection.execute(select(*columns).where(t.label_revision.c.id == revision_id)).first()
    if row is None:
        raise NotFoundError(f"there is no label revision {revision_id}")
    return decode_labels(EncodedLabels(bytes(row.labels), row.n_faces, row.sha256))


def _heads(kinds: Sequence[RevisionKind]) -> Select[Any]:
    """Per shape the id of its newest revision of these kinds: ids grow with time."""
    return (
        select(func.max(t.label_revision.c.id))
        .where(t.label_revision.c.kind.in_([RevisionKind(kind).value for kind in kinds]))
        .group_by(t.label_revision.c.shape_id)
    )


def head_revisions(
    connection: Connection, shape_ids: SizedIterable[int], kinds: Sequence[RevisionKind]
) -> dict[int, LabelRevision]:
    found = {}
    for some in batches(shape_ids):
        heads = _heads(kinds).where(t.label_revision.c.shape_id.in_(some)).scalar_subquery()
        for row in connection.execute(select(*_COLUMNS).where(t.label_revision.c.id.in_(heads))):
            found[row.shape_id] = _record(row)
    return found


def labelled_shapes(
    connection: Connection,
    collection_id: int,
    kinds: Sequence[RevisionKind],
    after: int,
    limit: int,
    *,
    leave_out_reviews: bool,
) -> Sequence[LabelRevision]:
    heads = (  # grouped and ordered as shapes are indexed, so that a page costs a page, however many are labelled
        select(func.max(t.label_revision.c.id))
        .join_from(t.shape, t.label_revision, t.shape.c.id == t.label_revision.c.shape_id)
        .where(t.label_revision.c.kind.in_([RevisionKind(kind).value for kind in kinds]))
        .where(t.shape.c.collection_id == collection_id, t.shape.c.id > after)
        .group_by(t.shape.c.id)
        .order_by(t.shape.c.id)
        .limit(limit)
    )
    if leave_out_reviews:  # reviews are of newest labels, so an open one says enough about the shape
        is_in_review = exists().where(t.review.c.shape_id == t.shape.c.id, t.review.c.resolved_at.is_(None))
        heads = heads.where(~is_in_review)
    query = (
        select(*_COLUMNS)
        .where(t.label_revision.c.id.in_(heads.scalar_subquery()))
        .order_by(t.label_revision.c.shape_id)
    )
    return [_record(row) for row in connection.execute(query)]
