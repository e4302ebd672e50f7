"""/collections: what one may see, and what operators make and set."""

from fastapi import APIRouter

from partwise.workspace.settings import change_settings
from partwise_service.answering import AnswerRoute
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

router = APIRouter(prefix="/collections", route_class=AnswerRoute, tags=["collections"])


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
    changed = change_settings(workspace, collection, given)
    workspace.catalog.append_audit(caller.name, "set", f"collection {collection.id}", given)
    return CollectionOut.of(changed)
