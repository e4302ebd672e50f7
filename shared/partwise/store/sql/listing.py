"""The table of shapes: filtered by facets, ordered by id or by a score, a page at a time."""

from collections.abc import Collection as SizedIterable
from collections.abc import Mapping, Sequence
from typing import Any

from sqlalchemy import (
    ColumnElement,
    Connection,
    Row,
    Select,
    Table,
    and_,
    bindparam,
    exists,
    func,
    literal,
    select,
    tuple_,
    update,
)

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
from partwise.store.sql.dialect import batches, has_in_it
from partwise.store.sql.facets import copy_facets

_FEW = 1_000
"""Shapes up to which a filter's matches are all looked up and sorted. With more of them than that, they are met while
walking along the order's index, which says of every shape whether it is one.
"""

_NO_ID = 0
_OF_SHAPE = tuple(column.name for column in t.shape.c)


def list_shapes(
    connection: Connection,
    collection_id: int,
    where: ShapeFilter,
    order: ShapeOrder,
    after: ListAnchor | None,
    limit: int,
) -> list[ListedShape]:
    schema_version(connection, collection_id)
    query = _ids(collection_id, where, order, _matches_if_few(connection, collection_id, where, order))
    if after is not None:
        query = query.where(_is_after(order, after))
    return _in_order(connection, connection.execute(query.limit(limit)).scalars().all(), order)


def _is_after(order: ShapeOrder, after: ListAnchor) -> ColumnElement[bool]:
    place: ColumnElement[Any]
    anchor: ColumnElement[Any]
    if order.score_name is None:
        place, anchor = t.shape_facet.c.shape_id, literal(after.shape_id)
    elif order.score_name == BY_NAME:  # a source key never changes: the anchor's id says it
        place = t.shape_facet.c.source_key
        anchor = select(t.shape.c.source_key).where(t.shape.c.id == after.shape_id).scalar_subquery()
    else:
        place = tuple_(t.score.c.value, t.score.c.shape_id)
        anchor = tuple_(after.value, after.shape_id)
    return place < anchor if order.descending else place > anchor


def _in_order(connection: Connection, shape_ids: Sequence[int], order: ShapeOrder) -> list[ListedShape]:
    """Their rows, in this order."""
    if not shape_ids:
        return []
    is_by_score = order.score_name not in (None, BY_NAME)
    asked = {"ids": shape_ids, "of_name": order.score_name}
    rows = {row.id: _listed(row) for row in connection.execute(_SCORED if is_by_score else _LISTED, asked)}
    return [rows[shape_id] for shape_id in shape_ids]


def _matches_if_few(
    connection: Connection, collection_id: int, where: ShapeFilter, order: ShapeOrder
) -> Sequence[int] | None:
    """Ids of all that meet the filter; None if they are many, nothing is filtered, or an index has them in order."""
    if where == ShapeFilter() or order.score_name is None:
        return None
    if where == ShapeFilter(part_id=where.part_id):  # all of that is in the part's own index
        part = t.head_part.c
        query = select(part.shape_id).where(part.collection_id == collection_id, part.part_id == where.part_id)
    else:
        facet = t.shape_facet
        query = _of_part(select(facet.c.shape_id), where).where(*_conditions(facet, collection_id, where))
    found = connection.execute(query.limit(_FEW + 1)).scalars().all()
    return None if len(found) > _FEW else found


def _conditions(facets: Table, collection_id: int, where: ShapeFilter) -> list[ColumnElement[bool]]:
    """Of all filters but that by part, on facets or on scores, beside which facets stand."""
    facet = facets.c
    conditions = [facet.collection_id == collection_id]
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
    if where.name is not None:
        conditions.append(has_in_it(facet.source_key, where.name))
    return conditions


def _has_part(facets: Table, where: ShapeFilter) -> list[ColumnElement[bool]]:
    """For a walk along an order: of shapes without labels, and so without an author, parts are not even looked for."""
    if where.part_id is None:
        return []
    part = t.head_part.c
    is_same = and_(part.collection_id == facets.c.collection_id, part.shape_id == facets.c.shape_id)
    return [facets.c.author_id.is_not(None), exists().where(is_same, part.part_id == where.part_id)]


def _of_part(query: Select[Any], where: ShapeFilter) -> Select[Any]:
    """Joined with the shapes that have the part: they are found in the part's own index, however few they are."""
    if where.part_id is None:
        return query
    facet, part = t.shape_facet.c, t.head_part.c
    is_same = and_(part.shape_id == facet.shape_id, part.collection_id == facet.collection_id)
    return query.join(t.head_part, is_same).where(part.part_id == where.part_id)


def _rows(*, with_score: bool) -> Select[Any]:
    """Rows of the table, of shapes among `ids`: with the score `of_name`, of those that have it."""
    facet = t.shape_facet
    columns = (t.shape, facet.c.state, facet.c.author_id, facet.c.cluster, facet.c.failed_stage)
    if not with_score:
        query = select(*columns).join_from(facet, t.shape, t.shape.c.id == facet.c.shape_id)
        return query.where(facet.c.shape_id.in_(bindparam("ids", expanding=True)))
    return (
        select(*columns, t.score.c.value, t.model.c.version)
        .join_from(t.score, facet, facet.c.shape_id == t.score.c.shape_id)
        .join(t.shape, t.shape.c.id == t.score.c.shape_id)
        .join(t.model, t.model.c.id == t.score.c.model_id)
        .where(t.score.c.shape_id.in_(bindparam("ids", expanding=True)), t.score.c.name == bindparam("of_name"))
    )


_LISTED, _SCORED = _rows(with_score=False), _rows(with_score=True)
"""Built once: every page of the table, and everybody's look at what they hold, asks one of them."""


def _listed(row: Row[Any]) -> ListedShape:
    values = row._mapping
    shape = Shape(**{name: getattr(row, name) for name in _OF_SHAPE})
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
        rows = connection.execute(_LISTED, {"ids": some})
        found.update({row.id: _listed(row) for row in rows})
        if score_name is not None:
            scored = connection.execute(_SCORED, {"ids": some, "of_name": score_name})
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
    few = _matches_if_few(connection, collection_id, where, order)
    query = _ids(collection_id, where, order, few).offset(first_rank).limit(limit)
    return _in_order(connection, connection.execute(query).scalars().all(), order)


def count_shapes(connection: Connection, collection_id: int, where: ShapeFilter, order: ShapeOrder) -> int:
    schema_version(connection, collection_id)
    counted_by = ShapeOrder() if order.score_name == BY_NAME else order
    few = _matches_if_few(connection, collection_id, where, counted_by)
    counted = _ids(collection_id, where, counted_by, few).order_by(None).subquery()
    return connection.execute(select(func.count()).select_from(counted)).scalar_one()


def _ids(collection_id: int, where: ShapeFilter, order: ShapeOrder, few: Sequence[int] | None) -> Select[Any]:
    """Ids in order, read from one index without a look at any row; from the part's index where that has the order."""
    facets = t.shape_facet if order.score_name in (None, BY_NAME) else t.score
    query = select(facets.c.shape_id)
    columns: tuple[ColumnElement[Any], ...] = (t.shape_facet.c.shape_id,)
    if order.score_name == BY_NAME:
        columns = (t.shape_facet.c.source_key,)
    elif order.score_name is not None:
        columns = (t.score.c.value, t.score.c.shape_id)
        query = query.where(t.score.c.name == order.score_name)
    if few is not None:
        # looked up one by one: nothing here is what an order's index begins with, lest the database walk along that
        columns = (columns[0].concat("") if order.score_name == BY_NAME else columns[0] + 0.0, facets.c.shape_id)
        query = query.where(facets.c.shape_id.in_(few or (_NO_ID,)))
    elif order.score_name is None:
        query = _of_part(query.where(*_conditions(facets, collection_id, where)), where)
    else:
        query = query.where(*_conditions(facets, collection_id, where), *_has_part(facets, where))
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
        copy_facets(connection, some)


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
