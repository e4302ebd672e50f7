"""What the table of shapes is filtered by, renewed in the transaction of whatever changes it."""

from collections.abc import Collection as SizedIterable
from collections.abc import Sequence

from sqlalchemy import Connection, delete, insert, select, update

from partwise.store import tables as t
from partwise.store.catalog import SHOWN_KINDS
from partwise.store.records import ShapeState
from partwise.store.sql.dialect import batches, insert_for
from partwise.store.sql.state import is_failed_run, shape_state


def add_facets(connection: Connection, collection_id: int, shape_ids: SizedIterable[int]) -> None:
    """For shapes that are new."""
    rows = [
        {"shape_id": shape_id, "collection_id": collection_id, "state": ShapeState.NEW.value} for shape_id in shape_ids
    ]
    if rows:
        connection.execute(insert_for(connection, t.shape_facet).on_conflict_do_nothing(), rows)


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
        those = facet.c.shape_id.in_(some)
        # in one order, so that two who renew many never wait for each other
        connection.execute(select(facet.c.shape_id).where(those).order_by(facet.c.shape_id).with_for_update()).all()
        connection.execute(update(facet).where(those).values(values))


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
