"""Accepting what waits for a review, many at once."""

from partwise.store.catalog import LabelCatalog
from partwise.store.reviews import ReviewReason


def accept_all(catalog: LabelCatalog, collection_id: int, reason: ReviewReason, person_id: int) -> int:
    """Accepts all open reviews of a reason, page by page, as others wait while a page is written; how many.

    Raises
    ------
    ParameterError : labels that were sent back, which wait for better ones.
    """
    n_accepted = 0
    while n_more := catalog.accept_reviews(collection_id, reason, person_id):
        n_accepted += n_more
    return n_accepted
