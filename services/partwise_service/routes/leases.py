"""/leases: what people hold, and how that is renewed and ends."""

from typing import Annotated

import numpy as np
from fastapi import APIRouter, Query, Request, Response

from partwise.errors import ConflictError, StaleDraftError
from partwise.store.catalog import Catalog
from partwise.store.records import Draft
from partwise.workspace.confirming import DraftWork, confirm_labels, work_to_confirm
from partwise_service.answering import AnswerRoute, json_answer
from partwise_service.dependencies import (
    Annotator,
    CatalogDep,
    Operator,
    ScopedCollection,
    ServiceDep,
)
from partwise_service.held_leases import leases_out, visible_lease
from partwise_service.problems import ProblemError, ProblemKind
from partwise_service.routes.drafts import stale_problem
from partwise_service.schemas.base import MAX_ROW_ID, Page, RowId
from partwise_service.schemas.drafts import Confirm, Confirmed, StaleDraft
from partwise_service.schemas.queue import EndedLease, LeaseOut, LeasesOut, Renewal, Skip
from partwise_service.security.identity import Identity
from partwise_service.waiting import with_draft_labels

MAX_PAGE = 500
router = APIRouter(route_class=AnswerRoute, tags=["leases"])


@router.get("/leases")
def list_my_leases(caller: Annotator, catalog: CatalogDep) -> LeasesOut:
    """What the caller holds, oldest first: the same after a reload. Expired ones too, unless others took them."""
    held = [each for each in catalog.leased_by(caller.person_id) if caller.may_see(each.lease.collection_id)]
    return LeasesOut(items=[LeaseOut.of(each, caller.person_id) for each in held])


@router.get("/collections/{collection_id}/leases")
def list_leases(
    caller: Operator,
    collection: ScopedCollection,
    catalog: CatalogDep,
    after: Annotated[int, Query(ge=0, le=MAX_ROW_ID)] = 0,
    limit: Annotated[int, Query(ge=1, le=MAX_PAGE)] = 100,
) -> Page[LeaseOut]:
    """Who holds what in a collection, by id."""
    found = catalog.active_leases(collection.id, after=after, limit=limit)
    next_after = str(found[-1].id) if len(found) == limit else None
    return Page(items=leases_out(catalog, found, caller), next=next_after)


@router.post("/leases/{lease_id}/heartbeat", responses={409: {"model": EndedLease}})
def renew_lease(
    caller: Annotator, service: ServiceDep, catalog: CatalogDep, lease_id: RowId, renewal: Renewal
) -> LeaseOut:
    """Hold the shape for longer. 409 if it has ended: then others may have it, and the draft is still there.

    The problem's `outcome` tells how: whoever finds it `cleared` leaves the shape, rather than claiming it anew.
    """
    visible_lease(catalog, caller, lease_id)
    try:
        renewed = catalog.renew_lease(
            lease_id, caller.person_id, service.settings.lease_s, is_prefetched=renewal.is_prefetched
        )
    except ConflictError as error:
        ended = EndedLease(outcome=catalog.lease(lease_id).outcome)
        raise ProblemError(ProblemKind.CONFLICT, str(error), ended.model_dump(mode="json")) from error
    return leases_out(catalog, [renewed], caller)[0]


@router.post("/leases/{lease_id}/release")
def release_lease(caller: Annotator, catalog: CatalogDep, lease_id: RowId) -> LeaseOut:
    """Give the shape back to the queue; the draft stays. As it is if it has ended already."""
    visible_lease(catalog, caller, lease_id)
    return leases_out(catalog, [catalog.release_lease(lease_id, caller.person_id)], caller)[0]


@router.post("/leases/{lease_id}/skip")
def skip_lease(caller: Annotator, catalog: CatalogDep, lease_id: RowId, skip: Skip) -> LeaseOut:
    """Give the shape back for good, saying why: the caller does not get it again from the queue."""
    visible_lease(catalog, caller, lease_id)
    return leases_out(catalog, [catalog.skip_lease(lease_id, caller.person_id, skip.reason)], caller)[0]


@router.post("/leases/{lease_id}/complete", response_model=Confirmed, responses={409: {"model": StaleDraft}})
async def complete_lease(
    request: Request, caller: Annotator, service: ServiceDep, lease_id: RowId, confirming: Confirm
) -> Response:
    """Confirm the caller's open draft of the leased shape, which ends the lease: see /drafts/{draft_id}/confirm.

    Again after that, it returns the same.
    """
    workspace, n_strokes, seen = service.workspace, confirming.n_strokes, confirming.labels_sha256

    def read() -> DraftWork:
        return work_to_confirm(workspace, _own_draft(workspace.catalog, caller, lease_id))

    def answer(work: DraftWork, labels: np.ndarray) -> Response:
        try:
            done = confirm_labels(workspace, work, labels, caller.person_id, n_strokes, seen)
        except StaleDraftError as error:
            raise stale_problem(workspace.catalog, error, n_strokes) from error
        return json_answer(Confirmed.of(done))

    return await with_draft_labels(request, service, caller.person_id, read, answer)


@router.post("/leases/{lease_id}/clear")
def clear_lease(caller: Operator, catalog: CatalogDep, lease_id: RowId) -> LeaseOut:
    """Take a shape from whoever holds it, which goes on the audit trail; their draft stays."""
    visible_lease(catalog, caller, lease_id)
    return leases_out(catalog, [catalog.clear_lease(lease_id, caller.person_id)], caller)[0]


def _own_draft(catalog: Catalog, caller: Identity, lease_id: int) -> Draft:
    """What completing the lease confirms: the caller's open draft, or once it has ended the last one under it."""
    lease = visible_lease(catalog, caller, lease_id)
    drafts = [draft for draft in catalog.drafts_of_shape(lease.shape_id) if draft.person_id == caller.person_id]
    own = [draft for draft in drafts if (draft.slot, draft.round) == (lease.slot, lease.round)]
    if not own or (lease.outcome is None and own[-1].outcome is not None):
        raise ConflictError(
            f"a lease is completed by confirming a draft but lease {lease_id} has none that is open; open one first"
        )
    return own[-1]
