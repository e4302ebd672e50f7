"""How fast stages go and why shapes fail, counted."""

from datetime import datetime

from sqlalchemy import Connection, func, select

from partwise.store import tables as t
from partwise.store.records import FailureKind, RunStatus
from partwise.store.sql.state import is_failed_run


def stage_paces(connection: Connection, collection_id: int, since: datetime) -> dict[str, int]:
    runs = t.stage_run.c
    # ids grow with time: walking back from the newest costs what was done since, not what was ever done
    older = select(runs.id).where(runs.finished_at < since).order_by(runs.id.desc()).limit(1)
    last_older = connection.execute(older).scalar() or 0
    query = (
        select(runs.stage, func.count().label("n_done"))
        .join_from(t.stage_run, t.shape)
        .where(runs.id > last_older, runs.status == RunStatus.DONE.value, t.shape.c.collection_id == collection_id)
        .group_by(runs.stage)
    )
    return {row.stage: row.n_done for row in connection.execute(query)}


def failure_kinds(connection: Connection, collection_id: int) -> dict[FailureKind, int]:
    kind = t.stage_run.c.summary["kind"].as_string()
    query = (
        select(kind, func.count())
        .join_from(t.stage_run, t.shape)
        .where(is_failed_run(), t.shape.c.collection_id == collection_id)
        .group_by(kind)
    )
    counts = dict.fromkeys(FailureKind, 0)
    for name, n_runs in connection.execute(query):
        known = FailureKind(name) if name in set(FailureKind) else FailureKind.ERROR
        counts[known] += n_runs
    return counts
