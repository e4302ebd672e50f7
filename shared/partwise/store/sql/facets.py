"""What the table of shapes is filtered by, renewed in the transaction of whatever changes it."""

from collections.abc import Collection as SizedIterable
from collections.abc import Sequence

from sqlalchemy import Connection, delete, insert, literal, or_, select, update

from partwise.store import tables as t
from partwise.store.catalog import SHOWN_KINDS
from partwise.store.records import ShapeState
from partwise.store.sql.dialect import batches, insert_for
from partwise.store.sql.state import is_failed_run, shape_state
from partwise.store.tables.listing import FACETS


def add_facets(connection: Connection, collection_id: int, shape_ids: SizedIterable[int]) -> None:
    """For shapes that are new."""
    shape = t.shape.c
    columns = ("shape_id", "collection_id", "source_key", "state")
    for some in batches(shape_ids):
        new = select(shape.id, shape.collection_id, shape.source_key, literal(ShapeState.NEW.value))
        rows = new.where(shape.collection_id == collection_id, shape.id.in_(some))
        statement = insert_for(connection, t.shape_facet).from_select(columns, rows)
        connection.execute(statement.on_conflict_do_nothing())


def renew_facets(connection: Connection, shape_ids: SizedIterable[int]) -> None:
    """State, author and failure of shapes as their rows say now."""
    facet, revision, run = t.shape_facet, t.label_revision, t.stage_run
    state = select(shape_state()).where(t.shape.c.id == facet.c.shape_id).correlate(facet)
    author = (
        select(revision.c.author_id)
        .where(revision.c.shape_id == facet.c.shape_id, revision.c.kind.in_([kind.value for kind in SHOWN_KINDS]))
        .order_by(revision.c.id.desc())
        .limit(1)
        .correlate(facet)
    )
    failed = (
        select(run.c.stage)
        .where(run.c.shape_id == facet.c.shape_id, is_failed_run())
        .order_by(run.c.id.desc())
        .limit(1)
        .correlate(facet)
    )
    values = {
        "state": state.scalar_subquery(),
        "author_id": author.scalar_subquery(),
        "failed_stage": failed.scalar_subquery(),
    }
    for some in batches(sorted(shape_ids)):
        lock_facets(connection, some)
        connection.execute(update(facet).where(facet.c.shape_id.in_(some)).values(values))
        copy_facets(connection, some)


def lock_facets(connection: Connection, shape_ids: Sequence[int]) -> None:
    """Before facets change, or scores beside which they stand; as many as a batch."""
    shape_id = t.shape_facet.c.shape_id
    # in one order, so that two who renew many never wait for each other
    query = select(shape_id).where(shape_id.in_(shape_ids)).order_by(shape_id).with_for_update()
    connection.execute(query).all()


def copy_facets(connection: Connection, shape_ids: Sequence[int]) -> None:
    """Beside the scores of these shapes, after their facets or their scores have changed; as many as a batch."""
    facet, score = t.shape_facet.c, t.score.c
    differs = or_(*(score[name].is_distinct_from(facet[name]) for name in FACETS))
    statement = update(t.score).values({name: facet[name] for name in FACETS})
    connection.execute(statement.where(facet.shape_id == score.shape_id, score.shape_id.in_(shape_ids), differs))


def renew_head_parts(connection: Connection, collection_id: int, shape_id: int, part_ids: Sequence[int]) -> None:
    """The parts of a shape's newest shown labels."""
    connection.execute(delete(t.head_part).where(t.head_part.c.shape_id == shape_id))
    rows = [{"collection_id": collection_id, "part_id": part_id, "shape_id": shape_id} for part_id in part_ids]
    if rows:
        connection.execute(insert(t.head_part), rows)


def note_reference(connection: Connection, collection_id: int, shape_id: int, revision_id: int) -> None:
    """The newest reference labels of a shape."""
    statement = insert_for(connection, t.honeypot).values(
        collection_id=collection_id, shape_id=shape_id, revision_id=revision_id
    )
    connection.execute(
        statement.on_conflict_do_update(
            index_elements=["collection_id", "shape_id"], set_={"revision_id": statement.excluded.revision_id}
        )
    )
