"""/collections/{collection_id}/accept, /accepts, /queue/select: what leads decide about many shapes at a time."""

from typing import Annotated

from fastapi import APIRouter, Query
from numpy.random import default_rng

from partwise.store.catalog import Catalog
from partwise.store.records import Collection, Shape, ShapeState
from partwise.workspace.accepting import accept_in_bulk, settle_rechecks
from partwise.workspace.embedding_map import embedding_key, spread_out
from partwise.workspace.segmentations import Segmentation
from partwise_service.answering import AnswerRoute, waits_for_arrays
from partwise_service.dependencies import CatalogDep, Reviewer, ScopedCollection, ServiceDep, WorkspaceDep, shapes_of
from partwise_service.schemas.accepts import (
    Accept,
    AcceptBatchOut,
    AcceptedOut,
    RefusedOut,
    Selected,
    Selection,
)
from partwise_service.schemas.base import MAX_ROW_ID, Page

MAX_PAGE = 500
router = APIRouter(prefix="/collections/{collection_id}", route_class=AnswerRoute, tags=["accepts"])


@router.post("/accept")
@waits_for_arrays
def accept_labels(caller: Reviewer, workspace: WorkspaceDep, collection: ScopedCollection, wish: Accept) -> AcceptedOut:
    """Make a model's labels those of shapes that wait, each by itself: what is `refused` keeps none of the others.

    Some drawn at random are not accepted: they come first in the queue, where nobody is told of it. What people make of
    them says how many accepted ones are wrong, see `/accepts`.
    """
    shapes = shapes_of(workspace.catalog, collection, wish.shape_ids)
    report = accept_in_bulk(
        workspace,
        collection,
        shapes,
        Segmentation(wish.segmentation.value),
        caller.person_id,
        wish.recheck,
        default_rng(),
    )
    return AcceptedOut(
        batch_id=report.batch_id,
        accepted=list(report.accepted),
        refused=[RefusedOut.model_validate(each) for each in report.refused],
        rechecks=report.n_drawn,
    )


@router.get("/accepts")
@waits_for_arrays
def list_accepts(
    _caller: Reviewer,
    workspace: WorkspaceDep,
    collection: ScopedCollection,
    before: Annotated[int, Query(ge=1, le=MAX_ROW_ID, description="`next` of the page before.")] = MAX_ROW_ID,
    limit: Annotated[int, Query(ge=1, le=MAX_PAGE)] = 100,
) -> Page[AcceptBatchOut]:
    """What was accepted in bulk, newest first, with the share of it that is wrong as far as people have checked."""
    settle_rechecks(workspace, collection.id)
    found = workspace.catalog.accept_batches(collection.id, before=before, limit=limit)
    next_before = str(found[-1].id) if len(found) == limit else None
    return Page(items=[AcceptBatchOut.of(batch) for batch in found], next=next_before)


@router.post("/queue/select")
@waits_for_arrays
def select_first(
    caller: Reviewer, service: ServiceDep, collection: ScopedCollection, catalog: CatalogDep, wish: Selection
) -> Selected:
    """Have shapes handed out before all others, such as those picked on the map; no new model changes that."""
    waiting = _waiting(catalog, collection, wish.shape_ids)
    if wish.k is not None and len(waiting) > wish.k:
        workspace = service.workspace
        waiting = spread_out(service.maps.get(workspace, embedding_key(workspace, collection)), waiting, wish.k)
    return Selected(shape_ids=list(catalog.put_first(collection.id, waiting, caller.person_id)))


def _waiting(catalog: Catalog, collection: Collection, shape_ids: list[int]) -> list[int]:
    shapes: list[Shape] = shapes_of(catalog, collection, shape_ids)
    states = catalog.shape_states([shape.id for shape in shapes])
    return [shape.id for shape in shapes if states[shape.id] is ShapeState.READY]
