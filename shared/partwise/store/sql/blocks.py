"""Which blocks are on record, which nothing needs any more, and forgetting those."""

from collections.abc import Collection as SizedIterable
from collections.abc import Sequence
from datetime import datetime

from sqlalchemy import ColumnElement, Connection, and_, delete, exists, not_, or_, select, update

from partwise.errors import ConflictError, NotFoundError
from partwise.store import tables as t
from partwise.store.records import Block
from partwise.store.sql.facets import renew_facets
from partwise.store.sql.places import renew_places
from partwise.store.sql.state import is_current_run


def block(connection: Connection, name: str) -> Block:
    row = connection.execute(select(t.block).where(t.block.c.name == name)).first()
    if row is None:
        raise NotFoundError(f"there is no block {name!r} on record; was it published?")
    return Block(**row._mapping)


def visible_blocks(connection: Connection, after: int, limit: int) -> Sequence[Block]:
    query = select(t.block).where(t.block.c.id > after).order_by(t.block.c.id).limit(limit)
    return [Block(**row._mapping) for row in connection.execute(query)]


def unused_blocks(connection: Connection, limit: int) -> Sequence[Block]:
    query = select(t.block).where(not_(_is_in_use())).order_by(t.block.c.id).limit(limit)
    return [Block(**row._mapping) for row in connection.execute(query)]


def _is_in_use() -> ColumnElement[bool]:
    """A current run has its arrays there, or it is the only place of a mesh that labels or strokes are on."""
    holds_current = exists().where(t.stage_run.c.block_id == t.block.c.id, is_current_run())
    holds_labelled = (
        select(t.shape_mesh.c.mesh_hash)
        .join(t.mesh, t.mesh.c.hash == t.shape_mesh.c.mesh_hash)
        .where(t.shape_mesh.c.block_id == t.block.c.id, t.mesh.c.kept_key.is_(None))
        .where(or_(exists().where(_labels_of_shape_mesh()), exists().where(_drafts_on_shape_mesh())))
        .exists()
    )
    return or_(holds_current.correlate(t.block), holds_labelled.correlate(t.block))


def _labels_of_shape_mesh() -> ColumnElement[bool]:
    return and_(
        t.label_revision.c.shape_id == t.shape_mesh.c.shape_id,
        t.label_revision.c.mesh_hash == t.shape_mesh.c.mesh_hash,
    )


def _drafts_on_shape_mesh() -> ColumnElement[bool]:
    return and_(t.draft.c.shape_id == t.shape_mesh.c.shape_id, t.draft.c.mesh_hash == t.shape_mesh.c.mesh_hash)


def supersede_block(connection: Connection, name: str, now: datetime) -> int:
    in_block = t.stage_run.c.block_id == block(connection, name).id
    statement = update(t.stage_run).where(in_block, is_current_run()).values(is_superseded=True)
    shape_ids = connection.execute(statement.returning(t.stage_run.c.shape_id)).scalars().all()
    renew_facets(connection, set(shape_ids))
    renew_places(connection, set(shape_ids), now)
    return len(shape_ids)


def delete_blocks(connection: Connection, names: SizedIterable[str]) -> None:
    for name in names:
        found = connection.execute(select(t.block.c.id, _is_in_use()).where(t.block.c.name == name)).first()
        if found is None:
            continue
        block_id, is_in_use = found
        if is_in_use:
            raise ConflictError(f"a block in use is never deleted but {name} is; delete only unused blocks")
        connection.execute(delete(t.stage_run).where(t.stage_run.c.block_id == block_id))
        in_block = t.shape_mesh.c.block_id == block_id
        is_labelled = or_(exists().where(_labels_of_shape_mesh()), exists().where(_drafts_on_shape_mesh()))
        connection.execute(delete(t.shape_mesh).where(in_block, not_(is_labelled)))
        connection.execute(update(t.shape_mesh).where(in_block).values(block_id=None, row=None))
        connection.execute(delete(t.block).where(t.block.c.id == block_id))
