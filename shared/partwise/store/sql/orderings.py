"""Orders that can be jumped into: dense ranks, written a piece at a time, seen when they are complete."""

from collections.abc import Sequence
from datetime import datetime
from typing import Any

from sqlalchemy import Connection, Row, delete, exists, func, insert, literal, select, tuple_, update

from partwise.errors import NotFoundError
from partwise.store import tables as t
from partwise.store.records import BY_NAME, Ordering
from partwise.store.sql.collections import schema_version

_COLUMNS = tuple(column for column in t.ordering.c if column.name not in ("is_complete", "last_value", "last_id"))


def begin(connection: Connection, collection_id: int, score_name: str | None, now: datetime) -> Ordering:
    schema_version(connection, collection_id)
    values = {
        "collection_id": collection_id,
        "score_name": score_name,
        "n_shapes": 0,
        "built_at": now,
        "is_complete": False,
    }
    return Ordering(**connection.execute(insert(t.ordering).values(values).returning(*_COLUMNS)).one()._mapping)


def extend(connection: Connection, ordering_id: int, limit: int) -> int:
    known = _found(connection, ordering_id, for_update=True)
    page = _next(connection, known, limit)
    if page:
        rows = [
            {"ordering_id": ordering_id, "rank": rank, "shape_id": row.shape_id}
            for rank, row in enumerate(page, start=known.n_shapes)
        ]
        connection.execute(insert(t.ordering_row), rows)
    values: dict[str, Any] = {"n_shapes": known.n_shapes + len(page), "is_complete": not page}
    if page:
        values |= {"last_id": page[-1].shape_id, "last_value": page[-1].value}
    connection.execute(update(t.ordering).where(t.ordering.c.id == ordering_id).values(values))
    return len(page)


def _next(connection: Connection, known: Row[Any], limit: int) -> Sequence[Row[Any]]:
    """What follows on where the last page ended, whatever has become of the shape there."""
    if known.score_name is None:
        facet = t.shape_facet.c
        by_id = select(facet.shape_id, literal(0.0).label("value")).where(facet.collection_id == known.collection_id)
        by_id = by_id.where(facet.shape_id > (known.last_id or 0))
        return list(connection.execute(by_id.order_by(facet.shape_id).limit(limit)))
    if known.score_name == BY_NAME:
        key = t.shape.c.source_key
        by_name = select(t.shape.c.id.label("shape_id"), literal(0.0).label("value"))
        by_name = by_name.where(t.shape.c.collection_id == known.collection_id)
        if known.last_id is not None:
            by_name = by_name.where(key > select(key).where(t.shape.c.id == known.last_id).scalar_subquery())
        return list(connection.execute(by_name.order_by(key).limit(limit)))
    score = t.score.c
    of_score = (score.collection_id == known.collection_id) & (score.name == known.score_name)
    by_score = select(score.shape_id, score.value).where(of_score).order_by(score.value, score.shape_id).limit(limit)
    if known.last_id is not None:
        by_score = by_score.where(tuple_(score.value, score.shape_id) > tuple_(known.last_value, known.last_id))
    return list(connection.execute(by_score))


def ordering(connection: Connection, collection_id: int, score_name: str | None) -> Ordering | None:
    query = (
        select(*_COLUMNS)
        .where(t.ordering.c.collection_id == collection_id, t.ordering.c.score_name == score_name)
        .where(t.ordering.c.is_complete)
        .order_by(t.ordering.c.id.desc())
        .limit(1)
    )
    row = connection.execute(query).first()
    return None if row is None else Ordering(**row._mapping)


def ordered_shapes(
    connection: Connection, ordering_id: int, first_rank: int, limit: int, *, descending: bool
) -> list[int]:
    known, row = _found(connection, ordering_id), t.ordering_row.c
    query = select(row.shape_id).where(row.ordering_id == ordering_id).limit(limit)
    if descending:
        query = query.where(row.rank <= known.n_shapes - 1 - first_rank).order_by(row.rank.desc())
    else:
        query = query.where(row.rank >= first_rank).order_by(row.rank)
    return list(connection.execute(query).scalars())


def prune(connection: Connection, limit: int) -> int:
    newer = t.ordering.alias("newer")
    is_replaced = exists().where(
        newer.c.collection_id == t.ordering.c.collection_id,
        func.coalesce(newer.c.score_name, "") == func.coalesce(t.ordering.c.score_name, ""),
        newer.c.is_complete,
        newer.c.id > t.ordering.c.id,
    )
    row, n_gone = t.ordering_row.c, 0
    for ordering_id in connection.execute(select(t.ordering.c.id).where(is_replaced)).scalars().all():
        last = select(row.rank).where(row.ordering_id == ordering_id).order_by(row.rank).limit(limit - n_gone)
        ranks = connection.execute(last).scalars().all()
        if ranks:
            gone = (row.ordering_id == ordering_id) & (row.rank <= ranks[-1])
            n_gone += connection.execute(delete(t.ordering_row).where(gone)).rowcount
        if connection.execute(select(row.rank).where(row.ordering_id == ordering_id).limit(1)).first() is None:
            connection.execute(delete(t.ordering).where(t.ordering.c.id == ordering_id))
        if n_gone >= limit:
            break
    return n_gone


def _found(connection: Connection, ordering_id: int, *, for_update: bool = False) -> Row[Any]:
    query = select(t.ordering).where(t.ordering.c.id == ordering_id)
    row = connection.execute(query.with_for_update() if for_update else query).first()
    if row is None:
        raise NotFoundError(f"there is no ordering {ordering_id}; a newer one has replaced it: ask for that")
    return row
