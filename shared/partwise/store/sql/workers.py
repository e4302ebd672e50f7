"""Processes that do jobs: which there are, and what they take of their machines."""

from dataclasses import asdict
from datetime import datetime, timedelta

from sqlalchemy import Connection, delete, exists, select

from partwise.store import tables as t
from partwise.store.records import SeenWorker, WorkerUsage
from partwise.store.sql.dialect import insert_for
from partwise.store.sql.jobs import RUNNING

_FORGOTTEN_AFTER = timedelta(days=1)
"""Of those that ended without a word."""

_USAGE = ("memory_bytes", "n_actors", "actor_bytes", "free_bytes")


def note_worker(connection: Connection, owner: str, usage: WorkerUsage, now: datetime) -> None:
    renewed = {**asdict(usage), "seen_at": now}
    statement = insert_for(connection, t.worker).values(owner=owner, **renewed)
    connection.execute(statement.on_conflict_do_update(index_elements=["owner"], set_=renewed))
    connection.execute(delete(t.worker).where(t.worker.c.seen_at < now - _FORGOTTEN_AFTER))


def forget_worker(connection: Connection, owner: str) -> None:
    connection.execute(delete(t.worker).where(t.worker.c.owner == owner))


def workers(connection: Connection, seen_since: datetime) -> list[SeenWorker]:
    is_busy = exists().where(t.job.c.owner == t.worker.c.owner, t.job.c.state == RUNNING)
    query = select(t.worker, is_busy.label("is_busy")).where(t.worker.c.seen_at >= seen_since)
    return [
        SeenWorker(row.owner, WorkerUsage(**{name: getattr(row, name) for name in _USAGE}), row.seen_at, row.is_busy)
        for row in connection.execute(query.order_by(t.worker.c.owner))
    ]
