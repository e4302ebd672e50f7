"""Shapes and their meshes."""

from collections.abc import Collection as SizedIterable
from collections.abc import Sequence
from datetime import datetime
from typing import Any

from sqlalchemy import Connection, Select, exists, func, literal, not_, or_, select, update

from partwise.errors import ConflictError, NotFoundError, ParameterError
from partwise.store import tables as t
from partwise.store.records import IngestedShape, IngestOutcome, Mesh, MeshRole, NewMesh, NewShape, Shape, ShapeState
from partwise.store.sql.collections import schema_version
from partwise.store.sql.dialect import batches, insert_for
from partwise.store.sql.facets import add_facets
from partwise.store.sql.state import shape_state

_PRESENT = {MeshRole.WORKING: t.shape.c.mesh_hash, MeshRole.ORIGINAL: t.shape.c.original_mesh_hash}


def add_shapes(
    connection: Connection, collection_id: int, batch: Sequence[NewShape], now: datetime
) -> Sequence[IngestedShape]:
    schema_version(connection, collection_id)  # refuses an unknown collection
    keys = [new.source_key for new in batch]
    if len(set(keys)) != len(keys):
        twice = next(key for key in keys if keys.count(key) > 1)
        raise ParameterError(f"each source key must occur once in a batch but {twice!r} occurs twice; drop one")
    before = _by_key(connection, collection_id, keys)
    rows: list[dict[str, Any]] = [
        {
            "collection_id": collection_id,
            "source_key": new.source_key,
            "source_hash": new.source_hash,
            "source_suffix": new.source_suffix,
            "ingested_at": now,
        }
        for new in batch
        if new.source_key not in before
    ]
    if rows:
        connection.execute(insert_for(connection, t.shape).on_conflict_do_nothing(), rows)
    added = _by_key(connection, collection_id, [row["source_key"] for row in rows])
    add_facets(connection, collection_id, [shape.id for shape in added.values()])
    return [
        _known_shape(connection, new, before[new.source_key], now)
        if new.source_key in before
        else IngestedShape(added[new.source_key].id, new.source_key, IngestOutcome.ADDED)
        for new in batch
    ]


def _by_key(connection: Connection, collection_id: int, keys: Sequence[str]) -> dict[str, Shape]:
    found = {}
    for some in batches(keys):
        query = select(t.shape).where(t.shape.c.collection_id == collection_id, t.shape.c.source_key.in_(some))
        found.update({row.source_key: Shape(**row._mapping) for row in connection.execute(query)})
    return found


def _known_shape(connection: Connection, new: NewShape, known: Shape, now: datetime) -> IngestedShape:
    if known.source_hash == new.source_hash:
        return IngestedShape(known.id, new.source_key, IngestOutcome.UNCHANGED)
    if connection.execute(select(_is_labelled(known.id))).scalar_one():
        return IngestedShape(known.id, new.source_key, IngestOutcome.CONFLICT, known.source_hash)
    connection.execute(
        update(t.shape)
        .where(t.shape.c.id == known.id)
        .values(source_hash=new.source_hash, source_suffix=new.source_suffix, ingested_at=now)
    )
    return IngestedShape(known.id, new.source_key, IngestOutcome.CHANGED, known.source_hash)


def _is_labelled(shape_id: int) -> Any:
    """Of any kind: reference labels would move on to what may be another shape altogether, and nobody reviews them."""
    return exists().where(t.label_revision.c.shape_id == shape_id)


def shapes_by_id(connection: Connection, shape_ids: SizedIterable[int]) -> dict[int, Shape]:
    found = {}
    for some in batches(shape_ids):
        rows = connection.execute(select(t.shape).where(t.shape.c.id.in_(some)))
        found.update({row.id: Shape(**row._mapping) for row in rows})
    return found


def refuse_unknown_shapes(connection: Connection, shape_ids: SizedIterable[int]) -> dict[int, Shape]:
    """The shapes of these ids; `NotFoundError` if any is missing."""
    found = shapes_by_id(connection, shape_ids)
    for shape_id in shape_ids:
        if shape_id not in found:
            raise NotFoundError(f"there is no shape with id {shape_id}")
    return found


def lock_labels(connection: Connection, shape_ids: Sequence[int]) -> None:
    """Makes others who commit or review labels of the shapes, or put them into the queue, wait: which labels are the
    newest and which are wanted does not change. In one order, so that two who lock many never wait for each other.
    """
    for some in batches(sorted(shape_ids)):
        query = select(t.shape.c.id).where(t.shape.c.id.in_(some)).order_by(t.shape.c.id)
        connection.execute(query.with_for_update(key_share=True)).all()


def shape_by_key(connection: Connection, collection_id: int, source_key: str) -> Shape:
    found = _by_key(connection, collection_id, [source_key])
    if source_key not in found:
        raise NotFoundError(f"the collection has no shape {source_key!r}; was it ingested?")
    return found[source_key]


def shapes(
    connection: Connection, collection_id: int, after: int, limit: int, state: ShapeState | None
) -> Sequence[Shape]:
    query: Select[Any] = select(t.shape).where(t.shape.c.collection_id == collection_id, t.shape.c.id > after)
    if state is not None:
        query = query.where(shape_state() == state.value)
    return [Shape(**row._mapping) for row in connection.execute(query.order_by(t.shape.c.id).limit(limit))]


def shape_states(connection: Connection, shape_ids: SizedIterable[int]) -> dict[int, ShapeState]:
    states = {}
    for some in batches(shape_ids):
        rows = connection.execute(select(t.shape.c.id, shape_state()).where(t.shape.c.id.in_(some)))
        states.update({shape_id: ShapeState(state) for shape_id, state in rows})
    return states


def state_counts(connection: Connection, collection_id: int) -> dict[ShapeState, int]:
    schema_version(connection, collection_id)
    states = select(shape_state().label("state")).where(t.shape.c.collection_id == collection_id).subquery()
    rows = connection.execute(select(states.c.state, func.count()).group_by(states.c.state))
    counts = {ShapeState(state): count for state, count in rows}
    return {state: counts.get(state, 0) for state in ShapeState}


def _mesh_query() -> Select[Any]:
    return (
        select(
            t.shape_mesh.c.shape_id,
            t.shape_mesh.c.mesh_hash,
            t.mesh.c.n_vertices,
            t.mesh.c.n_faces,
            t.block.c.name.label("block_name"),
            t.shape_mesh.c.row,
            t.mesh.c.kept_key,
            t.mesh.c.created_at,
        )
        .join_from(t.shape_mesh, t.mesh)
        .join(t.block, t.shape_mesh.c.block_id == t.block.c.id, isouter=True)
    )


def mesh(connection: Connection, shape_id: int, mesh_hash: str) -> Mesh:
    query = _mesh_query().where(t.shape_mesh.c.shape_id == shape_id, t.shape_mesh.c.mesh_hash == mesh_hash)
    row = connection.execute(query).first()
    if row is None:
        raise NotFoundError(f"shape {shape_id} has no mesh {mesh_hash[:12]}…; was it preprocessed?")
    return Mesh(**row._mapping)


def meshes(connection: Connection, shape_ids: SizedIterable[int], role: MeshRole) -> dict[int, Mesh]:
    present = _PRESENT[role]
    found: dict[int, Mesh] = {}
    for some in batches(shape_ids):
        query = (
            _mesh_query()
            .join(t.shape, (t.shape.c.id == t.shape_mesh.c.shape_id) & (present == t.shape_mesh.c.mesh_hash))
            .where(t.shape.c.id.in_(some))
        )
        found.update({row.shape_id: Mesh(**row._mapping) for row in connection.execute(query)})
    return found


def add_meshes(connection: Connection, block_id: int, new_meshes: Sequence[NewMesh], now: datetime) -> None:
    """Record where meshes lie, and that they are their shapes' present ones in their roles.

    A mesh that is known already is found in the new block from now on, except an original that was taken as it is: it
    stays in the block of originals, which outlives those of working meshes.
    """
    for new in new_meshes:
        known = connection.execute(select(t.mesh).where(t.mesh.c.hash == new.mesh_hash)).first()
        if known is None:
            statement = insert_for(connection, t.mesh).on_conflict_do_nothing()
            values = {"hash": new.mesh_hash, "n_vertices": new.n_vertices, "n_faces": new.n_faces, "created_at": now}
            connection.execute(statement, values)
        elif (known.n_vertices, known.n_faces) != (new.n_vertices, new.n_faces):
            raise ConflictError(
                f"mesh {new.mesh_hash[:12]}… must have {known.n_vertices} vertices and {known.n_faces} faces as on "
                f"record but has {new.n_vertices} and {new.n_faces}; is the hash that of the stored mesh?"
            )
        statement = insert_for(connection, t.shape_mesh).values(
            shape_id=new.shape_id, mesh_hash=new.mesh_hash, block_id=block_id, row=new.row
        )
        is_original = exists().where(t.shape.c.id == new.shape_id, t.shape.c.original_mesh_hash == new.mesh_hash)
        moves = or_(literal(new.role is MeshRole.ORIGINAL), t.shape_mesh.c.block_id.is_(None), not_(is_original))
        connection.execute(
            statement.on_conflict_do_update(
                index_elements=["shape_id", "mesh_hash"], set_={"block_id": block_id, "row": new.row}, where=moves
            )
        )
        present = {_PRESENT[new.role].name: new.mesh_hash}
        connection.execute(update(t.shape).where(t.shape.c.id == new.shape_id).values(present))


def keep_mesh(connection: Connection, mesh_hash: str, kept_key: str) -> None:
    result = connection.execute(update(t.mesh).where(t.mesh.c.hash == mesh_hash).values(kept_key=kept_key))
    if result.rowcount == 0:
        raise NotFoundError(f"there is no mesh {mesh_hash[:12]}… on record; was its block published?")
