"""/collections/{collection_id}/shapes, /shapes/{shape_id}: the table, and one shape with how it came to be."""

from dataclasses import replace
from typing import Annotated

from fastapi import APIRouter, Query

from partwise.errors import NotFoundError
from partwise.store.catalog import SHOWN_KINDS
from partwise.store.records import Role, ShapeFilter, ShapeOrder, ShapeState
from partwise.workspace.provenance import FailureCard, ProvenanceCard, provenance
from partwise_service.dependencies import Caller, CatalogDep, ScopedCollection, ScopedShape, WorkspaceDep
from partwise_service.schemas.base import MAX_ROW_ID, Page
from partwise_service.schemas.paging import anchor_of, cursor_of
from partwise_service.schemas.shapes import RankedShapes, RevisionOut, RevisionsOut, ShapeOut, ShapeRow

MAX_PAGE = 500
router = APIRouter(tags=["shapes"])

Limit = Annotated[int, Query(ge=1, le=MAX_PAGE, description="Rows of a page, at most.")]
After = Annotated[str | None, Query(max_length=80, description="`next` of the page before.")]
Id = Annotated[int | None, Query(ge=0, le=MAX_ROW_ID)]
ScoreName = Annotated[str | None, Query(pattern="^[a-z_]{1,64}$", description="A score's name; by id without one.")]


@router.get("/collections/{collection_id}/shapes")
def list_shapes(
    collection: ScopedCollection,
    catalog: CatalogDep,
    after: After = None,
    limit: Limit = 100,
    state: ShapeState | None = None,
    part: Id = None,
    cluster: Id = None,
    author: Id = None,
    failed_stage: Annotated[str | None, Query(pattern="^[a-z_]{1,64}$")] = None,
    order: ScoreName = None,
    descending: bool = False,
) -> Page[ShapeRow]:
    """A page of the table: shapes that meet every filter given, in order of a score or of their ids.

    In an order by score, shapes that have no such score are left out.
    """
    rows = catalog.list_shapes(
        collection.id,
        where=ShapeFilter(state, part, cluster, author, failed_stage),
        order=ShapeOrder(order, descending),
        after=anchor_of(after),
        limit=limit,
    )
    has_more = len(rows) == limit
    return Page(items=[ShapeRow.of(row) for row in rows], next=cursor_of(rows[-1].anchor) if has_more else None)


@router.get("/collections/{collection_id}/shapes/ranked")
def jump_to_rank(
    collection: ScopedCollection,
    catalog: CatalogDep,
    first_rank: Annotated[int, Query(ge=0, le=MAX_ROW_ID)] = 0,
    limit: Limit = 100,
    order: ScoreName = None,
    descending: bool = False,
) -> RankedShapes:
    """Shapes from a rank on, in an order that is made anew from time to time: for scrollbars."""
    ordering = catalog.ordering(collection.id, order)
    if ordering is None:
        raise NotFoundError(f"the order by {order or 'id'} has not been made yet; page through /shapes meanwhile")
    ids = catalog.ordered_shapes(ordering.id, first_rank, limit, descending=descending)
    rows = catalog.listed_shapes(ids, order)
    return RankedShapes(
        n_shapes=ordering.n_shapes,
        built_at=ordering.built_at,
        items=[ShapeRow.of(rows[shape_id]) for shape_id in ids if shape_id in rows],
    )


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
