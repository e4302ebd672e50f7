"""Jobs: enqueued, claimed by one owner, kept alive, ended."""

from collections.abc import Mapping
from datetime import datetime
from typing import Any

from sqlalchemy import ColumnElement, Connection, Row, literal_column, select, update

from partwise.errors import ConflictError, NotFoundError, ParameterError
from partwise.store import tables as t
from partwise.store.records import EventKind, Job, JobKind, JobState, NewEvent, Progress
from partwise.store.sql.collections import schema_version
from partwise.store.sql.dialect import insert_for, seconds_ago
from partwise.store.sql.events import append_events

# written out, not bound: a partial index serves only a query whose text repeats the index's condition
PENDING: ColumnElement[str] = literal_column("'pending'")
RUNNING: ColumnElement[str] = literal_column("'running'")


def enqueue_job(
    connection: Connection, collection_id: int, kind: JobKind, parameters: Mapping[str, Any] | None, now: datetime
) -> Job:
    schema_version(connection, collection_id)  # refuses an unknown collection
    job, is_new = enqueue(connection, collection_id, kind, parameters, now)
    if is_new:
        append_events(connection, [job_event(job)], now)
    return job


def enqueue(
    connection: Connection, collection_id: int, kind: JobKind, parameters: Mapping[str, Any] | None, now: datetime
) -> tuple[Job, bool]:
    """A pending job and whether it is new; its event is the caller's to add."""
    values = {
        "collection_id": collection_id,
        "kind": kind.value,
        "parameters": dict(parameters or {}),
        "state": JobState.PENDING.value,
        "attempts": 0,
        "n_done": 0,
        "n_failed": 0,
        "message": "",
        "cancel_requested": False,
        "created_at": now,
    }
    statement = insert_for(connection, t.job).values(values)
    found = connection.execute(statement.on_conflict_do_nothing().returning(t.job)).first()
    if found is not None:
        return to_job(found), True
    waiting = (t.job.c.collection_id == collection_id) & (t.job.c.kind == kind.value) & (t.job.c.state == PENDING)
    if parameters:
        connection.execute(update(t.job).where(waiting).values(parameters=dict(parameters)))
    known = connection.execute(select(t.job).where(waiting)).first()
    if known is None:  # begun in this very moment: it has not seen what this one is asked for
        return enqueue(connection, collection_id, kind, parameters, now)
    return to_job(known), False


def job(connection: Connection, job_id: int) -> Job:
    return _found(connection.execute(select(t.job).where(t.job.c.id == job_id)).first(), job_id)


def jobs(
    connection: Connection, collection_id: int, before: int | None, limit: int, state: JobState | None
) -> list[Job]:
    query = select(t.job).where(t.job.c.collection_id == collection_id)
    if before is not None:
        query = query.where(t.job.c.id < before)
    if state is not None:
        query = query.where(t.job.c.state == state.value)
    return [to_job(row) for row in connection.execute(query.order_by(t.job.c.id.desc()).limit(limit))]


def heartbeat_job(connection: Connection, job_id: int, owner: str, progress: Progress | None, now: datetime) -> Job:
    known = own_running(connection, job_id, owner)
    values: dict[str, Any] = {"heartbeat_at": seconds_ago(0.0)}
    if progress is None or progress == known.progress:
        return to_job(connection.execute(update_job(job_id, values)).one())
    return changed_job(connection, job_id, values | _columns(progress), now)


def finish_job(
    connection: Connection,
    job_id: int,
    owner: str,
    state: JobState,
    message: str,
    result: Mapping[str, Any] | None,
    now: datetime,
) -> Job:
    if state not in (JobState.DONE, JobState.FAILED, JobState.CANCELLED):
        raise ParameterError(f"a job ends as done, failed or cancelled but was to end as {state}; name one of them")
    known = own_running(connection, job_id, owner)
    values: dict[str, Any] = {"state": state.value, "finished_at": now, "message": message or known.progress.message}
    if result is not None:
        values["result"] = dict(result)
    return changed_job(connection, job_id, values, now)


def cancel_job(connection: Connection, job_id: int, now: datetime) -> Job:
    known = _locked(connection, job_id)
    if known.is_over:
        raise ConflictError(f"only a job that is not over is cancelled but job {job_id} is {known.state}")
    if known.state is JobState.PENDING:
        return changed_job(connection, job_id, {"state": JobState.CANCELLED.value, "finished_at": now}, now)
    return changed_job(connection, job_id, {"cancel_requested": True}, now)


def retry_job(connection: Connection, job_id: int, now: datetime) -> Job:
    known = _locked(connection, job_id)
    if known.state not in (JobState.FAILED, JobState.CANCELLED):
        raise ConflictError(f"only a failed or cancelled job is tried again but job {job_id} is {known.state}")
    return enqueue_job(connection, known.collection_id, known.kind, known.parameters, now)


def job_event(about: Job) -> NewEvent:
    """Says where a job stands."""
    payload = {
        "job_id": about.id,
        "job_kind": about.kind.value,
        "state": about.state.value,
        "done": about.progress.n_done,
        "failed": about.progress.n_failed,
        "total": about.progress.n_total,
        "message": about.progress.message,
    }
    return NewEvent(EventKind.JOB, about.collection_id, payload)


def _columns(progress: Progress) -> dict[str, Any]:
    return {
        "n_done": progress.n_done,
        "n_failed": progress.n_failed,
        "n_total": progress.n_total,
        "message": progress.message,
    }


def update_job(job_id: int, values: Mapping[str, Any]) -> Any:
    return update(t.job).where(t.job.c.id == job_id).values(values).returning(t.job)


def changed_job(connection: Connection, job_id: int, values: Mapping[str, Any], now: datetime) -> Job:
    """The job with these values, which open pages are told: the last thing a transaction does."""
    changed = to_job(connection.execute(update_job(job_id, values)).one())
    append_events(connection, [job_event(changed)], now)
    return changed


def own_running(connection: Connection, job_id: int, owner: str) -> Job:
    """The job, locked; ConflictError unless it runs and is this owner's."""
    known = _locked(connection, job_id)
    if known.state is not JobState.RUNNING or known.owner != owner:
        raise ConflictError(
            f"a job is worked on by its owner while it runs but job {job_id} is {known.state}, its owner "
            f"{known.owner}; stop working on it"
        )
    return known


def _locked(connection: Connection, job_id: int) -> Job:
    return _found(connection.execute(select(t.job).where(t.job.c.id == job_id).with_for_update()).first(), job_id)


def _found(row: Row[Any] | None, job_id: int) -> Job:
    if row is None:
        raise NotFoundError(f"there is no job {job_id}; was it another workspace's?")
    return to_job(row)


def to_job(row: Row[Any]) -> Job:
    values = dict(row._mapping)
    progress = Progress(**{name: values.pop(name) for name in ("n_done", "n_failed", "n_total", "message")})
    return Job(**{**values, "kind": JobKind(row.kind), "state": JobState(row.state), "progress": progress})
