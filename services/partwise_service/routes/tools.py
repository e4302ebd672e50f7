"""/shapes/{shape_id}/patches, /refine-boundaries, /refine-model: tools whose result is one undoable step.

They run in processes of their own (`partwise_service.tool_pool`); these handlers only wait, on the event loop.
"""

from dataclasses import replace
from typing import Annotated, Any

from anyio.to_thread import run_sync
from fastapi import APIRouter, Depends, Request, Response
from fastapi.responses import JSONResponse

from partwise.errors import NotFoundError
from partwise.segmentation.parameters import BOUNDARY_PRESETS
from partwise.store.records import Mesh, Shape
from partwise.workspace.confirming import DraftWork, draft_work
from partwise.workspace.segmentations import DESCRIBE, EVALUATE
from partwise.workspace.shapes import shape_mesh
from partwise.workspace.workspace import Workspace
from partwise_service.answering import AnswerRoute, waits_for_arrays
from partwise_service.array_responses import SAFETENSORS, entity_tag, safetensors_response
from partwise_service.dependencies import Annotator, ScopedShape, ServiceDep, WorkspaceDep
from partwise_service.problems import ProblemError, ProblemKind
from partwise_service.routes.drafts import visible_draft
from partwise_service.schemas.tools import (
    BoundariesRequest,
    LabelRuns,
    ModelRequest,
    PatchesRequest,
    labels_of_runs,
    runs_of_labels,
)
from partwise_service.security.identity import Identity
from partwise_service.tool_calls import (
    BoundariesCall,
    DraftLog,
    GivenLabels,
    ModelCall,
    PatchesCall,
    StoredRow,
    ToolCall,
)
from partwise_service.tool_pool import ToolPool
from partwise_service.waiting import unless_gone

router = APIRouter(route_class=AnswerRoute, tags=["tools"])
TOOL_RESPONSES: dict[int | str, dict[str, Any]] = {
    200: {
        "model": LabelRuns,
        "description": "As runs to who accepts application/json only; `labels` (m,) as safetensors to all others.",
        "content": {SAFETENSORS: {"schema": {"type": "string", "format": "binary"}}},
    }
}


def patches_call(_caller: Annotator, shape: ScopedShape, workspace: WorkspaceDep, wish: PatchesRequest) -> PatchesCall:
    """What the tool is asked; reads the catalog, so it runs on a thread."""
    mesh = shape_mesh(workspace, shape)
    return PatchesCall(mesh, _row_on(workspace, shape, mesh, DESCRIBE), wish.method, wish.n_patches)


@waits_for_arrays
def boundaries_call(
    caller: Annotator, shape: ScopedShape, workspace: WorkspaceDep, wish: BoundariesRequest
) -> BoundariesCall:
    """As `patches_call`."""
    if (wish.runs is None) == (wish.draft_id is None):
        raise ProblemError(ProblemKind.INVALID, "Give either `runs` or `draft_id`, to say where to start.")
    if wish.anchor_n_strokes is not None and (wish.draft_id is None or wish.anchor_runs is not None):
        raise ProblemError(ProblemKind.INVALID, "`anchor_n_strokes` goes with `draft_id` and without `anchor_runs`.")
    work = None if wish.draft_id is None else _work(workspace, caller, shape, wish.draft_id)
    mesh = shape_mesh(workspace, shape) if work is None else workspace.catalog.mesh(shape.id, work.draft.mesh_hash)
    parameters = workspace.config.boundary if wish.preset is None else BOUNDARY_PRESETS[wish.preset]
    if wish.omega is not None:
        parameters = replace(parameters, angle_weight=wish.omega)
    anchor: GivenLabels | None = None
    if wish.anchor_runs is not None:
        anchor = labels_of_runs(wish.anchor_runs, mesh.n_faces)
    elif wish.anchor_n_strokes is not None and work is not None:
        anchor = DraftLog(work.base_labels, work.log.prefix(wish.anchor_n_strokes))
    start: GivenLabels = DraftLog(work.base_labels, work.log) if work else labels_of_runs(wish.runs or [], mesh.n_faces)
    return BoundariesCall(mesh, _row_on(workspace, shape, mesh, DESCRIBE), start, anchor, parameters)


def model_call(_caller: Annotator, shape: ScopedShape, workspace: WorkspaceDep, wish: ModelRequest) -> ModelCall:
    """As `patches_call`."""
    mesh = shape_mesh(workspace, shape)
    run = workspace.catalog.stage_runs([shape.id], EVALUATE).get(shape.id)
    row = _row_on(workspace, shape, mesh, EVALUATE)
    if run is None or row is None:
        raise NotFoundError(f"shape {shape.id} has no probabilities on its present mesh; a model must see it first")
    smoothness = wish.smoothness
    if smoothness is None:
        recipe = workspace.catalog.model(shape.collection_id, run.summary["model_version"]).recipe
        smoothness = recipe.get("smoothness", workspace.config.refine.smoothness)
    return ModelCall(mesh, row, replace(workspace.config.refine, smoothness=smoothness))


@router.post("/shapes/{shape_id}/patches", responses=TOOL_RESPONSES, response_model=None)
async def cut_patches(
    request: Request, caller: Annotator, service: ServiceDep, call: Annotated[PatchesCall, Depends(patches_call)]
) -> Response:
    """An over-segmentation: the patch of each face, from 0."""
    return await _answer(request, service.tools, call, caller.person_id)


@router.post("/shapes/{shape_id}/refine-boundaries", responses=TOOL_RESPONSES, response_model=None)
async def refine_boundaries(
    request: Request, caller: Annotator, service: ServiceDep, call: Annotated[BoundariesCall, Depends(boundaries_call)]
) -> Response:
    """Boundaries moved onto creases nearby, and unlabelled faces filled: a part's id for each face."""
    return await _answer(request, service.tools, call, caller.person_id)


@router.post("/shapes/{shape_id}/refine-model", responses=TOOL_RESPONSES, response_model=None)
async def refine_model(
    request: Request, caller: Annotator, service: ServiceDep, call: Annotated[ModelCall, Depends(model_call)]
) -> Response:
    """The newest model's word on the shape, cut along creases: a part's id for each face."""
    return await _answer(request, service.tools, call, caller.person_id)


async def _answer(request: Request, tools: ToolPool, call: ToolCall, person_id: int) -> Response:
    labels = await unless_gone(request, tools, call, person_id)
    mesh_hash = call.mesh.mesh_hash
    accepted = request.headers.get("accept", "")
    if "application/json" in accepted and SAFETENSORS not in accepted:
        runs = LabelRuns(mesh_hash=mesh_hash, n_faces=len(labels), runs=runs_of_labels(labels))
        return JSONResponse(runs.model_dump())
    tag = entity_tag("tool", labels.tobytes())
    about = {"mesh_hash": mesh_hash}
    return await run_sync(lambda: safetensors_response(request, {"labels": labels}, tag, "no-store", about))


def _work(workspace: Workspace, caller: Identity, shape: Shape, draft_id: int) -> DraftWork:
    draft = visible_draft(workspace.catalog, caller, draft_id)
    if draft.shape_id != shape.id:
        raise NotFoundError(f"there is no draft {draft_id} of shape {shape.id}; see /drafts")
    return draft_work(workspace, draft)


def _row_on(workspace: Workspace, shape: Shape, mesh: Mesh, stage: str) -> StoredRow | None:
    """Where a stage left its arrays of this mesh; None if it has none of it."""
    run = workspace.catalog.stage_runs([shape.id], stage).get(shape.id)
    if run is None or run.block_name is None or run.row is None or run.summary.get("mesh_hash") != mesh.mesh_hash:
        return None
    return StoredRow(run.block_name, run.row)
