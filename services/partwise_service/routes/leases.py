"""/leases: what people hold, and how that is renewed and ends."""

from typing import Annotated

from fastapi import APIRouter, Query

from partwise.errors import ConflictError
from partwise.workspace.confirming import confirm
from partwise_service.answering import AnswerRoute
from partwise_service.dependencies import (
    Annotator,
    CatalogDep,
    Operator,
    ScopedCollection,
    ServiceDep,
    WorkspaceDep,
)
from partwise_service.held_leases import leases_out, visible_lease
from partwise_service.problems import ProblemError, ProblemKind
from partwise_service.schemas.base import MAX_ROW_ID, Page, RowId
from partwise_service.schemas.drafts import Confirm, Confirmed
from partwise_service.schemas.queue import LeaseOut, LeasesOut, Renewal, Skip

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


@router.post("/leases/{lease_id}/heartbeat")
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
        outcome = catalog.lease(lease_id).outcome
        raise ProblemError(ProblemKind.CONFLICT, str(error), {"outcome": outcome and outcome.value}) from error
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


@router.post("/leases/{lease_id}/complete")
def complete_lease(caller: Annotator, workspace: WorkspaceDep, lease_id: RowId, confirming: Confirm) -> Confirmed:
    """Confirm the caller's last draft of the leased shape, which ends the lease: see /drafts/{draft_id}/confirm."""
    lease = visible_lease(workspace.catalog, caller, lease_id)
    drafts = workspace.catalog.drafts_of_shape(lease.shape_id)
    own = [draft for draft in drafts if draft.person_id == caller.person_id]
    if not own:
        raise ConflictError(f"a lease is completed by confirming a draft but lease {lease_id} has none; open one first")
    done = confirm(workspace, own[-1].id, caller.person_id, confirming.n_strokes, confirming.labels_sha256)
    return Confirmed.of(done)


@router.post("/leases/{lease_id}/clear")
def clear_lease(caller: Operator, catalog: CatalogDep, lease_id: RowId) -> LeaseOut:
    """Take a shape from whoever holds it, which goes on the audit trail; their draft stays."""
    visible_lease(catalog, caller, lease_id)
    return leases_out(catalog, [catalog.clear_lease(lease_id, caller.person_id)], caller)[0]
