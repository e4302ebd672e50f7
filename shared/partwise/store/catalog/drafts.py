"""Drafts: work in progress, of which nothing that was acknowledged is ever lost."""

from collections.abc import Sequence
from typing import Protocol

import numpy as np
from jaxtyping import UInt16

from partwise.labels.strokes import Stroke
from partwise.store.records import (
    Answer,
    BlindCheck,
    BlindCheckDay,
    Confirmation,
    Consensus,
    Draft,
    NewConfirmation,
    NewDraft,
    StoredStroke,
)


class DraftCatalog(Protocol):
    """Drafts, strokes, confirmed labels and how they compare.

    `StaleDraftError` is a `ConflictError` that carries the present state, so that a client keeps both sides.
    """

    def open_draft(self, lease_id: int, person_id: int, new: NewDraft) -> Draft:
        """The person's open draft of the leased shape, resumed as it was, or a new one that starts from `new`.

        Raises `ConflictError` if the lease has ended or is another person's, `LabelError` if the mesh is not one of
        the shape's or the base is no revision of the shape, on that mesh, with that checksum.
        """
        ...

    def draft(self, draft_id: int) -> Draft: ...

    def open_drafts(self, person_id: int) -> Sequence[Draft]:
        """A person's open drafts, oldest first."""
        ...

    def drafts_of_shape(self, shape_id: int) -> Sequence[Draft]:
        """Every draft of a shape, open or not, oldest first."""
        ...

    def append_strokes(self, draft_id: int, person_id: int, expected_sequence: int, strokes: Sequence[Stroke]) -> Draft:
        """Commit strokes numbered on from `expected_sequence`; the draft as it is then. Safe to send again.

        Strokes that are on record already are passed over, so a repeated or overlapping sending adds the rest only; to
        a draft that was closed meanwhile they can be sent again, too.

        Raises `StaleDraftError` if the sequence is not the draft's next one, the draft is closed, a stroke is on
        another base revision, or one of the same id or number differs; `ConflictError` if the draft is another
        person's; `ParameterError` if the strokes are not numbered so or name another author.
        """
        ...

    def strokes(self, draft_id: int, *, after: int = -1, limit: int = 10_000) -> Sequence[StoredStroke]:
        """A page of a draft's strokes by sequence."""
        ...

    def acknowledge_head(self, draft_id: int, person_id: int, revision_id: int) -> Draft:
        """Record that the person has seen labels that others confirmed meanwhile, and goes on regardless.

        Raises `ConflictError` as for strokes, `StaleDraftError` if that revision is not the newest.
        """
        ...

    def discard_draft(self, draft_id: int, person_id: int) -> Draft:
        """Close a draft without labels; its strokes stay on record. `ConflictError` as for strokes."""
        ...

    def confirm_draft(self, confirmation: NewConfirmation) -> Confirmation:
        """Commit what a draft came to: labels, the ends of draft and lease, review, audit, training job and events.

        All or nothing. Confirming the same labels again returns what became of them. What becomes of them follows from
        the draft's purpose: see `LeasePurpose`. A lease that expired is taken up again if nobody else has the place.

        Raises `StaleDraftError` if strokes came in since, if other labels of the shape were confirmed since the draft
        was begun (see `acknowledge_head`), or if `consensus` is not over the answers on record (then compare again);
        `ConflictError` if the draft is another person's, was discarded or confirmed otherwise, or its place is
        another's now (it stays open); `LabelError` for labels that do not fit.
        """
        ...

    def awaited_answers(self, draft_id: int) -> tuple[Sequence[Answer], int]:
        """For an independent draft: the others' answers of its round so far, and how many more there must be than
        those and the draft's own. 0: confirming it completes the round.
        """
        ...

    def answer_labels(self, answer_id: int) -> UInt16[np.ndarray, " m"]:
        """The labels of an answer, checked against their checksum."""
        ...

    def answers(self, shape_id: int) -> Sequence[Answer]:
        """Every answer of a shape, oldest first."""
        ...

    def consensus_of(self, shape_id: int) -> Sequence[Consensus]:
        """The rounds of independent labels of a shape that are complete, oldest first."""
        ...

    def blind_checks(
        self,
        collection_id: int,
        *,
        after: int = 0,
        limit: int = 1000,
        person_id: int | None = None,
        but_person_id: int | None = None,
    ) -> Sequence[BlindCheck]:
        """A page of blind checks by id, of one person or of all but one if given.

        For those who run the collection, never for who was checked.
        """
        ...

    def blind_check_days(self, collection_id: int) -> Sequence[BlindCheckDay]:
        """How close each person's labels came on each day, by person and day."""
        ...
