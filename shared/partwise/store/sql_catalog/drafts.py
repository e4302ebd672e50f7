"""Drafts, strokes, confirmed labels."""

from collections.abc import Sequence

import numpy as np
from jaxtyping import UInt16

from partwise.labels.strokes import Stroke
from partwise.store import records as r
from partwise.store.engine import reading, writing, writing_at_once
from partwise.store.sql import answers, confirm, drafts
from partwise.store.sql_catalog.base import SqlBase


class SqlDraftCatalog(SqlBase):
    def open_draft(self, lease_id: int, person_id: int, new: r.NewDraft) -> r.Draft:
        with writing(self._engine) as connection:
            return drafts.open_draft(connection, lease_id, person_id, new, self._clock())

    def draft(self, draft_id: int) -> r.Draft:
        with reading(self._engine) as connection:
            return drafts.draft(connection, draft_id)

    def open_drafts(self, person_id: int) -> Sequence[r.Draft]:
        with reading(self._engine) as connection:
            return drafts.open_drafts(connection, person_id)

    def drafts_of_shape(self, shape_id: int) -> Sequence[r.Draft]:
        with reading(self._engine) as connection:
            return drafts.drafts_of_shape(connection, shape_id)

    def append_strokes(
        self, draft_id: int, person_id: int, expected_sequence: int, strokes: Sequence[Stroke]
    ) -> r.Draft:
        sent = (draft_id, person_id, expected_sequence, strokes)
        with writing_at_once(self._engine) as connection:
            followed_on = drafts.follow_on(connection, *sent, self._clock())
        if followed_on is not None:
            return followed_on
        with writing(self._engine) as connection:
            return drafts.append_strokes(connection, *sent, self._clock())

    def strokes(self, draft_id: int, *, after: int = -1, limit: int = 10000) -> Sequence[r.StoredStroke]:
        with reading(self._engine) as connection:
            return drafts.strokes(connection, draft_id, after, limit)

    def acknowledge_head(self, draft_id: int, person_id: int, revision_id: int) -> r.Draft:
        with writing(self._engine) as connection:
            return drafts.acknowledge_head(connection, draft_id, person_id, revision_id, self._clock())

    def discard_draft(self, draft_id: int, person_id: int) -> r.Draft:
        with writing(self._engine) as connection:
            return drafts.discard_draft(connection, draft_id, person_id, self._clock())

    def confirm_draft(self, confirmation: r.NewConfirmation) -> r.Confirmation:
        with writing(self._engine) as connection:
            return confirm.confirm_draft(connection, confirmation, self._clock())

    def awaited_answers(self, draft_id: int) -> tuple[Sequence[r.Answer], int]:
        with reading(self._engine) as connection:
            return answers.awaited_answers(connection, drafts.draft(connection, draft_id))

    def answer_labels(self, answer_id: int) -> UInt16[np.ndarray, " m"]:
        with reading(self._engine) as connection:
            return answers.answer_labels(connection, answer_id)

    def answers(self, shape_id: int) -> Sequence[r.Answer]:
        with reading(self._engine) as connection:
            return answers.answers(connection, shape_id)

    def consensus_of(self, shape_id: int) -> Sequence[r.Consensus]:
        with reading(self._engine) as connection:
            return answers.consensus_of(connection, shape_id)

    def blind_checks(
        self,
        collection_id: int,
        *,
        after: int = 0,
        limit: int = 1000,
        person_id: int | None = None,
        but_person_id: int | None = None,
    ) -> Sequence[r.BlindCheck]:
        with reading(self._engine) as connection:
            return answers.blind_checks(connection, collection_id, after, limit, person_id, but_person_id)

    def blind_check_days(self, collection_id: int) -> Sequence[r.BlindCheckDay]:
        with reading(self._engine) as connection:
            return answers.blind_check_days(connection, collection_id)
