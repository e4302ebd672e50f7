"""The table of shapes: filtered by facets, ordered by id or by a score, a page at a time."""

from collections.abc import Collection as SizedIterable
from collections.abc import Mapping, Sequence
from typing import Any

from sqlalchemy import ColumnElement, Connection, Row, Select, and_, bindparam, exists, func, select, tuple_, update

from partwise.store import tables as t
from partwise.store.records import (
    ANY_STAGE,
    BY_NAME,
    ListAnchor,
    ListedShape,
    Shape,
    ShapeFilter,
    ShapeOrder,
    ShapeState,
)
from partwise.store.sql.collections import schema_version
from partwise.store.sql.dialect import batches

_FEW = 5_000
"""Shapes up to which a filter's matches are all looked up and sorted. With more of them than that, enough are met while
walking along the order."""


def list_shapes(
    connection: Connection,
    collection_id: int,
    where: ShapeFilter,
    order: ShapeOrder,
    after: ListAnchor | None,
    limit: int,
) -> list[ListedShape]:
    schema_version(connection, collection_id)
    if order.score_name is None:
        query = _by_id(collection_id, where, order.descending, after)
    else:
        few = _matches_if_few(connection, collection_id, where)
        if order.score_name == BY_NAME:
            query = _by_name(collection_id, where, order.descending, after, few)
        else:
            query = _by_score(collection_id, where, order.score_name, order.descending, after, few)
    return [_listed(row) for row in connection.execute(query.limit(limit))]


def _by_id(collection_id: int, where: ShapeFilter, is_descending: bool, after: ListAnchor | None) -> Select[Any]:
    shape_id = t.shape_facet.c.shape_id
    query = _of_part(_rows(None), where).where(*_conditions(collection_id, where))
    if after is not None:
        query = query.where(shape_id < after.shape_id if is_descending else shape_id > after.shape_id)
    return query.order_by(shape_id.desc() if is_descending else shape_id)


def _by_name(
    collection_id: int, where: ShapeFilter, is_descending: bool, after: ListAnchor | None, few: Sequence[int] | None
) -> Select[Any]:
    key = t.shape.c.source_key
    query = _rows(None).where(t.shape.c.collection_id == collection_id)
    query = query.where(*_conditions(None, where)) if few is None else query.where(t.shape.c.id.in_(few))
    if after is not None:  # a source key never changes: the anchor's id says it
        last = select(t.shape.c.source_key).where(t.shape.c.id == after.shape_id).scalar_subquery()
        query = query.where(key < last if is_descending else key > last)
    return query.order_by(key.desc() if is_descending else key)


def _by_score(
    collection_id: int,
    where: ShapeFilter,
    score_name: str,
    is_descending: bool,
    after: ListAnchor | None,
    few: Sequence[int] | None,
) -> Select[Any]:
    place = tuple_(t.score.c.value, t.score.c.shape_id)
    query = _rows(score_name).where(t.score.c.collection_id == collection_id)
    query = query.where(*_conditions(None, where)) if few is None else query.where(t.score.c.shape_id.in_(few))
    if after is not None:
        anchor = tuple_(after.value, after.shape_id)
        query = query.where(place < anchor if is_descending else place > anchor)
    columns = (t.score.c.value, t.score.c.shape_id)
    return query.order_by(*(column.desc() if is_descending else column.asc() for column in columns))


def _matches_if_few(connection: Connection, collection_id: int, where: ShapeFilter) -> Sequence[int] | None:
    """Ids of all that meet the filter, None if they are many or nothing is filtered."""
    if where == ShapeFilter():
        return None
    query = _of_part(select(t.shape_facet.c.shape_id), where).where(*_conditions(collection_id, where))
    found = connection.execute(query.limit(_FEW + 1)).scalars().all()
    return None if len(found) > _FEW else found


def _conditions(collection_id: int | None, where: ShapeFilter) -> list[ColumnElement[bool]]:
    facet = t.shape_facet.c
    conditions = [] if collection_id is None else [facet.collection_id == collection_id]
    if where.state is not None:
        conditions.append(facet.state == where.state.value)
    if where.author_id is not None:
        conditions.append(facet.author_id == where.author_id)
    if where.cluster is not None:
        conditions.append(facet.cluster == where.cluster)
    if where.failed_stage == ANY_STAGE:
        conditions.append(facet.failed_stage.is_not(None))
    elif where.failed_stage is not None:
        conditions.append(facet.failed_stage == where.failed_stage)
    if where.part_id is not None and collection_id is None:
        of_shape = and_(
            t.head_part.c.collection_id == facet.collection_id,
            t.head_part.c.part_id == where.part_id,
            t.head_part.c.shape_id == facet.shape_id,
        )
        conditions.append(exists().where(of_shape))
    return conditions


def _of_part(query: Select[Any], where: ShapeFilter) -> Select[Any]:
    """Joined with the shapes that have the part: they are found in the part's own index, however few they are."""
    if where.part_id is None:
        return query
    facet, part = t.shape_facet.c, t.head_part.c
    is_same = and_(part.shape_id == facet.shape_id, part.collection_id == facet.collection_id)
    return query.join(t.head_part, is_same).where(part.part_id == where.part_id)


def _rows(score_name: str | None) -> Select[Any]:
    """Rows of the table: with a score, of shapes that have it."""
    facet = t.shape_facet
    columns = (t.shape, facet.c.state, facet.c.author_id, facet.c.cluster, facet.c.failed_stage)
    if score_name is None:
        return select(*columns).join_from(facet, t.shape, t.shape.c.id == facet.c.shape_id)
    return (
        select(*columns, t.score.c.value, t.model.c.version)
        .join_from(t.score, facet, facet.c.shape_id == t.score.c.shape_id)
        .join(t.shape, t.shape.c.id == t.score.c.shape_id)
        .join(t.model, t.model.c.id == t.score.c.model_id)
        .where(t.score.c.name == score_name)
    )


def _listed(row: Row[Any]) -> ListedShape:
    values = row._mapping
    shape = Shape(**{column.name: values[column] for column in t.shape.c})
    return ListedShape(
        shape,
        ShapeState(row.state),
        row.author_id,
        row.cluster,
        row.failed_stage,
        values.get("value"),
        values.get("version"),
    )


def listed_shapes(connection: Connection, shape_ids: Sequence[int], score_name: str | None) -> dict[int, ListedShape]:
    found = {}
    for some in batches(shape_ids):
        rows = connection.execute(_rows(None).where(t.shape_facet.c.shape_id.in_(some)))
        found.update({row.id: _listed(row) for row in rows})
        if score_name is not None:
            scored = connection.execute(_rows(score_name).where(t.score.c.shape_id.in_(some)))
            found.update({row.id: _listed(row) for row in scored})
    return found


def shapes_from_rank(
    connection: Connection,
    collection_id: int,
    where: ShapeFilter,
    order: ShapeOrder,
    first_rank: int,
    limit: int,
) -> list[ListedShape]:
    schema_version(connection, collection_id)
    few = None if order.score_name is None else _matches_if_few(connection, collection_id, where)
    query = _ids(collection_id, where, order, few).offset(first_rank).limit(limit)
    ids = connection.execute(query).scalars().all()
    score_name = None if order.score_name == BY_NAME else order.score_name
    rows = listed_shapes(connection, ids, score_name)
    return [rows[shape_id] for shape_id in ids]


def count_shapes(connection: Connection, collection_id: int, where: ShapeFilter, order: ShapeOrder) -> int:
    schema_version(connection, collection_id)
    few = None
    if order.score_name in (None, BY_NAME):
        ids = _ids(collection_id, where, ShapeOrder(), None)
    else:
        few = _matches_if_few(connection, collection_id, where)
        ids = _ids(collection_id, where, order, few)
    counted = ids.order_by(None).subquery()
    return connection.execute(select(func.count()).select_from(counted)).scalar_one()


def _ids(collection_id: int, where: ShapeFilter, order: ShapeOrder, few: Sequence[int] | None) -> Select[Any]:
    """Ids alone: where nothing is filtered they are read from an index and no row is."""
    facet, is_filtered = t.shape_facet.c, where != ShapeFilter()
    columns: tuple[ColumnElement[Any], ...]
    if order.score_name is None:
        query, columns = select(facet.shape_id), (facet.shape_id,)
        query = _of_part(query, where).where(*_conditions(collection_id, where))
    else:
        if order.score_name == BY_NAME:
            shape_id, columns = t.shape.c.id, (t.shape.c.source_key,)
            query = select(shape_id).where(t.shape.c.collection_id == collection_id)
        else:
            shape_id, columns = t.score.c.shape_id, (t.score.c.value, t.score.c.shape_id)
            query = select(shape_id).where(t.score.c.collection_id == collection_id, t.score.c.name == order.score_name)
        if few is not None:
            query = query.where(shape_id.in_(few))
        elif is_filtered:
            query = query.join(t.shape_facet, facet.shape_id == shape_id).where(*_conditions(None, where))
    return query.order_by(*(column.desc() if order.descending else column.asc() for column in columns))


def score_names(connection: Connection, collection_id: int) -> list[str]:
    schema_version(connection, collection_id)
    names: list[str] = []
    following = select(func.min(t.score.c.name)).where(t.score.c.collection_id == collection_id)
    while True:  # from name to name in the index, not over all scores
        query = following.where(t.score.c.name > names[-1]) if names else following
        name = connection.execute(query).scalar()
        if name is None:
            return names
        names.append(name)


def set_clusters(connection: Connection, collection_id: int, clusters: Mapping[int, int]) -> None:
    schema_version(connection, collection_id)
    facet = t.shape_facet.c
    is_it = (facet.shape_id == bindparam("of_shape")) & (facet.collection_id == collection_id)
    for some in batches(sorted(clusters)):
        rows = [{"of_shape": shape_id, "in_cluster": clusters[shape_id]} for shape_id in some]
        connection.execute(update(t.shape_facet).where(is_it).values(cluster=bindparam("in_cluster")), rows)


def clusters(connection: Connection, shape_ids: SizedIterable[int]) -> dict[int, int]:
    facet, found = t.shape_facet.c, {}
    for some in batches(shape_ids):
        query = select(facet.shape_id, facet.cluster).where(facet.shape_id.in_(some), facet.cluster.is_not(None))
        found.update({row.shape_id: row.cluster for row in connection.execute(query)})
    return found


def cluster_sizes(connection: Connection, collection_id: int) -> dict[int, int]:
    facet = t.shape_facet.c
    query = select(facet.cluster, func.count()).where(facet.collection_id == collection_id, facet.cluster.is_not(None))
    rows = connection.execute(query.group_by(facet.cluster).order_by(facet.cluster)).all()
    return {int(row[0]): int(row[1]) for row in rows}
