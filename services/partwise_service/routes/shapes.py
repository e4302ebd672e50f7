"""/collections/{collection_id}/shapes, /shapes/{shape_id}: the table, and one shape with how it came to be."""

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Annotated

from fastapi import APIRouter, Depends, Query
from pydantic import Field

from partwise.store.catalog import SHOWN_KINDS, Catalog
from partwise.store.records import (
    ANY_STAGE,
    BY_NAME,
    ListedShape,
    Role,
    ShapeFilter,
    ShapeOrder,
    ShapeState,
    ShapeTile,
)
from partwise.workspace.provenance import FailureCard, ProvenanceCard, provenance
from partwise_service.answering import AnswerRoute
from partwise_service.dependencies import Caller, CatalogDep, ScopedCollection, ScopedShape, WorkspaceDep, shapes_of
from partwise_service.schemas.base import MAX_ROW_ID, NO_NUL, Page
from partwise_service.schemas.paging import anchor_of, cursor_of
from partwise_service.schemas.shapes import (
    CountOut,
    DirectionName,
    OrderOut,
    OrdersOut,
    RankedShapes,
    RevisionOut,
    RevisionsOut,
    ShapeOut,
    ShapeRow,
    ShapeRows,
)
from partwise_service.security.identity import Identity

MAX_PAGE = 500
MAX_NAME = 200
NO_ORDER = "none"
LIVE_UP_TO = 20_000
"""Shapes up to which a jump is into the present order; past them into one made beforehand, where there is one."""
LABELS = {"entropy": "Entropy", "entropy_by_area": "Entropy by area", "bald": "BALD"}
router = APIRouter(route_class=AnswerRoute, tags=["shapes"])

Limit = Annotated[int, Query(ge=1, le=MAX_PAGE, description="Rows of a page, at most.")]
After = Annotated[str | None, Query(max_length=80, description="`next` of the page before.")]
Id = Annotated[int | None, Query(ge=0, le=MAX_ROW_ID)]
NamedId = Annotated[int, Field(ge=1, le=MAX_ROW_ID)]
StageName = Annotated[
    str | None, Query(pattern="^[a-z_]{1,64}$", description=f"The stage that failed, `{ANY_STAGE}` for whichever.")
]
Searched = Annotated[str, NO_NUL, Field(min_length=1, max_length=MAX_NAME)]
Name = Annotated[
    Searched | None,
    Query(description="A part of the shape's name, A to Z in either case. No character stands for others."),
]
OrderName = Annotated[
    str, Query(pattern="^[a-z_]{1,64}$", description=f"`{NO_ORDER}` (by id), `{BY_NAME}`, or a score's name.")
]


async def shape_filter(
    state: ShapeState | None = None,
    part: Id = None,
    cluster: Id = None,
    author: Id = None,
    failure: StageName = None,
    name: Name = None,
) -> ShapeFilter:
    """What shapes must meet, all of it."""
    return ShapeFilter(state, part, cluster, author, failure, name)


async def shape_order(order: OrderName = NO_ORDER, direction: DirectionName = DirectionName.ASC) -> ShapeOrder:
    """The order that the table is in."""
    return ShapeOrder(None if order == NO_ORDER else order, direction is DirectionName.DESC)


Where = Annotated[ShapeFilter, Depends(shape_filter)]
Order = Annotated[ShapeOrder, Depends(shape_order)]


@router.get("/collections/{collection_id}/shapes")
def list_shapes(
    caller: Caller,
    collection: ScopedCollection,
    catalog: CatalogDep,
    where: Where,
    order: Order,
    after: After = None,
    limit: Limit = 100,
) -> Page[ShapeRow]:
    """A page of the table: shapes that meet every filter given, in order of a score, of their names or of their ids.

    In an order by score, shapes that have no such score are left out.
    """
    rows = catalog.list_shapes(collection.id, where=where, order=order, after=anchor_of(after), limit=limit)
    next_after = cursor_of(rows[-1].anchor) if len(rows) == limit else None
    return Page(items=_with_tiles(catalog, caller, rows, order), next=next_after)


@router.get("/collections/{collection_id}/shapes/count")
def count_shapes(collection: ScopedCollection, catalog: CatalogDep, where: Where, order: Order) -> CountOut:
    """How many rows the table has in all."""
    return CountOut(n_shapes=catalog.count_shapes(collection.id, where=where, order=order))


@router.get("/collections/{collection_id}/shapes/ranked")
def jump_to_rank(
    caller: Caller,
    collection: ScopedCollection,
    catalog: CatalogDep,
    where: Where,
    order: Order,
    first_rank: Annotated[int, Query(ge=0, le=MAX_ROW_ID, description="Counted from 0.")] = 0,
    limit: Limit = 100,
) -> RankedShapes:
    """Shapes from a rank on, under the same filters and in the same orders as the list: for scrollbars."""
    score_name = None if order.score_name == BY_NAME else order.score_name
    made = catalog.ordering(collection.id, order.score_name) if where == ShapeFilter() else None
    rows: Sequence[ListedShape]
    if made is not None and made.n_shapes > LIVE_UP_TO:
        n_shapes, built_at = made.n_shapes, made.built_at
        ids = catalog.ordered_shapes(made.id, first_rank, limit, descending=order.descending)
        known = catalog.listed_shapes(ids, score_name)
        rows = [known[shape_id] for shape_id in ids]
    else:
        rows = catalog.shapes_from_rank(collection.id, first_rank, where=where, order=order, limit=limit)
        n_shapes, built_at = first_rank + len(rows), None
        if len(rows) == limit or (first_rank and not rows):  # else the last one has been seen
            n_shapes = catalog.count_shapes(collection.id, where=where, order=order)
    items = _with_tiles(catalog, caller, rows, order, first_rank)
    return RankedShapes(n_shapes=n_shapes, built_at=built_at, items=items)


@router.get("/collections/{collection_id}/shapes/rows")
def list_rows(
    caller: Caller,
    collection: ScopedCollection,
    catalog: CatalogDep,
    order: Order,
    ids: Annotated[list[NamedId], Query(alias="id", min_length=1, max_length=MAX_PAGE, description="Again for more.")],
) -> ShapeRows:
    """These shapes, in the order in which they are named, such as those picked on the map."""
    named = [shape.id for shape in shapes_of(catalog, collection, ids)]
    rows = catalog.listed_shapes(named, order.score_name if order.score_name != BY_NAME else None)
    return ShapeRows(items=_with_tiles(catalog, caller, [rows[shape_id] for shape_id in named], order))


@router.get("/collections/{collection_id}/orders")
def list_orders(collection: ScopedCollection, catalog: CatalogDep) -> OrdersOut:
    """The orders that the table can be in now."""
    asc, desc = DirectionName.ASC, DirectionName.DESC
    always = [
        OrderOut(name=NO_ORDER, label="None", direction_default=asc, is_queues=False),
        OrderOut(name=BY_NAME, label="Name", direction_default=asc, is_queues=False),
    ]
    of_queue = catalog.ranking_score(collection.id)
    scores = [
        OrderOut(name=name, label=_label(name), direction_default=desc, is_queues=name == of_queue)
        for name in catalog.score_names(collection.id)
    ]
    return OrdersOut(items=[*always, *scores])


@router.get("/shapes/{shape_id}")
def show_shape(caller: Caller, shape: ScopedShape, workspace: WorkspaceDep) -> ShapeOut:
    """One shape: its mesh, its newest labels, what every stage made of it. Logs of failures are for operators."""
    card = provenance(workspace, shape)
    if not caller.role.includes(Role.OPERATOR):
        card = _without_logs(card)
    mesh = workspace.catalog.meshes([shape.id]).get(shape.id)
    return ShapeOut.of(shape, mesh, workspace.catalog.head_revision(shape.id), card)


@router.get("/shapes/{shape_id}/revisions")
def list_revisions(shape: ScopedShape, catalog: CatalogDep) -> RevisionsOut:
    """Every revision of a shape's labels that may be shown, oldest first."""
    shown = [each for each in catalog.revisions(shape.id) if each.kind in SHOWN_KINDS]
    return RevisionsOut(items=[RevisionOut.of(each) for each in shown])


def _without_logs(card: ProvenanceCard) -> ProvenanceCard:
    def without_log(failure: FailureCard | None) -> FailureCard | None:
        return None if failure is None else replace(failure, log=(), steps=())

    return replace(card, stages=tuple(replace(stage, failure=without_log(stage.failure)) for stage in card.stages))


def _with_tiles(
    catalog: Catalog, caller: Identity, rows: Sequence[ListedShape], order: ShapeOrder, first_rank: int | None = None
) -> list[ShapeRow]:
    tiles = catalog.shape_tiles([row.shape.id for row in rows])
    return [
        ShapeRow.of(row, tiles[row.shape.id], None if first_rank is None else first_rank + place)
        for place, row in enumerate(_as_leased(catalog, caller, rows, tiles, order))
    ]


def _as_leased(
    catalog: Catalog,
    caller: Identity,
    rows: Sequence[ListedShape],
    tiles: Mapping[int, ShapeTile],
    order: ShapeOrder,
) -> Sequence[ListedShape]:
    """The rows; those of shapes that the caller holds with the score that the lease tells, and no other.

    Of work that is not to be recognised that is another than the shape's own: two that differ would give it away, and
    so would one that nothing else at the head of the queue is like.
    """
    if not any(holder.person_id == caller.person_id for row in rows for holder in tiles[row.shape.id].holders):
        return rows
    leases = {lease.shape_id: lease for lease in catalog.leases_of(caller.person_id)}
    return [
        row
        if (lease := leases.get(row.shape.id)) is None or row.value is None
        else replace(row, value=lease.score, model_version=lease.model_version)
        if lease.score_name == order.score_name
        else replace(row, value=None, model_version=None)
        for row in rows
    ]


def _label(score_name: str) -> str:
    return LABELS.get(score_name, score_name.replace("_", " ").capitalize())
