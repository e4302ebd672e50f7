"""When enough shapes were confirmed, a training is asked for: in the transaction that confirms the last of them."""

from datetime import datetime

from sqlalchemy import Connection, update

from partwise.store import tables as t
from partwise.store.records import EventKind, JobKind, NewEvent
from partwise.store.sql.dialect import insert_for
from partwise.store.sql.jobs import enqueue, job_event
from partwise.store.sql.places import collection_queue_settings


def count_confirmed(connection: Connection, collection_id: int, now: datetime, n_more: int = 1) -> list[NewEvent]:
    """Counts more shapes that can be trained on."""
    train_after = collection_queue_settings(connection, collection_id).train_after
    statement = insert_for(connection, t.training_tally).values(collection_id=collection_id, n_confirmed=n_more)
    n_confirmed = connection.execute(
        statement.on_conflict_do_update(
            index_elements=["collection_id"], set_={"n_confirmed": t.training_tally.c.n_confirmed + n_more}
        ).returning(t.training_tally.c.n_confirmed)
    ).scalar_one()
    if not train_after or n_confirmed < train_after:
        return []
    job, is_new = enqueue(connection, collection_id, JobKind.TRAIN, None, now)
    payload = {"job_id": job.id, "state": job.state.value, "n_confirmed": n_confirmed}
    return [NewEvent(EventKind.TRAINING, collection_id, payload), job_event(job)] if is_new else []


def restart_count(connection: Connection, collection_id: int) -> None:
    """A training begins, and covers all that was confirmed until now."""
    is_it = t.training_tally.c.collection_id == collection_id
    connection.execute(update(t.training_tally).where(is_it).values(n_confirmed=0))
