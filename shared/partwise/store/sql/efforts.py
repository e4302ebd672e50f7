"""What labels took whoever made them, as noted when their draft was confirmed."""

from typing import Any

from sqlalchemy import Connection, Select, select

from partwise.store import tables as t
from partwise.store.records import DraftOutcome, Effort
from partwise.store.sql.dialect import batches


def revision_efforts(connection: Connection, revision_ids: list[int]) -> dict[int, Effort]:
    revision, draft = t.label_revision.c, t.draft.c
    # nothing else says which draft became a revision; of two drafts with the same labels the later one counts
    is_same = (draft.shape_id == revision.shape_id) & (draft.person_id == revision.author_id)
    is_same &= (draft.labels_sha256 == revision.sha256) & (draft.outcome == DraftOutcome.CONFIRMED.value)
    query = select(revision.id, draft.active_s, draft.n_clicks).join_from(t.label_revision, t.draft, is_same)
    found = {}
    for some in batches(revision_ids):
        found.update(_efforts(connection, query.where(revision.id.in_(some)).order_by(draft.id)))
    return found


def answer_efforts(connection: Connection, answer_ids: list[int]) -> dict[int, Effort]:
    answer, draft = t.answer.c, t.draft.c
    query = select(answer.id, draft.active_s, draft.n_clicks).join_from(t.answer, t.draft)
    found = {}
    for some in batches(answer_ids):
        found.update(_efforts(connection, query.where(answer.id.in_(some))))
    return found


def _efforts(connection: Connection, query: Select[Any]) -> dict[int, Effort]:
    return {
        row.id: Effort(row.active_s, row.n_clicks)
        for row in connection.execute(query.where(t.draft.c.active_s.is_not(None)))
    }
