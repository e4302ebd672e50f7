"""Drafts: work in progress as a log of strokes, and what it is confirmed as."""

from datetime import datetime
from typing import Annotated

from pydantic import Field

from partwise.store.records import Confirmation, Draft, DraftOutcome, StoredStroke
from partwise_service.schemas.base import WHOLE, Answer, AnyId, Request
from partwise_service.schemas.strokes import KeptStroke, SentStroke

MAX_STROKES = 1_000
MAX_SEQUENCE = 2**31 - 1
Sequence = Annotated[int, Field(ge=0, le=MAX_SEQUENCE), WHOLE]
Sha256 = Annotated[str, Field(pattern="^[0-9a-f]{64}$")]


class NewDraftRequest(Request):
    """base_revision : the labels to start from; null for none. An open draft is gone on with, whatever its base."""

    base_revision: AnyId | None = None


class Strokes(Request):
    """Strokes in order, numbered on from `expected_sequence`."""

    expected_sequence: Sequence
    strokes: Annotated[list[SentStroke], Field(min_length=1, max_length=MAX_STROKES)]


class Acknowledgement(Request):
    """The revision that somebody else confirmed meanwhile, and that the caller has looked at."""

    revision_id: AnyId


class Confirm(Request):
    """n_strokes : strokes of the draft as the caller knows it. labels_sha256 : checksum of the labels they see."""

    n_strokes: Sequence
    labels_sha256: Sha256 | None = None


class ConfirmLabels(Request):
    """labels_sha256 : checksum of the labels that the caller sees, as little-endian uint16."""

    labels_sha256: Sha256 | None = None


class DraftOut(Answer):
    """A draft. `n_strokes`, its ETag too, is the sequence of the next stroke; everything counted in it is committed.

    base_revision, base_sha256 : the labels it starts from; null and the checksum of zeros for none.
    seen_revision : the newest labels of the shape that the person knows of.
    """

    id: int
    collection_id: int
    shape_id: int
    person_id: int
    mesh_hash: str
    base_revision: int | None
    base_sha256: str
    seen_revision: int | None
    schema_version: int
    n_strokes: int
    created_at: datetime
    updated_at: datetime
    closed_at: datetime | None
    outcome: DraftOutcome | None
    labels_sha256: str | None

    @classmethod
    def of(cls, draft: Draft) -> "DraftOut":
        """The draft as it is told: never what it is for."""
        return cls.model_validate(draft)


class DraftsOut(Answer):
    items: list[DraftOut]


class StrokeOut(Answer):
    """A stroke as it was acknowledged; `payload` is what was sent."""

    sequence: int
    id: str
    payload: KeptStroke
    recorded_at: datetime

    @classmethod
    def of(cls, stroke: StoredStroke) -> "StrokeOut":
        """The stroke as it is told."""
        return cls(sequence=stroke.sequence, id=stroke.id, payload=dict(stroke.payload), recorded_at=stroke.recorded_at)


class StrokesOut(Answer):
    """A page of a draft's log. `next` goes into `after` for the next page; null at the end."""

    draft: DraftOut
    items: list[StrokeOut]
    next: int | None


class DraftState(Answer):
    """A draft as it is on record. head_revision : the newest labels of its shape."""

    draft_id: int
    n_strokes: int
    base_revision: int | None
    seen_revision: int | None
    head_revision: int | None
    mesh_hash: str
    outcome: DraftOutcome | None


class StaleState(Answer):
    """Of a refusal because the draft or its shape went on elsewhere. state : what is on record now."""

    state: DraftState


class StaleDraft(StaleState):
    """Both sides of such a refusal. recorded : the log from the strokes that the caller knows of on, 1,000 at most."""

    recorded: list[StrokeOut]


class RefusedStrokes(StaleDraft):
    """Both sides of such a refusal. refused : what was sent."""

    refused: list[SentStroke]


class Confirmed(Answer):
    """The labels that are on record now, by their checksum. What becomes of them is the collection's affair."""

    draft_id: int
    shape_id: int
    labels_sha256: str

    @classmethod
    def of(cls, done: Confirmation) -> "Confirmed":
        """Without anything that says what the work was for."""
        return cls(draft_id=done.draft_id, shape_id=done.shape_id, labels_sha256=done.sha256)
