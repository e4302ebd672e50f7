"""Label revisions and reviews."""

from collections.abc import Collection as SizedIterable
from collections.abc import Mapping, Sequence

import numpy as np
from jaxtyping import UInt16

from partwise.store import records as r
from partwise.store.catalog import SHOWN_KINDS
from partwise.store.engine import reading, writing
from partwise.store.reviews import NewReview, Review, ReviewReason
from partwise.store.sql import choices, efforts, labels, reviews
from partwise.store.sql_catalog.base import SqlBase


class SqlLabelCatalog(SqlBase):
    def add_revision(self, revision: r.NewRevision, review: NewReview | None = None) -> r.LabelRevision:
        with writing(self._engine) as connection:
            return labels.add_revision(connection, revision, review, self._clock())

    def revision(self, revision_id: int) -> r.LabelRevision:
        with reading(self._engine) as connection:
            return labels.revision(connection, revision_id)

    def revisions(self, shape_id: int) -> Sequence[r.LabelRevision]:
        with reading(self._engine) as connection:
            return labels.revisions(connection, shape_id)

    def labels(self, revision_id: int) -> UInt16[np.ndarray, " m"]:
        with reading(self._engine) as connection:
            return labels.labels(connection, revision_id)

    def head_revision(self, shape_id: int, kinds: Sequence[r.RevisionKind] = SHOWN_KINDS) -> r.LabelRevision | None:
        with reading(self._engine) as connection:
            return labels.head_revisions(connection, [shape_id], kinds).get(shape_id)

    def head_revisions(
        self, shape_ids: SizedIterable[int], kinds: Sequence[r.RevisionKind] = SHOWN_KINDS
    ) -> Mapping[int, r.LabelRevision]:
        with reading(self._engine) as connection:
            return labels.head_revisions(connection, shape_ids, kinds)

    def labelled_shapes(
        self,
        collection_id: int,
        *,
        kinds: Sequence[r.RevisionKind] = SHOWN_KINDS,
        after: int = 0,
        limit: int = 1000,
        leave_out_reviews: bool = False,
    ) -> Sequence[r.LabelRevision]:
        with reading(self._engine) as connection:
            return labels.labelled_shapes(
                connection, collection_id, kinds, after, limit, leave_out_reviews=leave_out_reviews
            )

    def revision_efforts(self, revision_ids: SizedIterable[int]) -> Mapping[int, r.Effort]:
        with reading(self._engine) as connection:
            return efforts.revision_efforts(connection, sorted(revision_ids))

    def answer_efforts(self, answer_ids: SizedIterable[int]) -> Mapping[int, r.Effort]:
        with reading(self._engine) as connection:
            return efforts.answer_efforts(connection, sorted(answer_ids))

    def add_review(self, revision_id: int, review: NewReview) -> Review:
        with writing(self._engine) as connection:
            return reviews.open_review(connection, revision_id, review, self._clock())

    def open_reviews(
        self,
        collection_id: int,
        *,
        after: int = 0,
        limit: int = 1000,
        reasons: SizedIterable[ReviewReason] = tuple(ReviewReason),
    ) -> Sequence[Review]:
        with reading(self._engine) as connection:
            return reviews.open_reviews(connection, collection_id, after, limit, reasons)

    def count_open_reviews(
        self, collection_id: int, *, reasons: SizedIterable[ReviewReason] = tuple(ReviewReason)
    ) -> int:
        with reading(self._engine) as connection:
            return reviews.count_open_reviews(connection, collection_id, reasons)

    def reviews(self, shape_id: int) -> Sequence[Review]:
        with reading(self._engine) as connection:
            return reviews.reviews(connection, shape_id)

    def accept_review(self, review_id: int, person_id: int) -> Review:
        with writing(self._engine) as connection:
            return reviews.accept_review(connection, review_id, person_id, self._clock())

    def accept_reviews(self, collection_id: int, reason: ReviewReason, person_id: int, *, limit: int = 1000) -> int:
        with writing(self._engine) as connection:
            return reviews.accept_reviews(connection, collection_id, reason, person_id, limit, self._clock())

    def reject_review(self, review_id: int, person_id: int, note: str, *, for_author: bool = False) -> Review:
        with writing(self._engine) as connection:
            return reviews.reject_review(
                connection, review_id, person_id, note, for_author=for_author, now=self._clock()
            )

    def reject_labels(self, shape_id: int, person_id: int, note: str, *, for_author: bool = False) -> Review:
        with writing(self._engine) as connection:
            return reviews.reject_labels(
                connection, shape_id, person_id, note, for_author=for_author, now=self._clock()
            )

    def choose_answer(self, review_id: int, answer_id: int, person_id: int) -> r.LabelRevision:
        with writing(self._engine) as connection:
            return choices.choose_answer(connection, review_id, answer_id, person_id, self._clock())
