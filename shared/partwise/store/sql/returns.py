"""Jobs that go back to be begun again: their owner was lost, has to stop, or could not do them now."""

from collections.abc import Callable, Mapping
from datetime import datetime, timedelta
from typing import Any

from sqlalchemy import ColumnElement, Connection, select
from sqlalchemy.exc import IntegrityError

from partwise.store import tables as t
from partwise.store.records import COALESCED_KINDS, Job, JobState
from partwise.store.sql.dialect import seconds_ago
from partwise.store.sql.events import append_events
from partwise.store.sql.jobs import PENDING, RUNNING, job_event, own_running, to_job, update_job


def requeue_lost_jobs(connection: Connection, silent_for: timedelta, max_attempts: int, now: datetime) -> list[Job]:
    def after_loss(lost: Job) -> dict[str, Any]:
        if lost.attempts >= max_attempts:
            return _failed(f"its owner was lost {lost.attempts} times; look at the workers' logs", now)
        return _pending("its owner is gone; it will be begun again")

    is_silent = t.job.c.heartbeat_at < seconds_ago(silent_for.total_seconds())
    return _all_back(connection, is_silent, "its owner is gone", after_loss, now)


def release_jobs(connection: Connection, owner: str, message: str, now: datetime) -> list[Job]:
    def after_release(released: Job) -> dict[str, Any]:
        return {**_pending(message), "attempts": released.attempts - 1}

    return _all_back(connection, t.job.c.owner == owner, message, after_release, now)


def return_job(
    connection: Connection,
    job_id: int,
    owner: str,
    message: str,
    result: Mapping[str, Any] | None,
    max_attempts: int,
    now: datetime,
) -> Job:
    known = own_running(connection, job_id, owner)
    is_last = known.attempts >= max_attempts
    values = _failed(message, now) if is_last else _pending(message)
    if result is not None:
        values["result"] = dict(result)
    returned = _back(connection, known, message, values, now)
    append_events(connection, [job_event(returned)], now)
    return returned


def _all_back(
    connection: Connection,
    which: ColumnElement[bool],
    why: str,
    after: Callable[[Job], dict[str, Any]],
    now: datetime,
) -> list[Job]:
    query = (
        select(t.job)
        .where(t.job.c.state == RUNNING, which)
        .order_by(t.job.c.heartbeat_at)
        .with_for_update(skip_locked=True)
    )
    back = [to_job(row) for row in connection.execute(query)]
    changed = [_back(connection, each, why, after(each), now) for each in back]
    append_events(connection, [job_event(each) for each in changed], now)
    return changed


def _back(connection: Connection, job: Job, why: str, values: dict[str, Any], now: datetime) -> Job:
    """The job with these values, or ended where it need not be begun again."""
    instead = _instead(connection, job, why, now)
    if instead is not None:
        return to_job(connection.execute(update_job(job.id, instead)).one())
    try:
        with connection.begin_nested():
            return to_job(connection.execute(update_job(job.id, values)).one())
    except IntegrityError:  # another was asked for in this very moment, and waits now
        return _back(connection, job, why, values, now)


def _instead(connection: Connection, back: Job, why: str, now: datetime) -> dict[str, Any] | None:
    """How a job ends that need not be begun again; None if it must be."""
    if back.cancel_requested:
        return {"state": JobState.CANCELLED.value, "finished_at": now, "message": why}
    if back.kind not in COALESCED_KINDS:
        return None
    of_kind = (t.job.c.collection_id == back.collection_id) & (t.job.c.kind == back.kind.value)
    waits = connection.execute(select(t.job.c.id).where(of_kind, t.job.c.state == PENDING)).scalar()
    if waits is None:
        return None
    return {"state": JobState.CANCELLED.value, "finished_at": now, "message": f"{why}; job {waits} does its work"}


def _pending(message: str) -> dict[str, Any]:
    return {"state": JobState.PENDING.value, "message": message}


def _failed(message: str, now: datetime) -> dict[str, Any]:
    return {"state": JobState.FAILED.value, "finished_at": now, "message": message}
