"""Jobs."""

from collections.abc import Mapping, Sequence
from datetime import datetime, timedelta
from typing import Any

from partwise.store import records as r
from partwise.store.engine import reading, writing
from partwise.store.sql import claims, jobs, returns, trainings, workers
from partwise.store.sql_catalog.base import SqlBase


class SqlJobCatalog(SqlBase):
    def enqueue_job(self, collection_id: int, kind: r.JobKind, parameters: Mapping[str, Any] | None = None) -> r.Job:
        with writing(self._engine) as connection:
            return jobs.enqueue_job(connection, collection_id, kind, parameters, self._clock())

    def job(self, job_id: int) -> r.Job:
        with reading(self._engine) as connection:
            return jobs.job(connection, job_id)

    def jobs(
        self, collection_id: int, *, before: int | None = None, limit: int = 100, state: r.JobState | None = None
    ) -> Sequence[r.Job]:
        with reading(self._engine) as connection:
            return jobs.jobs(connection, collection_id, before, limit, state)

    def claim_job(
        self, owner: str, kinds: Sequence[r.JobKind] | None = None, *, collection_id: int | None = None
    ) -> r.Job | None:
        with writing(self._engine) as connection:
            return claims.claim_job(connection, owner, kinds, collection_id, self._clock())

    def next_job(self, kinds: Sequence[r.JobKind] | None = None, *, collection_id: int | None = None) -> r.Job | None:
        with reading(self._engine) as connection:
            return claims.next_job(connection, kinds, collection_id)

    def heartbeat_job(self, job_id: int, owner: str, progress: r.Progress | None = None) -> r.Job:
        with writing(self._engine) as connection:
            return jobs.heartbeat_job(connection, job_id, owner, progress, self._clock())

    def finish_job(
        self, job_id: int, owner: str, state: r.JobState, *, message: str = "", result: Mapping[str, Any] | None = None
    ) -> r.Job:
        with writing(self._engine) as connection:
            return jobs.finish_job(connection, job_id, owner, state, message, result, self._clock())

    def finish_training(self, job_id: int, owner: str, model: r.NewModel) -> r.Model:
        with writing(self._engine) as connection:
            return trainings.finish_training(connection, job_id, owner, model, self._clock())

    def release_jobs(self, owner: str, message: str) -> Sequence[r.Job]:
        with writing(self._engine) as connection:
            return returns.release_jobs(connection, owner, message, self._clock())

    def return_job(
        self, job_id: int, owner: str, message: str, *, result: Mapping[str, Any] | None = None, max_attempts: int = 3
    ) -> r.Job:
        with writing(self._engine) as connection:
            return returns.return_job(connection, job_id, owner, message, result, max_attempts, self._clock())

    def cancel_job(self, job_id: int) -> r.Job:
        with writing(self._engine) as connection:
            return jobs.cancel_job(connection, job_id, self._clock())

    def retry_job(self, job_id: int) -> r.Job:
        with writing(self._engine) as connection:
            return jobs.retry_job(connection, job_id, self._clock())

    def requeue_lost_jobs(self, silent_for: timedelta, *, max_attempts: int = 3) -> Sequence[r.Job]:
        with writing(self._engine) as connection:
            return returns.requeue_lost_jobs(connection, silent_for, max_attempts, self._clock())

    def note_worker(self, owner: str, usage: r.WorkerUsage) -> None:
        with writing(self._engine) as connection:
            workers.note_worker(connection, owner, usage, self._clock())

    def forget_worker(self, owner: str) -> None:
        with writing(self._engine) as connection:
            workers.forget_worker(connection, owner)

    def workers(self, seen_since: datetime) -> Sequence[r.SeenWorker]:
        with reading(self._engine) as connection:
            return workers.workers(connection, seen_since)
