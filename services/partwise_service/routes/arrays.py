"""/meshes/{mesh_hash}, /shapes/{shape_id}/labels, /shapes/{shape_id}/thumbnail: what browsers draw."""

from typing import Annotated

from fastapi import APIRouter, Query, Request, Response

from partwise.errors import NotFoundError
from partwise.store.meshes import mesh_arrays
from partwise.workspace.choices import Segmentation
from partwise.workspace.shapes import load_mesh
from partwise_service.answering import AnswerRoute, waits_for_arrays
from partwise_service.array_responses import (
    IMMUTABLE,
    PNG_RESPONSES,
    SAFETENSORS_RESPONSES,
    entity_tag,
    not_modified,
    safetensors_response,
)
from partwise_service.dependencies import Caller, ScopedShape, WorkspaceDep, visible_shape
from partwise_service.face_uncertainty import find_uncertainty
from partwise_service.schemas.base import MAX_ROW_ID, Hash
from partwise_service.shown_labels import labels_of_revision, shown_labels
from partwise_service.thumbnails import thumbnail_response

router = APIRouter(route_class=AnswerRoute, tags=["arrays"])
ShapeQuery = Annotated[int, Query(ge=1, le=MAX_ROW_ID, description="A shape that has or had the mesh.")]


@router.get("/meshes/{mesh_hash}", response_class=Response, responses=SAFETENSORS_RESPONSES)
@waits_for_arrays
def get_mesh(
    request: Request, caller: Caller, workspace: WorkspaceDep, mesh_hash: Hash, shape_id: ShapeQuery
) -> Response:
    """`vertices` (n, 3) float32 and `faces` (m, 3) uint32, in the order that labels follow. Never changes."""
    visible_shape(workspace.catalog, caller, shape_id)
    mesh = workspace.catalog.mesh(shape_id, mesh_hash)
    tag = entity_tag("mesh", mesh_hash)
    held = not_modified(request, tag, IMMUTABLE)
    if held is not None:
        return held
    return safetensors_response(request, mesh_arrays(load_mesh(workspace, mesh)), tag, IMMUTABLE)


@router.get("/shapes/{shape_id}/labels", response_class=Response, responses=SAFETENSORS_RESPONSES)
@waits_for_arrays
def get_labels(
    request: Request,
    shape: ScopedShape,
    workspace: WorkspaceDep,
    segmentation: Segmentation = Segmentation.CONFIRMED,
    revision: Annotated[int | None, Query(ge=1, le=MAX_ROW_ID, description="Instead: this revision's.")] = None,
) -> Response:
    """`labels` (m,) uint16: a part's id for each face of the mesh that the metadata names, 0 for none."""
    found = (
        shown_labels(workspace, shape, segmentation)
        if revision is None
        else labels_of_revision(workspace, shape, revision)
    )
    if found is None:
        raise NotFoundError(f"shape {shape.id} has no {segmentation.value} labels on its present mesh")
    tag = entity_tag("labels", found.identity)
    held = not_modified(request, tag)
    return held or safetensors_response(request, {"labels": found.read()}, tag, metadata=found.metadata)


@router.get("/shapes/{shape_id}/uncertainty", response_class=Response, responses=SAFETENSORS_RESPONSES)
@waits_for_arrays
def get_uncertainty(request: Request, shape: ScopedShape, workspace: WorkspaceDep) -> Response:
    """`uncertainty` (m,) float32: how unsure the newest model is of each face, from 0 (sure) to 1 (all parts alike)."""
    found = find_uncertainty(workspace, shape)
    if found is None:
        raise NotFoundError(f"shape {shape.id} has no probabilities on its present mesh; a model must see it first")
    tag = entity_tag("uncertainty", found.identity)
    held = not_modified(request, tag)
    return held or safetensors_response(request, {"uncertainty": found.read()}, tag, metadata=found.metadata)


@router.get("/shapes/{shape_id}/thumbnail", response_class=Response, responses=PNG_RESPONSES)
@waits_for_arrays
def get_thumbnail(
    request: Request,
    shape: ScopedShape,
    workspace: WorkspaceDep,
    segmentation: Annotated[Segmentation | None, Query(description="Grey without one, or where there is none.")] = None,
) -> Response:
    """PNG of the shape in the colours of its labels, on a transparent background."""
    labels = None if segmentation is None else shown_labels(workspace, shape, segmentation)
    return thumbnail_response(request, workspace, shape, labels)
