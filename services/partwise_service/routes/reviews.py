"""/collections/{collection_id}/reviews, /shapes/{shape_id}/reviews: labels that wait for a second look."""

from typing import Annotated

from fastapi import APIRouter, Query

from partwise.errors import NotFoundError
from partwise.store.catalog import LabelCatalog
from partwise_service.dependencies import CatalogDep, Reviewer, ScopedCollection, ScopedShape
from partwise_service.schemas.base import MAX_ROW_ID, Page, RowId
from partwise_service.schemas.shapes import Rejection, ReviewOut, ReviewsOut

MAX_PAGE = 500
router = APIRouter(tags=["reviews"])


@router.get("/collections/{collection_id}/reviews")
def list_open_reviews(
    _caller: Reviewer,
    collection: ScopedCollection,
    catalog: CatalogDep,
    after: Annotated[int, Query(ge=0, le=MAX_ROW_ID)] = 0,
    limit: Annotated[int, Query(ge=1, le=MAX_PAGE)] = 100,
) -> Page[ReviewOut]:
    """Labels of the collection that wait for someone to look at them, oldest first."""
    found = catalog.open_reviews(collection.id, after=after, limit=limit)
    next_after = str(found[-1].id) if len(found) == limit else None
    return Page(items=[ReviewOut.of(review) for review in found], next=next_after)


@router.get("/shapes/{shape_id}/reviews")
def list_reviews_of_shape(shape: ScopedShape, catalog: CatalogDep) -> ReviewsOut:
    """Every review of a shape, open or not, oldest first."""
    return ReviewsOut(items=[ReviewOut.of(review) for review in catalog.reviews(shape.id)])


@router.post("/shapes/{shape_id}/reviews/{review_id}/accept")
def accept_review(caller: Reviewer, shape: ScopedShape, catalog: CatalogDep, review_id: RowId) -> ReviewOut:
    """The labels are right as they are."""
    _refuse_foreign(catalog, shape.id, review_id)
    return ReviewOut.of(catalog.accept_review(review_id, caller.person_id))


@router.post("/shapes/{shape_id}/reviews/{review_id}/reject")
def reject_review(
    caller: Reviewer, shape: ScopedShape, catalog: CatalogDep, review_id: RowId, rejection: Rejection
) -> ReviewOut:
    """The labels are not right: the shape goes back into the queue."""
    _refuse_foreign(catalog, shape.id, review_id)
    rejected = catalog.reject_review(review_id, caller.person_id, rejection.note, for_author=rejection.for_author)
    return ReviewOut.of(rejected)


def _refuse_foreign(catalog: LabelCatalog, shape_id: int, review_id: int) -> None:
    if all(review.id != review_id for review in catalog.reviews(shape_id)):
        raise NotFoundError(f"shape {shape_id} has no review {review_id}; see /shapes/{shape_id}/reviews")
