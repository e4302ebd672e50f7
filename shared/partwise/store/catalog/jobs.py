"""Jobs: rows that workers pick up."""

from collections.abc import Mapping, Sequence
from datetime import datetime, timedelta
from typing import Any, Protocol

from partwise.store.records import Job, JobKind, JobState, Model, NewModel, Progress, SeenWorker, WorkerUsage


class JobCatalog(Protocol):
    """Jobs. A running job has one owner, who says now and then that it still works on it."""

    def enqueue_job(self, collection_id: int, kind: JobKind, parameters: Mapping[str, Any] | None = None) -> Job:
        """A pending job. Of `COALESCED_KINDS` the one that waits already is returned, with the parameters if given."""
        ...

    def job(self, job_id: int) -> Job: ...

    def jobs(
        self, collection_id: int, *, before: int | None = None, limit: int = 100, state: JobState | None = None
    ) -> Sequence[Job]:
        """A page of jobs, newest first; `before` is the last id of the page before."""
        ...

    def claim_job(
        self, owner: str, kinds: Sequence[JobKind] | None = None, *, collection_id: int | None = None
    ) -> Job | None:
        """Begin the pending job that has waited longest, of these kinds and this collection, any if None.

        None if there is none. `BACKGROUND_KINDS` come after all others. Of `COALESCED_KINDS` one job of a kind runs at
        a time in a collection. A training that begins covers all that was confirmed until then.
        """
        ...

    def next_job(self, kinds: Sequence[JobKind] | None = None, *, collection_id: int | None = None) -> Job | None:
        """The job that `claim_job` would begin now; it is left as it is."""
        ...

    def heartbeat_job(self, job_id: int, owner: str, progress: Progress | None = None) -> Job:
        """Say that the job is still worked on, and how far it is. Look at `cancel_requested` of what comes back.

        Raises `ConflictError` if the job is over or another owner's: then stop working on it.
        """
        ...

    def finish_job(
        self, job_id: int, owner: str, state: JobState, *, message: str = "", result: Mapping[str, Any] | None = None
    ) -> Job:
        """End a job as done, failed or cancelled.

        Raises `ConflictError` as `heartbeat_job`, `ParameterError` for a state that is no end.
        """
        ...

    def finish_training(self, job_id: int, owner: str, model: NewModel) -> Model:
        """End a training as done with its model published and an evaluation asked for: all or nothing.

        So a job that was begun twice publishes one model. Raises `ConflictError` as `heartbeat_job`.
        """
        ...

    def release_jobs(self, owner: str, message: str) -> Sequence[Job]:
        """Let the jobs that an owner has begun be begun again, without counting this time; as they are then.

        One that was to be cancelled is, and so is one beside which another of its kind waits.
        """
        ...

    def return_job(
        self, job_id: int, owner: str, message: str, *, result: Mapping[str, Any] | None = None, max_attempts: int = 3
    ) -> Job:
        """As `release_jobs` of one job that could not be done now: it counts, and fails if begun `max_attempts` times.

        result : what is known of why, until it is begun again.
        Raises `ConflictError` as `heartbeat_job`.
        """
        ...

    def cancel_job(self, job_id: int) -> Job:
        """Cancel a pending job, or ask the owner of a running one to stop. `ConflictError` if it is over."""
        ...

    def retry_job(self, job_id: int) -> Job:
        """Enqueue a failed or cancelled job's work again, as a new job. `ConflictError` unless it ended so."""
        ...

    def requeue_lost_jobs(self, silent_for: timedelta, *, max_attempts: int = 3) -> Sequence[Job]:
        """Let running jobs without a heartbeat for longer than this be begun again; as they are then.

        Heartbeats are told and compared in the database's own time, as hosts' clocks differ.
        One that was begun `max_attempts` times fails. One beside which another of its kind waits is cancelled, as that
        one does its work.
        """
        ...

    def note_worker(self, owner: str, usage: WorkerUsage) -> None:
        """A process that does jobs is there, and takes this; it says so again every few seconds."""
        ...

    def forget_worker(self, owner: str) -> None:
        """It has ended."""
        ...

    def workers(self, seen_since: datetime) -> Sequence[SeenWorker]:
        """Those that have said since then that they are there, by owner."""
        ...
