"""/collections/{collection_id}/reviews, /shapes/{shape_id}/reviews: labels that wait for a second look."""

from collections.abc import Sequence
from typing import Annotated

from fastapi import APIRouter, Query

from partwise.errors import ConflictError, NotFoundError
from partwise.store.catalog import LabelCatalog
from partwise.store.reviews import Review, ReviewReason
from partwise.workspace.reviewing import accept_all
from partwise_service.answering import AnswerRoute
from partwise_service.dependencies import CatalogDep, Reviewer, ScopedCollection, ScopedShape, shapes_of
from partwise_service.schemas.accepts import BulkRejection, RefusedOut, Rejected, ReviewAcceptance, ReviewsAccepted
from partwise_service.schemas.base import MAX_ROW_ID, Page, RowId
from partwise_service.schemas.shapes import (
    EffortOut,
    OpenReviewOut,
    Rejection,
    ReviewCount,
    ReviewOut,
    ReviewsOut,
)

MAX_PAGE = 500
EVERY_REASON = tuple(ReviewReason)
Reasons = Annotated[
    tuple[ReviewReason, ...], Query(alias="reason", max_length=len(EVERY_REASON), description="Again for more of them.")
]
router = APIRouter(route_class=AnswerRoute, tags=["reviews"])


@router.get("/collections/{collection_id}/reviews")
def list_open_reviews(
    _caller: Reviewer,
    collection: ScopedCollection,
    catalog: CatalogDep,
    after: Annotated[int, Query(ge=0, le=MAX_ROW_ID)] = 0,
    limit: Annotated[int, Query(ge=1, le=MAX_PAGE)] = 100,
    reasons: Reasons = EVERY_REASON,
) -> Page[OpenReviewOut]:
    """Labels of the collection that wait for someone to look at them, of these reasons if given, oldest first."""
    found = catalog.open_reviews(collection.id, after=after, limit=limit, reasons=reasons)
    next_after = str(found[-1].id) if len(found) == limit else None
    return Page(items=_with_efforts(catalog, found), next=next_after)


@router.get("/collections/{collection_id}/reviews/count")
def count_open_reviews(
    _caller: Reviewer, collection: ScopedCollection, catalog: CatalogDep, reasons: Reasons = EVERY_REASON
) -> ReviewCount:
    """How many the list of them has on all its pages."""
    return ReviewCount(n_reviews=catalog.count_open_reviews(collection.id, reasons=reasons))


@router.post("/collections/{collection_id}/reviews/accept")
def accept_reviews(
    caller: Reviewer, collection: ScopedCollection, catalog: CatalogDep, acceptance: ReviewAcceptance
) -> ReviewsAccepted:
    """All labels that wait for this reason are right as they are."""
    return ReviewsAccepted(n_accepted=accept_all(catalog, collection.id, acceptance.reason, caller.person_id))


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


@router.post("/shapes/{shape_id}/reject")
def reject_labels(caller: Reviewer, shape: ScopedShape, catalog: CatalogDep, rejection: Rejection) -> ReviewOut:
    """Send a shape's newest labels back for rework, whether or not a review of them is open."""
    for_author = rejection.for_author
    return ReviewOut.of(catalog.reject_labels(shape.id, caller.person_id, rejection.note, for_author=for_author))


@router.post("/collections/{collection_id}/reject")
def reject_many(
    caller: Reviewer, collection: ScopedCollection, catalog: CatalogDep, rejection: BulkRejection
) -> Rejected:
    """Send the newest labels of many shapes back for rework, each by itself."""
    rejected, refused = [], []
    for shape in shapes_of(catalog, collection, rejection.shape_ids):
        try:
            catalog.reject_labels(shape.id, caller.person_id, rejection.note, for_author=rejection.for_author)
            rejected.append(shape.id)
        except (ConflictError, NotFoundError) as error:
            refused.append(RefusedOut(shape_id=shape.id, why=str(error)))
    return Rejected(rejected=rejected, refused=refused)


def _with_efforts(catalog: LabelCatalog, found: Sequence[Review]) -> list[OpenReviewOut]:
    efforts = catalog.revision_efforts([review.revision_id for review in found])
    return [
        OpenReviewOut(**ReviewOut.of(review).model_dump(), effort=EffortOut.of(efforts.get(review.revision_id)))
        for review in found
    ]


def _refuse_foreign(catalog: LabelCatalog, shape_id: int, review_id: int) -> None:
    if all(review.id != review_id for review in catalog.reviews(shape_id)):
        raise NotFoundError(f"shape {shape_id} has no review {review_id}; see /shapes/{shape_id}/reviews")
