"""/collections/{collection_id}/parts: the part schema and its versions."""

from typing import Annotated

from fastapi import APIRouter, Query

from partwise_service.answering import AnswerRoute
from partwise_service.dependencies import CatalogDep, Reviewer, ScopedCollection
from partwise_service.schemas.base import MAX_ROW_ID, RowId
from partwise_service.schemas.collections import NewPart, PartChange, PartsOut

router = APIRouter(prefix="/collections/{collection_id}/parts", route_class=AnswerRoute, tags=["parts"])


@router.get("")
def show_parts(
    collection: ScopedCollection,
    catalog: CatalogDep,
    version: Annotated[int | None, Query(ge=1, le=MAX_ROW_ID, description="The current one unless given.")] = None,
) -> PartsOut:
    """The parts that faces may be labelled with, in the order annotators see them."""
    return PartsOut.of(catalog.parts(collection.id, version))


@router.post("", status_code=201)
def add_part(caller: Reviewer, collection: ScopedCollection, catalog: CatalogDep, new: NewPart) -> PartsOut:
    """Add a part, which makes the next version of the schema."""
    schema = catalog.add_part(collection.id, new.name, new.colour, new.gloss, new.parent_id)
    catalog.append_audit(caller.name, "add part", f"collection {collection.id}", new.model_dump())
    return PartsOut.of(schema)


@router.patch("/{part_id}")
def change_part(
    caller: Reviewer, collection: ScopedCollection, part_id: RowId, catalog: CatalogDep, change: PartChange
) -> PartsOut:
    """Rename, recolour or explain a part, or put it below another. The version stays."""
    given = change.model_dump(exclude_none=True)
    schema = catalog.update_part(collection.id, part_id, **given)
    catalog.append_audit(caller.name, "change part", f"part {collection.id}/{part_id}", given)
    return PartsOut.of(schema)


@router.delete("/{part_id}")
def remove_part(caller: Reviewer, collection: ScopedCollection, part_id: RowId, catalog: CatalogDep) -> PartsOut:
    """Leave a part out of the next version. Refused while labels use it or parts are below it."""
    schema = catalog.remove_part(collection.id, part_id)
    catalog.append_audit(caller.name, "remove part", f"part {collection.id}/{part_id}")
    return PartsOut.of(schema)
