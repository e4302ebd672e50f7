"""/collections: what one may see, and what operators make and set."""

from dataclasses import fields

from fastapi import APIRouter

from partwise.store.queue_settings import QueueSettings, queue_settings_of
from partwise.store.records import JobKind
from partwise.workspace.settings import change_settings
from partwise_service.dependencies import (
    Caller,
    CatalogDep,
    Operator,
    ScopedCollection,
    WorkspaceDep,
    require_all_scope,
)
from partwise_service.schemas.base import refuse_unprintable
from partwise_service.schemas.collections import CollectionOut, CollectionsOut, NewCollection, SettingsChange

QUEUE_SETTINGS = {each.name for each in fields(QueueSettings)}
router = APIRouter(prefix="/collections", tags=["collections"])


@router.get("")
def list_collections(caller: Caller, catalog: CatalogDep) -> CollectionsOut:
    """The collections one may see, by name."""
    visible = [each for each in catalog.list_collections() if caller.may_see(each.id)]
    return CollectionsOut(items=[CollectionOut.of(each) for each in visible])


@router.post("", status_code=201)
def create_collection(caller: Operator, catalog: CatalogDep, new: NewCollection) -> CollectionOut:
    """Make a collection with its parts, in the order annotators see them. For operators of all collections."""
    require_all_scope(caller)
    refuse_unprintable("a collection's name", new.name)
    made = catalog.create_collection(new.name, new.parts)
    catalog.append_audit(caller.name, "create collection", f"collection {made.id}", {"name": made.name})
    return CollectionOut.of(made)


@router.get("/{collection_id}")
def show_collection(collection: ScopedCollection) -> CollectionOut:
    """One collection."""
    return CollectionOut.of(collection)


@router.patch("/{collection_id}/settings")
def set_collection(
    caller: Operator, workspace: WorkspaceDep, collection: ScopedCollection, change: SettingsChange
) -> CollectionOut:
    """Change settings; what is left out stays. The queue follows `labels_per_shape` as soon as a worker is there."""
    given = change.model_dump(exclude_none=True)
    if not given:
        return CollectionOut.of(collection)
    of_queue = {name: given.pop(name) for name in QUEUE_SETTINGS & given.keys()}
    changed = change_settings(workspace, collection, given) if given else collection
    if of_queue:
        queue_settings_of({**collection.settings, **of_queue})  # raises for what does not fit
        changed = workspace.catalog.update_collection_settings(collection.id, of_queue)
    if "labels_per_shape" in of_queue:
        workspace.catalog.enqueue_job(collection.id, JobKind.REFILL)
    workspace.catalog.append_audit(caller.name, "set", f"collection {collection.id}", {**given, **of_queue})
    return CollectionOut.of(changed)
