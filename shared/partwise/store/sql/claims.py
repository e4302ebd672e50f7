"""Which job is begun next, and by whom."""

from collections.abc import Sequence
from datetime import datetime

from sqlalchemy import Connection, exists, or_, select

from partwise.store import tables as t
from partwise.store.records import COALESCED_KINDS, Job, JobKind, JobState
from partwise.store.sql.jobs import PENDING, RUNNING, changed_job
from partwise.store.sql.tally import restart_count


def claim_job(connection: Connection, owner: str, kinds: Sequence[JobKind] | None, now: datetime) -> Job | None:
    running = t.job.alias("running")
    coalesced = [kind.value for kind in COALESCED_KINDS]
    runs_already = exists().where(
        running.c.collection_id == t.job.c.collection_id, running.c.kind == t.job.c.kind, running.c.state == RUNNING
    )
    query = (
        select(t.job.c.id)
        .where(t.job.c.state == PENDING, or_(t.job.c.kind.not_in(coalesced), ~runs_already))
        .order_by(t.job.c.id)
        .limit(1)
        .with_for_update(skip_locked=True, of=t.job)
    )
    if kinds is not None:
        query = query.where(t.job.c.kind.in_([kind.value for kind in kinds]))
    job_id = connection.execute(query).scalar()
    if job_id is None:
        return None
    values = {
        "state": JobState.RUNNING.value,
        "owner": owner,
        "attempts": t.job.c.attempts + 1,
        "started_at": now,
        "heartbeat_at": now,
    }
    job_kind, collection_id = connection.execute(
        select(t.job.c.kind, t.job.c.collection_id).where(t.job.c.id == job_id)
    ).one()
    if job_kind == JobKind.TRAIN:
        restart_count(connection, collection_id)
    return changed_job(connection, job_id, values, now)
