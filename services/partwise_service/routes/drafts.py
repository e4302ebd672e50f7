"""/drafts: work in progress. A stroke is acknowledged once it is committed, and is on record once."""

from collections.abc import Sequence
from typing import Annotated

import numpy as np
from fastapi import APIRouter, Header, Query, Request, Response

from partwise.errors import NotFoundError, ParameterError, StaleDraftError
from partwise.labels.operations import Paint, check_on_mesh
from partwise.labels.stroke_json import stroke_from_document
from partwise.labels.strokes import Stroke
from partwise.store.catalog import Catalog
from partwise.store.records import Draft
from partwise.workspace.confirming import DraftWork, begin_draft, confirm_labels, draft_work, work_to_confirm
from partwise.workspace.labelling import keep_mesh
from partwise_service.answering import AnswerRoute, json_answer, waits_for_arrays
from partwise_service.array_responses import SAFETENSORS_RESPONSES, entity_tag, not_modified, safetensors_response
from partwise_service.dependencies import Annotator, CatalogDep, ScopedShape, ServiceDep, WorkspaceDep
from partwise_service.held_leases import visible_lease
from partwise_service.ownership import visible_row
from partwise_service.problems import ProblemError, ProblemKind
from partwise_service.response_headers import OF_DRAFT
from partwise_service.schemas.base import RowId
from partwise_service.schemas.drafts import (
    MAX_SEQUENCE,
    Acknowledgement,
    Confirmed,
    ConfirmLabels,
    DraftOut,
    DraftsOut,
    DraftState,
    NewDraftRequest,
    RefusedStrokes,
    StaleDraft,
    StaleState,
    StrokeOut,
    Strokes,
    StrokesOut,
)
from partwise_service.schemas.strokes import MAX_SEEDS
from partwise_service.security.identity import Identity
from partwise_service.waiting import with_draft_labels

MAX_PAGE = 5_000
_TAIL = 1_000
"""Strokes of the server's side in a refusal; a client that is further behind pages through the log."""
MAX_STROKES_OF_DRAFT = 100_000
router = APIRouter(route_class=AnswerRoute, tags=["drafts"])
IfMatch = Annotated[
    str, Header(pattern=r'^(W/)?"[0-9]{1,9}"$', description="The draft's ETag: how many strokes the caller knows of.")
]


@router.post("/leases/{lease_id}/draft", responses=OF_DRAFT)
@waits_for_arrays
def open_draft(
    caller: Annotator, workspace: WorkspaceDep, response: Response, lease_id: RowId, new: NewDraftRequest
) -> DraftOut:
    """The caller's open draft of the leased shape, as it was left, or a new one."""
    lease = visible_lease(workspace.catalog, caller, lease_id)
    draft = begin_draft(workspace, lease, caller.person_id, new.base_revision)
    # a remesh cannot be repeated to the bit, so a mesh that strokes are on must outlive it
    keep_mesh(workspace, workspace.catalog.mesh(draft.shape_id, draft.mesh_hash))
    return _tagged(response, draft)


@router.get("/drafts")
def list_my_drafts(caller: Annotator, catalog: CatalogDep) -> DraftsOut:
    """The caller's open drafts, oldest first, whether or not they still hold the shapes."""
    found = [draft for draft in catalog.open_drafts(caller.person_id) if caller.may_see(draft.collection_id)]
    return DraftsOut(items=[DraftOut.of(draft) for draft in found])


@router.get("/shapes/{shape_id}/draft", responses=OF_DRAFT)
def show_last_draft(caller: Annotator, shape: ScopedShape, catalog: CatalogDep, response: Response) -> DraftOut:
    """The caller's last draft of a shape, open or not."""
    own = [draft for draft in catalog.drafts_of_shape(shape.id) if draft.person_id == caller.person_id]
    if not own:
        raise NotFoundError(f"you have no draft of shape {shape.id}; open one with a lease of it")
    return _tagged(response, own[-1])


@router.get("/drafts/{draft_id}", responses=OF_DRAFT)
def show_draft(caller: Annotator, catalog: CatalogDep, response: Response, draft_id: RowId) -> DraftOut:
    """A draft of the caller's own, or of anybody's for operators."""
    return _tagged(response, visible_draft(catalog, caller, draft_id))


@router.get("/drafts/{draft_id}/strokes", responses=OF_DRAFT)
def list_strokes(
    caller: Annotator,
    catalog: CatalogDep,
    response: Response,
    draft_id: RowId,
    after: Annotated[int, Query(ge=-1, le=MAX_SEQUENCE, description="Strokes with a higher sequence.")] = -1,
    limit: Annotated[int, Query(ge=1, le=MAX_PAGE)] = 1_000,
) -> StrokesOut:
    """A page of the log, by sequence."""
    draft = visible_draft(catalog, caller, draft_id)
    found = catalog.strokes(draft.id, after=after, limit=limit)
    last = found[-1].sequence if found else after
    return StrokesOut(
        draft=_tagged(response, draft),
        items=[StrokeOut.of(stroke) for stroke in found],
        next=last if found and last + 1 < draft.n_strokes else None,
    )


@router.get("/drafts/{draft_id}/labels", response_class=Response, responses=SAFETENSORS_RESPONSES)
async def get_draft_labels(request: Request, caller: Annotator, service: ServiceDep, draft_id: RowId) -> Response:
    """`labels` (m,) uint16 that the strokes leave, and `base` (m,) uint16 that they start from."""

    def read() -> DraftWork | Response:
        draft = visible_draft(service.workspace.catalog, caller, draft_id)
        return not_modified(request, _labels_tag(draft)) or draft_work(service.workspace, draft)

    def answer(work: DraftWork, labels: np.ndarray) -> Response:
        about = {"mesh_hash": work.draft.mesh_hash, "n_strokes": str(work.draft.n_strokes)}
        arrays = {"labels": labels, "base": work.base_labels}
        return safetensors_response(request, arrays, _labels_tag(work.draft), metadata=about)

    return await with_draft_labels(request, service, caller.person_id, read, answer)


@router.post("/drafts/{draft_id}/strokes", responses=OF_DRAFT | {409: {"model": RefusedStrokes}})
def append_strokes(
    caller: Annotator, service: ServiceDep, response: Response, draft_id: RowId, sent: Strokes
) -> DraftOut:
    """Commit strokes. Safe to send again: those on record are passed over. The answer comes after the commit.

    409 if the draft went on elsewhere: the problem's `state` is the draft's, `recorded` the log from the expected
    sequence on, and `refused` what was sent, so that the client has both sides.
    """
    known = visible_row(caller, lambda: service.known_draft(draft_id), _missing(draft_id))
    catalog = service.workspace.catalog
    strokes = [stroke_from_document(document) for document in sent.strokes]
    _refuse_too_much(sent.expected_sequence, strokes)
    for stroke in strokes:
        check_on_mesh(stroke.operation, known.n_faces)
    try:
        return _tagged(response, catalog.append_strokes(draft_id, caller.person_id, sent.expected_sequence, strokes))
    except StaleDraftError as error:
        sides = _on_record(catalog, error, sent.expected_sequence)
        told = RefusedStrokes(state=sides.state, recorded=sides.recorded, refused=sent.strokes)
        raise _conflict(error, told) from error


@router.post("/drafts/{draft_id}/confirm", response_model=Confirmed, responses={409: {"model": StaleDraft}})
async def confirm_draft(
    request: Request,
    caller: Annotator,
    service: ServiceDep,
    draft_id: RowId,
    if_match: IfMatch,
    confirming: ConfirmLabels,
) -> Response:
    """Make the strokes labels for good. `If-Match` must be the draft's ETag; 409 with its state if it went on."""
    workspace, n_strokes = service.workspace, int(if_match.removeprefix("W/").strip('"'))

    def read() -> DraftWork:
        return work_to_confirm(workspace, visible_draft(workspace.catalog, caller, draft_id))

    def answer(work: DraftWork, labels: np.ndarray) -> Response:
        try:
            done = confirm_labels(workspace, work, labels, caller.person_id, n_strokes, confirming.labels_sha256)
        except StaleDraftError as error:
            raise stale_problem(workspace.catalog, error, n_strokes) from error
        return json_answer(Confirmed.of(done))

    return await with_draft_labels(request, service, caller.person_id, read, answer)


@router.post("/drafts/{draft_id}/acknowledge", responses=OF_DRAFT | {409: {"model": StaleState}})
def acknowledge_labels(
    caller: Annotator, catalog: CatalogDep, response: Response, draft_id: RowId, seen: Acknowledgement
) -> DraftOut:
    """The caller has seen labels that others confirmed meanwhile, and means to confirm over them."""
    draft = visible_draft(catalog, caller, draft_id)
    try:
        return _tagged(response, catalog.acknowledge_head(draft.id, caller.person_id, seen.revision_id))
    except StaleDraftError as error:
        raise _conflict(error, StaleState(state=_state(error))) from error


@router.post("/drafts/{draft_id}/discard", responses=OF_DRAFT)
def discard_draft(caller: Annotator, catalog: CatalogDep, response: Response, draft_id: RowId) -> DraftOut:
    """Close a draft without labels; its strokes stay on record."""
    draft = visible_draft(catalog, caller, draft_id)
    return _tagged(response, catalog.discard_draft(draft.id, caller.person_id))


def visible_draft(catalog: Catalog, caller: Identity, draft_id: int) -> Draft:
    """The draft of this id if it is the caller's, or the caller is an operator of its collection.

    Raises
    ------
    NotFoundError : it is not there, or not for them.
    """
    return visible_row(caller, lambda: catalog.draft(draft_id), _missing(draft_id))


def _refuse_too_much(expected_sequence: int, strokes: Sequence[Stroke]) -> None:
    """Limits far beyond what hands do: replaying what is on record must come to an end."""
    n_strokes = expected_sequence + len(strokes)
    if n_strokes > MAX_STROKES_OF_DRAFT:
        raise ParameterError(
            f"a draft may have {MAX_STROKES_OF_DRAFT:,} strokes but this would make {n_strokes:,}; confirm it first"
        )
    for stroke in strokes:
        if isinstance(stroke.operation, Paint) and len(stroke.operation.seeds) > MAX_SEEDS:
            raise ParameterError(
                f"a stroke may have {MAX_SEEDS:,} seeds but one has {len(stroke.operation.seeds):,}; send it as several"
            )


def _labels_tag(draft: Draft) -> str:
    return entity_tag("draft", draft.id, draft.n_strokes)


def _missing(draft_id: int) -> str:
    return f"there is no draft {draft_id} of yours; see /drafts"


def _tagged(response: Response, draft: Draft) -> DraftOut:
    response.headers["ETag"] = f'"{draft.n_strokes}"'
    return DraftOut.of(draft)


def stale_problem(catalog: Catalog, error: StaleDraftError, known_to_caller: int) -> ProblemError:
    """The refusal with what is on record; the caller knows of so many strokes."""
    return _conflict(error, _on_record(catalog, error, known_to_caller))


def _on_record(catalog: Catalog, error: StaleDraftError, known_to_caller: int) -> StaleDraft:
    tail = catalog.strokes(error.state["draft_id"], after=known_to_caller - 1, limit=_TAIL)
    return StaleDraft(state=_state(error), recorded=[StrokeOut.of(stroke) for stroke in tail])


def _state(error: StaleDraftError) -> DraftState:
    return DraftState(**error.state)


def _conflict(error: StaleDraftError, told: StaleState) -> ProblemError:
    return ProblemError(ProblemKind.CONFLICT, str(error), told.model_dump(mode="json"))
