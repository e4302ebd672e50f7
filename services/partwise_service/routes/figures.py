"""/collections/{collection_id}/models, /embedding: what the machine made."""

from typing import Annotated

import numpy as np
from fastapi import APIRouter, Query

from partwise.workspace.embedding_map import embedding_key
from partwise_service.answering import AnswerRoute, waits_for_arrays
from partwise_service.dependencies import CatalogDep, ScopedCollection, ServiceDep
from partwise_service.schemas.base import MAX_ROW_ID
from partwise_service.schemas.figures import EmbeddingPage, ModelOut, ModelsPage

MAX_PAGE = 500
MAX_POINTS = 20_000
router = APIRouter(prefix="/collections/{collection_id}", route_class=AnswerRoute, tags=["figures"])


@router.get("/models")
def list_models(
    collection: ScopedCollection,
    catalog: CatalogDep,
    before: Annotated[int | None, Query(ge=1, le=MAX_ROW_ID, description="`next` of the page before.")] = None,
    limit: Annotated[int, Query(ge=1, le=MAX_PAGE)] = 100,
) -> ModelsPage:
    """A page of the collection's models, newest first."""
    found = catalog.models(collection.id, before=before, limit=limit)
    next_before = str(found[-1].version) if len(found) == limit else None
    return ModelsPage(items=[ModelOut.of(model) for model in found], next=next_before)


@router.get("/embedding")
@waits_for_arrays
def show_embedding(
    collection: ScopedCollection,
    open_service: ServiceDep,
    after: Annotated[int, Query(ge=0, le=MAX_ROW_ID, description="`next` of the page before.")] = 0,
    limit: Annotated[int, Query(ge=1, le=MAX_POINTS)] = 5_000,
) -> EmbeddingPage:
    """A page of the map of the collection: where every embedded shape lies, and its cluster."""
    workspace = open_service.workspace
    drawn = open_service.maps.get(workspace, embedding_key(workspace, collection))
    start = int(np.searchsorted(drawn.shape_ids, after, side="right"))
    ids = drawn.shape_ids[start : start + limit].tolist()
    points = drawn.points[start : start + limit]
    clusters, states = workspace.catalog.clusters(ids), workspace.catalog.shape_states(ids)
    first_ids = {first.shape_id for first in workspace.catalog.first_shapes(collection.id)}
    return EmbeddingPage(
        embedding=drawn.key.rpartition("/")[2].partition(".")[0],
        n_shapes=len(drawn.shape_ids),
        shape_ids=ids,
        x=points[:, 0].tolist(),
        y=points[:, 1].tolist(),
        clusters=[clusters.get(shape_id) for shape_id in ids],
        states=[states[shape_id] for shape_id in ids],
        first_shape_ids=[shape_id for shape_id in ids if shape_id in first_ids],
        next=str(ids[-1]) if start + limit < len(drawn.shape_ids) else None,
    )
