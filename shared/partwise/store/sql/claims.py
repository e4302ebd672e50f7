"""Which job is begun next, and by whom."""

from collections.abc import Sequence
from datetime import datetime
from typing import Any

from sqlalchemy import Connection, Select, case, exists, func, or_, select

from partwise.store import tables as t
from partwise.store.records import BACKGROUND_KINDS, COALESCED_KINDS, Job, JobKind, JobState
from partwise.store.sql.dialect import seconds_ago
from partwise.store.sql.jobs import PENDING, RUNNING, changed_job, to_job
from partwise.store.sql.tally import restart_count


def claim_job(
    connection: Connection, owner: str, kinds: Sequence[JobKind] | None, collection_id: int | None, now: datetime
) -> Job | None:
    row = connection.execute(_next(kinds, collection_id).with_for_update(skip_locked=True, of=t.job)).first()
    if row is None:
        return None
    values = {
        "state": JobState.RUNNING.value,
        "owner": owner,
        "attempts": t.job.c.attempts + 1,
        "started_at": now,
        "heartbeat_at": seconds_ago(0.0),
        "message": "",  # of the time before, if there was one
        "result": None,  # likewise
    }
    if row.kind == JobKind.TRAIN:
        restart_count(connection, row.collection_id)
    return changed_job(connection, row.id, values, now)


def next_job(connection: Connection, kinds: Sequence[JobKind] | None, collection_id: int | None) -> Job | None:
    row = connection.execute(_next(kinds, collection_id)).first()
    return None if row is None else to_job(row)


def _next(kinds: Sequence[JobKind] | None, collection_id: int | None) -> Select[Any]:
    """The pending job that has waited longest since it was asked for or last worked on, background work last."""
    running = t.job.alias("running")
    coalesced = [kind.value for kind in COALESCED_KINDS]
    runs_already = exists().where(
        running.c.collection_id == t.job.c.collection_id, running.c.kind == t.job.c.kind, running.c.state == RUNNING
    )
    is_background = case((t.job.c.kind.in_([kind.value for kind in BACKGROUND_KINDS]), 1), else_=0)
    query = (
        select(t.job)
        .where(t.job.c.state == PENDING, or_(t.job.c.kind.not_in(coalesced), ~runs_already))
        .order_by(is_background, func.coalesce(t.job.c.heartbeat_at, t.job.c.created_at), t.job.c.id)
        .limit(1)
    )
    if kinds is not None:
        query = query.where(t.job.c.kind.in_([kind.value for kind in kinds]))
    if collection_id is not None:
        query = query.where(t.job.c.collection_id == collection_id)
    return query
