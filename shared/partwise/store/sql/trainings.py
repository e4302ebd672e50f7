"""The end of a training: model, evaluation to come and events, all or nothing."""

from datetime import datetime

from sqlalchemy import Connection

from partwise.store.records import EventKind, JobKind, JobState, Model, NewEvent, NewModel
from partwise.store.sql.events import append_events
from partwise.store.sql.jobs import enqueue, job_event, own_running, to_job, update_job
from partwise.store.sql.models import save_model


def finish_training(connection: Connection, job_id: int, owner: str, new: NewModel, now: datetime) -> Model:
    known = own_running(connection, job_id, owner)
    model = save_model(connection, new, now)
    values = {
        "state": JobState.DONE.value,
        "finished_at": now,
        "message": f"model version {model.version}, trained on {model.n_shapes:,} shapes",
        "result": {"model_version": model.version, "n_shapes": model.n_shapes},
    }
    done = to_job(connection.execute(update_job(job_id, values)).one())
    evaluation, is_new = enqueue(connection, known.collection_id, JobKind.EVALUATE, None, now)
    payload = {"model_version": model.version, "n_shapes": model.n_shapes, "job_id": job_id}
    published = NewEvent(EventKind.TRAINING, known.collection_id, payload)
    append_events(connection, [published, job_event(done), *([job_event(evaluation)] if is_new else [])], now)
    return model
