"""/queue/claim and the queue of a collection: who gets which shape."""

from fastapi import APIRouter
from numpy.random import default_rng

from partwise.errors import ConflictError, NotFoundError
from partwise.store.records import Lease, NewClaim
from partwise_service.answering import AnswerRoute
from partwise_service.dependencies import (
    Annotator,
    CatalogDep,
    Operator,
    ScopedCollection,
    ScopedShape,
    ServiceDep,
    shapes_of,
    visible_collection,
    visible_shape,
)
from partwise_service.held_leases import leases_out
from partwise_service.schemas.queue import (
    Assigned,
    Assignment,
    Claim,
    Claimed,
    QueueDepthOut,
    RefusedClaim,
    Reopening,
)

router = APIRouter(route_class=AnswerRoute, tags=["queue"])


@router.post("/queue/claim")
def claim(caller: Annotator, service: ServiceDep, catalog: CatalogDep, wish: Claim) -> Claimed:
    """Take the next shape of a collection's queue, or up to four by name, for a time that heartbeats renew.

    While a shape is loaded ahead, the next claim takes that one. By name: 409 if none of them could be had.
    """
    collection = visible_collection(catalog, caller, wish.collection_id)
    lease_s = service.settings.lease_s
    taken: list[Lease] = []
    refused: list[RefusedClaim] = []
    if not wish.shape_ids:
        draw = float(default_rng().random())
        lease = catalog.claim_next(NewClaim(collection.id, caller.person_id, lease_s, draw, wish.is_prefetch))
        taken = [] if lease is None else [lease]
    for shape_id in dict.fromkeys(wish.shape_ids):
        if visible_shape(catalog, caller, shape_id).collection_id != collection.id:
            raise NotFoundError(f"there is no shape {shape_id} in collection {collection.id}")
    for shape_id in dict.fromkeys(wish.shape_ids):
        try:
            taken.append(catalog.claim_shape(shape_id, caller.person_id, lease_s))
        except ConflictError as error:
            refused.append(RefusedClaim(shape_id=shape_id, why=str(error)))
    if refused and not taken:
        raise ConflictError("; ".join(each.why for each in refused))
    return Claimed(items=leases_out(catalog, taken, caller), refused=refused)


@router.get("/collections/{collection_id}/queue")
def show_queue(
    _caller: Annotator, service: ServiceDep, collection: ScopedCollection, catalog: CatalogDep
) -> QueueDepthOut:
    """How much waits, counted at most every ten seconds."""
    return service.depths.get(collection.id, lambda: QueueDepthOut.of(catalog.queue_depth(collection.id)))


@router.post("/collections/{collection_id}/queue/assign")
def assign_shapes(
    caller: Operator, collection: ScopedCollection, catalog: CatalogDep, assignment: Assignment
) -> Assigned:
    """Keep shapes that wait for one person, or let anybody have them again."""
    shapes_of(catalog, collection, assignment.shape_ids)
    return Assigned(n_places=catalog.assign_shapes(assignment.shape_ids, assignment.person_id, caller.person_id))


@router.post("/shapes/{shape_id}/reopen", status_code=204)
def reopen_shape(caller: Operator, shape: ScopedShape, catalog: CatalogDep, reopening: Reopening) -> None:
    """Put a shape first in the queue for another round, whatever labels it has."""
    catalog.reopen_shape(shape.id, caller.person_id, for_person_id=reopening.for_person_id)
