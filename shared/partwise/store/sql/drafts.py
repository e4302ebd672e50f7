"""Drafts and their strokes: acknowledged means committed, and committed once."""

import json
from collections.abc import Sequence
from datetime import datetime
from typing import Any

from sqlalchemy import (
    JSON,
    ColumnElement,
    Connection,
    Integer,
    Row,
    Select,
    String,
    bindparam,
    cast,
    exists,
    func,
    insert,
    select,
    true,
    update,
)
from sqlalchemy.dialects.postgresql import ARRAY
from sqlalchemy.sql.dml import ReturningUpdate

from partwise.errors import ConflictError, LabelError, NotFoundError, ParameterError, StaleDraftError
from partwise.labels.annotation_cost import AnnotationCost
from partwise.labels.stroke_json import stroke_to_document
from partwise.labels.strokes import Stroke
from partwise.store import tables as t
from partwise.store.catalog import SHOWN_KINDS
from partwise.store.records import Draft, DraftOutcome, LeasePurpose, NewDraft, StoredStroke
from partwise.store.sql import leases
from partwise.store.sql.dialect import batches
from partwise.store.sql.draft_binding import bind_draft

_FOLLOWING = 1_000  # strokes; more at once are rare


def open_draft(connection: Connection, lease_id: int, person_id: int, new: NewDraft, now: datetime) -> Draft:
    leases.person_name(connection, person_id, for_update=True)
    lease = leases.own_active(connection, lease_id, person_id)
    resumed = bind_draft(connection, lease)
    if resumed is not None:
        return to_draft(resumed)
    _refuse_foreign_base(connection, lease.shape_id, new)
    values = {
        "slot": lease.slot,
        "round": lease.round,
        "purpose": lease.purpose.value,
        "collection_id": lease.collection_id,
        "shape_id": lease.shape_id,
        "person_id": person_id,
        "mesh_hash": new.mesh_hash,
        "base_revision": new.base_revision,
        "base_sha256": new.base_sha256,
        "seen_revision": _head_id(connection, lease.shape_id),
        "schema_version": new.schema_version,
        "n_strokes": 0,
        "created_at": now,
        "updated_at": now,
    }
    return to_draft(connection.execute(insert(t.draft).values(values).returning(t.draft)).one())


def _refuse_foreign_base(connection: Connection, shape_id: int, new: NewDraft) -> None:
    pair, revision = t.shape_mesh.c, t.label_revision.c
    known = select(pair.shape_id).where(pair.shape_id == shape_id, pair.mesh_hash == new.mesh_hash)
    if connection.execute(known).first() is None:
        raise LabelError(
            f"a draft must be on a mesh of its shape but shape {shape_id} has no mesh {new.mesh_hash[:12]}…; reload it"
        )
    if new.base_revision is None:
        return
    query = select(revision.shape_id, revision.mesh_hash, revision.sha256).where(revision.id == new.base_revision)
    # nobody starts from reference labels: whoever guessed their number would see them
    base = connection.execute(query.where(revision.kind.in_([kind.value for kind in SHOWN_KINDS]))).first()
    if base is None or tuple(base) != (shape_id, new.mesh_hash, new.base_sha256):
        raise LabelError(
            f"a draft must start from labels of its shape on its mesh but revision {new.base_revision} is not that; "
            "reload the shape"
        )


def draft(connection: Connection, draft_id: int) -> Draft:
    return _found(connection.execute(_DRAFT, {"of_draft": draft_id}).first(), draft_id)


def open_drafts(connection: Connection, person_id: int) -> list[Draft]:
    return [to_draft(row) for row in connection.execute(_OPEN_DRAFTS, {"of_person": person_id})]


def drafts_of_shape(connection: Connection, shape_id: int) -> list[Draft]:
    query = select(t.draft).where(t.draft.c.shape_id == shape_id).order_by(t.draft.c.id)
    return [to_draft(row) for row in connection.execute(query)]


def append_strokes(
    connection: Connection,
    draft_id: int,
    person_id: int,
    expected_sequence: int,
    strokes: Sequence[Stroke],
    now: datetime,
) -> Draft:
    """Of strokes that `follow_on` has left, appends those that are not on record, or says why they cannot be."""
    known = locked_draft(connection, draft_id, person_id)
    new = _unknown(connection, known, strokes)
    if new and known.outcome is not None:
        raise stale(connection, known, _closed(known))
    first = new[0].sequence if new else expected_sequence
    if (new and first != known.n_strokes) or first > known.n_strokes:
        raise stale(
            connection,
            known,
            f"the next stroke of draft {draft_id} must have sequence {known.n_strokes} but has {first}; the shape was "
            "edited elsewhere: fetch the strokes and redo this one on them",
        )
    if not new:
        return known
    for stroke in new:
        if stroke.base_revision != known.base_revision:
            raise stale(
                connection,
                known,
                f"strokes of draft {draft_id} must be based on revision {known.base_revision} but one is on "
                f"{stroke.base_revision}; open the draft again",
            )
    _insert_strokes(connection, draft_id, new, now)
    values = {"n_strokes": known.n_strokes + len(new), "updated_at": now}
    statement = update(t.draft).where(t.draft.c.id == draft_id).values(values).returning(t.draft)
    return to_draft(connection.execute(statement).one())


def follow_on(
    connection: Connection,
    draft_id: int,
    person_id: int,
    expected_sequence: int,
    strokes: Sequence[Stroke],
    now: datetime,
) -> Draft | None:
    """Appends strokes that are all new and just what comes next, as nearly all are.

    In PostgreSQL it is one statement, which needs no transaction around it; in SQLite two, which do. None, with
    nothing changed, for any other strokes: what is to be said of those takes a closer look.
    """
    _refuse_misnumbered(person_id, expected_sequence, strokes)
    bases = {stroke.base_revision for stroke in strokes}
    if len(bases) != 1 or len(strokes) > _FOLLOWING:
        return None
    ids = [str(stroke.id) for stroke in strokes]
    expected = {
        "of_draft": draft_id,
        "of_person": person_id,
        "on_record": expected_sequence,
        "on_base": bases.pop(),
        "ids": ids,
        "now_on_record": expected_sequence + len(strokes),
        "now": now,
    }
    if connection.dialect.name == "postgresql":
        sent = {
            "sequences": [stroke.sequence for stroke in strokes],
            "payloads": [json.dumps(stroke_to_document(stroke)) for stroke in strokes],
        }
        row = connection.execute(_FOLLOW_ON_AND_INSERT, expected | sent).first()
        return None if row is None else to_draft(row)
    row = connection.execute(_FOLLOW_ON, expected).first()
    if row is None:
        return None
    _insert_strokes(connection, draft_id, strokes, now)
    return to_draft(row)


def _insert_strokes(connection: Connection, draft_id: int, strokes: Sequence[Stroke], now: datetime) -> None:
    rows = [
        {
            "draft_id": draft_id,
            "sequence": stroke.sequence,
            "id": str(stroke.id),
            "payload": stroke_to_document(stroke),
            "recorded_at": now,
        }
        for stroke in strokes
    ]
    connection.execute(insert(t.stroke), rows)


def _refuse_misnumbered(person_id: int, expected_sequence: int, strokes: Sequence[Stroke]) -> None:
    for sequence, stroke in enumerate(strokes, start=expected_sequence):
        if stroke.sequence != sequence:
            raise ParameterError(f"strokes must be numbered on from {expected_sequence} but one is {stroke.sequence}")
        if stroke.author_id != person_id:
            raise ParameterError(f"strokes must be their author's own but one names person {stroke.author_id}")
    if len({stroke.id for stroke in strokes}) < len(strokes):
        raise ParameterError("each stroke must have an id of its own but one occurs twice; drop the second")


def _unknown(connection: Connection, known: Draft, strokes: Sequence[Stroke]) -> list[Stroke]:
    """Strokes that are not on record yet; `StaleDraftError` if another is on record under the id of one."""
    recorded = {}
    for some in batches([str(stroke.id) for stroke in strokes]):
        query = select(t.stroke.c.id, t.stroke.c.payload).where(t.stroke.c.draft_id == known.id)
        recorded.update({row.id: row.payload for row in connection.execute(query.where(t.stroke.c.id.in_(some)))})
    new = []
    for stroke in strokes:
        payload = recorded.get(str(stroke.id))
        if payload is None:
            new.append(stroke)
        elif payload != json.loads(json.dumps(stroke_to_document(stroke))):
            raise stale(
                connection,
                known,
                f"stroke {stroke.id} is on record with other content; give each stroke an id of its own",
            )
    return new


def strokes(connection: Connection, draft_id: int, after: int, limit: int) -> list[StoredStroke]:
    columns = (t.stroke.c.sequence, t.stroke.c.id, t.stroke.c.payload, t.stroke.c.recorded_at)
    query = select(*columns).where(t.stroke.c.draft_id == draft_id, t.stroke.c.sequence > after)
    return [
        StoredStroke(**row._mapping) for row in connection.execute(query.order_by(t.stroke.c.sequence).limit(limit))
    ]


def discard_draft(connection: Connection, draft_id: int, person_id: int, now: datetime) -> Draft:
    known = locked_draft(connection, draft_id, person_id)
    refuse_closed(known)
    return close_draft(connection, draft_id, DraftOutcome.DISCARDED, None, now)


def close_draft(
    connection: Connection,
    draft_id: int,
    outcome: DraftOutcome,
    labels_sha256: str | None,
    now: datetime,
    cost: AnnotationCost | None = None,
) -> Draft:
    values: dict[str, Any] = {
        "closed_at": now,
        "updated_at": now,
        "outcome": outcome.value,
        "labels_sha256": labels_sha256,
    }
    if cost is not None:
        values |= {"active_s": cost.active_s, "n_clicks": cost.clicks}
    statement = update(t.draft).where(t.draft.c.id == draft_id).values(values).returning(t.draft)
    return to_draft(connection.execute(statement).one())


def locked_draft(connection: Connection, draft_id: int, person_id: int) -> Draft:
    """A person's own draft, which nobody changes until this transaction ends."""
    query = select(t.draft).where(t.draft.c.id == draft_id).with_for_update()
    known = _found(connection.execute(query).first(), draft_id)
    if known.person_id != person_id:
        raise ConflictError(f"a draft is worked on by its author only but draft {draft_id} is another person's")
    return known


def refuse_closed(known: Draft) -> None:
    if known.outcome is not None:
        raise ConflictError(_closed(known))


def _closed(known: Draft) -> str:
    return f"a draft must be open for this but draft {known.id} is {known.outcome}; open another"


def stale(connection: Connection, known: Draft, message: str) -> StaleDraftError:
    """The error that says what is on record now."""
    state = {
        "draft_id": known.id,
        "n_strokes": known.n_strokes,
        "base_revision": known.base_revision,
        "seen_revision": known.seen_revision,
        "head_revision": _head_id(connection, known.shape_id),
        "mesh_hash": known.mesh_hash,
        "outcome": known.outcome,
    }
    return StaleDraftError(message, state)


def _head_id(connection: Connection, shape_id: int) -> int | None:
    revision = t.label_revision.c
    query = select(revision.id).where(
        revision.shape_id == shape_id, revision.kind.in_([kind.value for kind in SHOWN_KINDS])
    )
    return connection.execute(query.order_by(revision.id.desc()).limit(1)).scalar()


def refuse_unseen_head(connection: Connection, known: Draft) -> None:
    """Nobody's labels disappear behind those of someone who never saw them."""
    head = _head_id(connection, known.shape_id)
    if head not in (known.seen_revision, known.base_revision):
        raise stale(
            connection,
            known,
            f"who confirms must know the newest labels of shape {known.shape_id}, revision {head}, but draft "
            f"{known.id} was begun before them; both are kept: look at them, then confirm over them or discard it",
        )


def acknowledge_head(connection: Connection, draft_id: int, person_id: int, revision_id: int, now: datetime) -> Draft:
    known = locked_draft(connection, draft_id, person_id)
    refuse_closed(known)
    if (head := _head_id(connection, known.shape_id)) != revision_id:
        raise stale(connection, known, f"the newest labels are revision {head} but {revision_id} was seen; look again")
    values = {"seen_revision": revision_id, "updated_at": now}
    statement = update(t.draft).where(t.draft.c.id == draft_id).values(values).returning(t.draft)
    return to_draft(connection.execute(statement).one())


def _found(row: Row[Any] | None, draft_id: int) -> Draft:
    if row is None:
        raise NotFoundError(f"there is no draft {draft_id}; was it another workspace's?")
    return to_draft(row)


def to_draft(row: Row[Any]) -> Draft:
    outcome = None if row.outcome is None else DraftOutcome(row.outcome)
    return Draft(**{**row._mapping, "purpose": LeasePurpose(row.purpose), "outcome": outcome})


def _following(is_among_ids: ColumnElement[bool]) -> ReturningUpdate[Any]:
    """Counts strokes that are new and just what comes next into their draft; returns nothing if they are not that.

    is_among_ids : whether a stroke's id is one of theirs.
    """
    draft = t.draft.c
    is_any_known = exists().where(t.stroke.c.draft_id == bindparam("of_draft"), is_among_ids)
    return (
        update(t.draft)
        .where(draft.id == bindparam("of_draft"), draft.person_id == bindparam("of_person"))
        .where(draft.closed_at.is_(None), draft.n_strokes == bindparam("on_record"))
        .where(draft.base_revision.is_not_distinct_from(bindparam("on_base", type_=draft.base_revision.type)))
        .where(~is_any_known)
        .values(n_strokes=bindparam("now_on_record"), updated_at=bindparam("now"))
        .returning(t.draft)
    )


def _following_with_strokes() -> Select[Any]:
    """As `_following`, and adds the strokes: PostgreSQL does both in one statement."""
    followed = _following(t.stroke.c.id == func.any(bindparam("ids", type_=ARRAY(String)))).cte("followed")
    sent = (
        func.unnest(
            bindparam("sequences", type_=ARRAY(Integer)),
            bindparam("ids", type_=ARRAY(String)),
            bindparam("payloads", type_=ARRAY(String)),
        )
        .table_valued("sequence", "id", "payload", name="sent")
        .render_derived()
    )
    payload, now = cast(sent.c.payload, JSON), bindparam("now", type_=t.stroke.c.recorded_at.type)
    rows = select(followed.c.id, sent.c.sequence, sent.c.id, payload, now).join_from(followed, sent, true())
    columns = ("draft_id", "sequence", "id", "payload", "recorded_at")
    return select(followed).add_cte(insert(t.stroke).from_select(columns, rows).cte("added"))


# Built once, as people at work ask them all the time and building one costs as much as asking it.
_FOLLOW_ON = _following(t.stroke.c.id.in_(bindparam("ids", expanding=True)))
_FOLLOW_ON_AND_INSERT = _following_with_strokes()
_DRAFT = select(t.draft).where(t.draft.c.id == bindparam("of_draft"))
_OPEN_DRAFTS = (
    select(t.draft)
    .where(t.draft.c.person_id == bindparam("of_person"), t.draft.c.closed_at.is_(None))
    .order_by(t.draft.c.id)
)
