"""Changes of a collection's parts, and what another version of them means for labels of the versions before."""

from datetime import datetime

from sqlalchemy import JSON, Connection, exists, func, insert, literal, select, union, update

from partwise.errors import ConflictError, LabelError
from partwise.labels.encoding import EncodedLabels, decode_labels
from partwise.labels.palette import default_colour
from partwise.labels.schema import MAX_PART_ID, Part, PartSchema
from partwise.store import tables as t
from partwise.store.catalog import SHOWN_KINDS
from partwise.store.records import EventKind, LeasePurpose, NewEvent, ShapeState
from partwise.store.reviews import ReviewReason
from partwise.store.sql.collections import part_row, parts, schema_version
from partwise.store.sql.dialect import batches, insert_for
from partwise.store.sql.events import append_events
from partwise.store.sql.facets import renew_facets
from partwise.store.tables.base import UtcDateTime

_DECODED_AT_ONCE = 200  # labels of some ten thousand faces each
_RENEWED_AT_ONCE = 5_000


def add_part(
    connection: Connection,
    collection_id: int,
    name: str,
    colour: str | None,
    gloss: str,
    parent_id: int | None,
    now: datetime,
) -> PartSchema:
    version = schema_version(connection, collection_id, for_update=True) + 1
    _refuse_taken_name(connection, collection_id, name, None)
    last = connection.execute(select(func.max(t.part.c.id)).where(t.part.c.collection_id == collection_id)).scalar()
    part_id = (last or 0) + 1
    if part_id > MAX_PART_ID:
        raise LabelError(f"a collection can have {MAX_PART_ID} parts in its life and has had them; start another")
    part = Part(part_id, name, colour or default_colour(part_id), gloss, parent_id)
    PartSchema(version, (*parts(connection, collection_id).parts, part))  # refuses an unknown parent
    connection.execute(insert(t.part).values(part_row(collection_id, part, version)))
    _set_version(connection, collection_id, version, now)
    return parts(connection, collection_id)


def update_part(
    connection: Connection,
    collection_id: int,
    part_id: int,
    name: str | None,
    colour: str | None,
    gloss: str | None,
    parent_id: int | None,
) -> PartSchema:
    schema_version(connection, collection_id, for_update=True)
    schema = parts(connection, collection_id)
    old = schema.part(part_id)
    new = Part(
        part_id,
        old.name if name is None else name,
        old.colour if colour is None else colour,
        old.gloss if gloss is None else gloss,
        old.parent_id if parent_id is None else parent_id or None,
    )
    _refuse_taken_name(connection, collection_id, new.name, part_id)
    PartSchema(schema.version, tuple(new if part.id == part_id else part for part in schema.parts))  # refuses a cycle
    connection.execute(
        update(t.part)
        .where(t.part.c.collection_id == collection_id, t.part.c.id == part_id)
        .values(name=new.name, colour=new.colour, gloss=new.gloss, parent_id=new.parent_id)
    )
    return parts(connection, collection_id)


def remove_part(connection: Connection, collection_id: int, part_id: int, now: datetime) -> PartSchema:
    version = schema_version(connection, collection_id, for_update=True) + 1
    schema = parts(connection, collection_id)
    part = schema.part(part_id)  # refuses an unknown or already removed part
    if children := [child.name for child in schema.parts if child.parent_id == part_id]:
        raise ConflictError(
            f"part {part.name!r} has the parts {', '.join(children)} below it; give them another parent first"
        )
    if n_shapes := _n_shapes_using(connection, collection_id, part_id):
        raise ConflictError(
            f"a part in use is not removed but {part.name!r} is in the labels of {n_shapes:,} "
            f"{'shape' if n_shapes == 1 else 'shapes'}; label those faces otherwise first"
        )
    if n_shapes := _n_shapes_compared_with(connection, collection_id, part_id):
        raise ConflictError(
            f"a part in use is not removed but {part.name!r} is in independent labels of {n_shapes:,} "
            f"{'shape that is' if n_shapes == 1 else 'shapes that are'} still being compared; wait for the others' "
            "labels, and decide on which people disagree"
        )
    connection.execute(
        update(t.part)
        .where(t.part.c.collection_id == collection_id, t.part.c.id == part_id)
        .values(schema_version_removed=version)
    )
    _set_version(connection, collection_id, version, now)
    return parts(connection, collection_id)


def _n_shapes_using(connection: Connection, collection_id: int, part_id: int) -> int:
    """Shapes whose newest human or imported labels have the part: read from the revisions that ever had it."""
    newer = t.label_revision.alias("newer")
    kinds = [kind.value for kind in SHOWN_KINDS]
    is_outdated = exists().where(
        newer.c.shape_id == t.label_revision.c.shape_id,
        newer.c.kind.in_(kinds),
        newer.c.id > t.label_revision.c.id,
    )
    query = (
        select(func.count())
        .select_from(t.label_part)
        .join(t.label_revision, t.label_revision.c.id == t.label_part.c.revision_id)
        .where(t.label_part.c.collection_id == collection_id, t.label_part.c.part_id == part_id)
        .where(t.label_revision.c.kind.in_(kinds), ~is_outdated)
    )
    return connection.execute(query).scalar_one()


def _n_shapes_compared_with(connection: Connection, collection_id: int, part_id: int) -> int:
    """Shapes that the part may still come to: of which somebody's independent labels have it in a round that goes on,
    or that a reviewer has yet to decide about.
    """
    answer, place, review, consensus = t.answer.c, t.queue_rank.c, t.review.c, t.consensus.c
    is_of_round = (answer.shape_id == place.shape_id) & (answer.round == place.round)
    of_rounds = select(answer.id).join_from(t.queue_rank, t.answer, is_of_round)
    of_rounds = of_rounds.where(place.collection_id == collection_id)
    is_of_consensus = (answer.shape_id == consensus.shape_id) & (answer.round == consensus.round)
    is_disputed = (consensus.shape_id == review.shape_id) & (consensus.revision_id == review.revision_id)
    of_disputes = (
        select(answer.id)
        .join_from(t.review, t.consensus, is_disputed)
        .join(t.answer, is_of_consensus)
        .where(review.collection_id == collection_id, review.resolved_at.is_(None))
        .where(review.reason == ReviewReason.DISAGREEMENT.value)
    )
    ids = connection.execute(union(of_rounds, of_disputes)).scalars().all()
    using = set()
    for some in batches(ids, _DECODED_AT_ONCE):
        query = select(answer.shape_id, answer.labels, answer.n_faces, answer.sha256).where(answer.id.in_(some))
        for row in connection.execute(query.where(answer.purpose == LeasePurpose.INDEPENDENT.value)):
            if (decode_labels(EncodedLabels(bytes(row.labels), row.n_faces, row.sha256)) == part_id).any():
                using.add(row.shape_id)
    return len(using)


def _refuse_taken_name(connection: Connection, collection_id: int, name: str, part_id: int | None) -> None:
    for part in parts(connection, collection_id).parts:
        if part.name == name and part.id != part_id:
            raise ConflictError(f"each part must have its own name but {name!r} is part {part.id}; choose another")


def _set_version(connection: Connection, collection_id: int, version: int, now: datetime) -> None:
    connection.execute(update(t.collection).where(t.collection.c.id == collection_id).values(schema_version=version))
    _open_reviews(connection, collection_id, version, now)
    renew_states(connection, collection_id)
    event = NewEvent(EventKind.SHAPE, collection_id, {"what": "parts changed", "schema_version": version})
    append_events(connection, [event], now)


def renew_states(connection: Connection, collection_id: int) -> bool:
    """The table of shapes follows the reviews, some thousand shapes at a time; whether there may be more.

    Shapes turn to confirmed only while no parts change, so none is overlooked.
    """
    facet, review = t.shape_facet.c, t.review.c
    is_in_review = exists().where(review.shape_id == facet.shape_id, review.resolved_at.is_(None))
    query = (
        select(facet.shape_id)
        .where(facet.collection_id == collection_id, facet.state == ShapeState.CONFIRMED.value, is_in_review)
        .order_by(facet.shape_id)
        .limit(_RENEWED_AT_ONCE)
    )
    shape_ids = connection.execute(query).scalars().all()
    renew_facets(connection, shape_ids)
    return len(shape_ids) == _RENEWED_AT_ONCE


def _open_reviews(connection: Connection, collection_id: int, version: int, now: datetime) -> None:
    """Has somebody look at the labels of all shapes that have some, as they were made under other parts.

    Whoever commits labels of an older version meanwhile waits, and then opens a review of them: see `commit_revision`.
    """
    revision, review = t.label_revision.c, t.review.c
    heads = (
        select(func.max(revision.id))
        .join_from(t.shape, t.label_revision, t.shape.c.id == revision.shape_id)
        .where(t.shape.c.collection_id == collection_id, revision.kind.in_([kind.value for kind in SHOWN_KINDS]))
        .group_by(t.shape.c.id)
    )
    new = {
        review.collection_id: literal(collection_id),
        review.shape_id: revision.shape_id,
        review.revision_id: revision.id,
        review.reason: literal(ReviewReason.SCHEMA.value),
        review.detail: literal({"version": version}, JSON),
        review.created_at: literal(now, UtcDateTime),
    }
    rows = select(*new.values()).where(revision.id.in_(heads.scalar_subquery()))
    statement = insert_for(connection, t.review).from_select([column.name for column in new], rows)
    of_newer = statement.on_conflict_do_update(
        index_elements=[review.shape_id, review.reason],
        index_where=review.resolved_at.is_(None),
        set_={"detail": statement.excluded.detail},
    )
    connection.execute(of_newer)
