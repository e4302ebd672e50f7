"""Label revisions and their reviews."""

from collections.abc import Collection as SizedIterable
from collections.abc import Mapping, Sequence
from typing import Protocol

import numpy as np
from jaxtyping import UInt16

from partwise.store.records import Effort, LabelRevision, NewRevision, RevisionKind
from partwise.store.reviews import NewReview, Review, ReviewReason

SHOWN_KINDS = (RevisionKind.HUMAN, RevisionKind.IMPORTED)
"""Kinds of revision that may be shown and trained on."""


class LabelCatalog(Protocol):
    """Label revisions, which nothing ever changes or deletes."""

    def add_revision(self, revision: NewRevision, review: NewReview | None = None) -> LabelRevision:
        """Commit labels, and with them an audit entry and, if given, a review that keeps them out of training.

        Human or imported labels resolve the open reviews of those whose place they take. Moved labels take over the
        reviews that have nothing to do with the move. Human or imported labels of an older schema version than the
        present one come with a review of reason schema.

        Raises `LabelError` if the mesh is not one of the shape's, there is not one label per face, an id is not in the
        schema version named, that version does not exist, the parent is not a revision of the same shape, or labels
        that are never shown are to be reviewed, or labels that are shown have a part that is gone. Raises
        `ConflictError` for moved labels whose parent is not, or no longer, the newest revision of the shape.
        """
        ...

    def revision(self, revision_id: int) -> LabelRevision: ...

    def revisions(self, shape_id: int) -> Sequence[LabelRevision]:
        """Every revision of a shape, oldest first."""
        ...

    def labels(self, revision_id: int) -> UInt16[np.ndarray, " m"]:
        """The labels of a revision, checked against their checksum."""
        ...

    def head_revision(self, shape_id: int, kinds: Sequence[RevisionKind] = SHOWN_KINDS) -> LabelRevision | None:
        """The newest revision of these kinds."""
        ...

    def head_revisions(
        self, shape_ids: SizedIterable[int], kinds: Sequence[RevisionKind] = SHOWN_KINDS
    ) -> Mapping[int, LabelRevision]:
        """The newest revision of these kinds for each shape; shapes without one are left out."""
        ...

    def labelled_shapes(
        self,
        collection_id: int,
        *,
        kinds: Sequence[RevisionKind] = SHOWN_KINDS,
        after: int = 0,
        limit: int = 1000,
        leave_out_reviews: bool = False,
    ) -> Sequence[LabelRevision]:
        """A page of head revisions by shape id: every shape of the collection that has labels of these kinds.

        `leave_out_reviews` leaves out shapes whose labels wait for someone to look at them.
        """
        ...

    def revision_efforts(self, revision_ids: SizedIterable[int]) -> Mapping[int, Effort]:
        """What these revisions took their authors; those that were not drawn here, or not counted, are left out."""
        ...

    def answer_efforts(self, answer_ids: SizedIterable[int]) -> Mapping[int, Effort]:
        """As `revision_efforts`, of answers."""
        ...

    def add_review(self, revision_id: int, review: NewReview) -> Review:
        """Have someone look at labels before they are trained on. An open review of the same reason stays the one.

        Raises `ConflictError` unless the revision is the newest human or imported one, `LabelError` for reference ones.
        """
        ...

    def open_reviews(
        self,
        collection_id: int,
        *,
        after: int = 0,
        limit: int = 1000,
        reasons: SizedIterable[ReviewReason] = tuple(ReviewReason),
    ) -> Sequence[Review]:
        """A page of the reviews that wait for someone, of these reasons, by review id."""
        ...

    def count_open_reviews(
        self, collection_id: int, *, reasons: SizedIterable[ReviewReason] = tuple(ReviewReason)
    ) -> int:
        """How many reviews `open_reviews` has on all its pages together."""
        ...

    def reviews(self, shape_id: int) -> Sequence[Review]:
        """Every review of a shape, open or not, oldest first."""
        ...

    def accept_review(self, review_id: int, person_id: int) -> Review:
        """Record that a person found the labels right as they are: under the present parts, whatever version they were
        made under. `ConflictError` if the review is resolved already.

        Labels that are not right are corrected by committing better ones, which resolves the review.
        """
        ...

    def accept_reviews(self, collection_id: int, reason: ReviewReason, person_id: int, *, limit: int = 1000) -> int:
        """As `accept_review`, of the oldest reviews of a reason, at most `limit` of them; how many those were.

        Call it until it is 0: others wait while it writes. Raises `ParameterError` for labels that were sent back.
        """
        ...

    def reject_review(self, review_id: int, person_id: int, note: str, *, for_author: bool = False) -> Review:
        """Send labels back with a note: the shape goes first in the queue, for their author or for anyone.

        The labels stay the newest but wait in a review of reason rework, which is returned; better labels resolve it.

        Raises `ConflictError` if the review is resolved already or somebody works on the shape, `ParameterError`
        without a note.
        """
        ...

    def reject_labels(self, shape_id: int, person_id: int, note: str, *, for_author: bool = False) -> Review:
        """As `reject_review`, of a shape's newest labels, whether or not a review of them is open.

        Raises `NotFoundError` without labels, `ConflictError` if they were sent back already or somebody works on the
        shape, `ParameterError` without a note.
        """
        ...

    def choose_answer(self, review_id: int, answer_id: int, person_id: int) -> LabelRevision:
        """Make one of the labels that a review of reason disagreement compares the shape's, in the name of who gave
        them, which resolves the review. person_id : whose decision that is.

        Raises `NotFoundError` for an answer of another round, `ConflictError` for a review of another reason or one
        that is resolved, `LabelError` if the answer has a part that is gone.
        """
        ...
