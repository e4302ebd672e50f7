"""Jobs: rows that workers pick up."""

from collections.abc import Mapping, Sequence
from datetime import datetime
from typing import Any, Protocol

from partwise.store.records import Job, JobKind, JobState, Progress


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

    def claim_job(self, owner: str, kinds: Sequence[JobKind] | None = None) -> Job | None:
        """Begin the oldest pending job of these kinds, any if None; None if there is none.

        Of `COALESCED_KINDS` one job of a kind runs at a time in a collection. A training that begins covers all that
        was confirmed until then.
        """
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

    def cancel_job(self, job_id: int) -> Job:
        """Cancel a pending job, or ask the owner of a running one to stop. `ConflictError` if it is over."""
        ...

    def retry_job(self, job_id: int) -> Job:
        """Enqueue a failed or cancelled job's work again, as a new job. `ConflictError` unless it ended so."""
        ...

    def requeue_lost_jobs(self, silent_since: datetime, *, max_attempts: int = 3) -> Sequence[Job]:
        """Let running jobs without a heartbeat since then be begun again; as they are then.

        One that was begun `max_attempts` times fails. One beside which another of its kind waits is cancelled, as that
        one does its work.
        """
        ...
