"""Models, the queue their scores make, the first shapes, the embedding."""

from collections.abc import Sequence
from datetime import datetime
from typing import Any

from sqlalchemy import Connection, Row, delete, func, insert, select, tuple_, update

from partwise.errors import NotFoundError, ParameterError
from partwise.store import tables as t
from partwise.store.records import (
    Embedding,
    FirstShape,
    Model,
    NewModel,
    QueueAnchor,
    QueueRow,
    Shape,
    ShapeState,
)
from partwise.store.sql.collections import schema_version
from partwise.store.sql.dialect import batches, insert_for
from partwise.store.sql.places import set_ranks
from partwise.store.sql.shapes import refuse_unknown_shapes
from partwise.store.sql.state import shape_state

_COLUMNS = tuple(column for column in t.model.c if column.name != "revision_ids")  # they grow with every label


def save_model(connection: Connection, model: NewModel, now: datetime) -> Model:
    schema_version(connection, model.collection_id, for_update=True)  # two trainings never take one version
    shape_ids = _shapes_of(connection, model)
    last = select(func.max(t.model.c.version)).where(t.model.c.collection_id == model.collection_id)
    values = {
        "collection_id": model.collection_id,
        "version": (connection.execute(last).scalar() or 0) + 1,
        "recipe": dict(model.recipe),
        "weights_key": model.weights_key,
        "revision_ids": list(model.revision_ids),
        "n_shapes": len(shape_ids),
        "trained_at": now,
    }
    return _model(connection.execute(insert(t.model).values(values).returning(*_COLUMNS)).one())


def _shapes_of(connection: Connection, model: NewModel) -> set[int]:
    found = {}
    for some in batches(model.revision_ids):
        columns = (t.label_revision.c.id, t.label_revision.c.shape_id)
        found.update({row.id: row.shape_id for row in connection.execute(select(*columns).where(columns[0].in_(some)))})
    for revision_id in model.revision_ids:
        if revision_id not in found:
            raise NotFoundError(f"there is no label revision {revision_id}; a model names what it was trained on")
    return set(found.values())


def _model(row: Row[Any]) -> Model:
    return Model(**row._mapping)


def models(connection: Connection, collection_id: int, before: int | None, limit: int) -> Sequence[Model]:
    schema_version(connection, collection_id)
    query = select(*_COLUMNS).where(t.model.c.collection_id == collection_id)
    if before is not None:
        query = query.where(t.model.c.version < before)
    return [_model(row) for row in connection.execute(query.order_by(t.model.c.version.desc()).limit(limit))]


def latest_model(connection: Connection, collection_id: int) -> Model | None:
    return next(iter(models(connection, collection_id, before=None, limit=1)), None)


def trained_on(connection: Connection, model_id: int) -> Sequence[int]:
    ids: list[int] | None = connection.execute(select(t.model.c.revision_ids).where(t.model.c.id == model_id)).scalar()
    if ids is None:
        raise NotFoundError(f"there is no model with id {model_id}; was it another workspace's?")
    return ids


def model(connection: Connection, collection_id: int, version: int) -> Model:
    query = select(*_COLUMNS).where(t.model.c.collection_id == collection_id, t.model.c.version == version)
    row = connection.execute(query).first()
    if row is None:
        raise NotFoundError(f"the collection has no model version {version}; was it trained?")
    return _model(row)


def queue(
    connection: Connection,
    collection_id: int,
    score_name: str,
    is_descending: bool,
    limit: int,
    after: QueueAnchor | None,
    states: Sequence[ShapeState] | None,
) -> Sequence[QueueRow]:
    schema_version(connection, collection_id)
    state = shape_state()
    place = tuple_(t.score.c.value, t.score.c.shape_id)
    query = (
        select(t.shape, state.label("state"), t.score.c.value, t.score.c.model_id, t.model.c.version)
        .join_from(t.score, t.shape, t.score.c.shape_id == t.shape.c.id)
        .join(t.model, t.model.c.id == t.score.c.model_id)
        .where(t.score.c.collection_id == collection_id, t.score.c.name == score_name)
    )
    if after is not None:
        anchor = tuple_(after.value, after.shape_id)
        query = query.where(place < anchor if is_descending else place > anchor)
    if states is not None:
        query = query.where(state.in_([wanted.value for wanted in states]))
    columns = (t.score.c.value, t.score.c.shape_id)
    query = query.order_by(*(column.desc() if is_descending else column.asc() for column in columns)).limit(limit)
    return [_queue_row(row) for row in connection.execute(query)]


def _queue_row(row: Row[Any]) -> QueueRow:
    shape = Shape(**{column.name: row._mapping[column] for column in t.shape.c})
    return QueueRow(shape, ShapeState(row.state), row.value, row.model_id, row.version)


def replace_first_shapes(connection: Connection, collection_id: int, first_shapes: Sequence[FirstShape]) -> None:
    schema_version(connection, collection_id, for_update=True)
    shapes = refuse_unknown_shapes(connection, [first.shape_id for first in first_shapes])
    for shape in shapes.values():
        if shape.collection_id != collection_id:
            raise ParameterError(f"first shapes must be of the collection but shape {shape.id} is of another")
    if len({first.ordinal for first in first_shapes}) < len(first_shapes) or len(shapes) < len(first_shapes):
        raise ParameterError("each first shape must have its own place but a place or a shape occurs twice")
    connection.execute(delete(t.first_shape).where(t.first_shape.c.collection_id == collection_id))
    rows = [
        {
            "collection_id": collection_id,
            "ordinal": first.ordinal,
            "shape_id": first.shape_id,
            "cluster": first.cluster,
        }
        for first in first_shapes
    ]
    if rows:
        connection.execute(insert(t.first_shape), rows)
    if latest_model(connection, collection_id) is None:  # from then on its scores say who is next
        set_ranks(connection, collection_id, {first.shape_id: first.ordinal + 1 for first in first_shapes})


def first_shapes(connection: Connection, collection_id: int) -> Sequence[FirstShape]:
    schema_version(connection, collection_id)
    columns = (t.first_shape.c.shape_id, t.first_shape.c.ordinal, t.first_shape.c.cluster)
    query = select(*columns).where(t.first_shape.c.collection_id == collection_id).order_by(t.first_shape.c.ordinal)
    return [FirstShape(**row._mapping) for row in connection.execute(query)]


def set_embedding(connection: Connection, collection_id: int, key: str, replacing: str | None, now: datetime) -> bool:
    schema_version(connection, collection_id)
    if replacing is not None:
        is_it = (t.embedding.c.collection_id == collection_id) & (t.embedding.c.key == replacing)
        return connection.execute(update(t.embedding).where(is_it).values(key=key, created_at=now)).rowcount == 1
    statement = insert_for(connection, t.embedding).values(collection_id=collection_id, key=key, created_at=now)
    connection.execute(
        statement.on_conflict_do_update(index_elements=["collection_id"], set_={"key": key, "created_at": now})
    )
    return True


def embedding(connection: Connection, collection_id: int) -> Embedding | None:
    schema_version(connection, collection_id)
    row = connection.execute(select(t.embedding).where(t.embedding.c.collection_id == collection_id)).first()
    return None if row is None else Embedding(**row._mapping)
