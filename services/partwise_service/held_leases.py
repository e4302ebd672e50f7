"""Leases as callers see them: with the shape and the draft to go on with."""

from collections.abc import Sequence

from partwise.store.catalog import Catalog
from partwise.store.records import Lease
from partwise_service.ownership import visible_row
from partwise_service.schemas.queue import LeaseOut
from partwise_service.security.identity import Identity


def leases_out(catalog: Catalog, leases: Sequence[Lease], caller: Identity) -> list[LeaseOut]:
    """The leases in their order, with the caller's own open drafts."""
    found = catalog.leased_shapes([lease.id for lease in leases])
    return [LeaseOut.of(found[lease.id], caller.person_id) for lease in leases]


def visible_lease(catalog: Catalog, caller: Identity, lease_id: int) -> Lease:
    """The lease of this id if it is the caller's, or the caller is an operator of its collection.

    Raises
    ------
    NotFoundError : it is not there, or not for them.
    """
    return visible_row(caller, lambda: catalog.lease(lease_id), f"there is no lease {lease_id} of yours; see /leases")
