"""`Worker`: claims jobs one after the other and does them, until it is told to stop."""

import logging
import os
import secrets
import socket
import threading
from collections.abc import Callable, Collection, Mapping, Sequence
from datetime import timedelta

from partwise.errors import ConflictError, NotFoundError, PartwiseError, StoreError, WorkerError
from partwise.store.records import WHY, Job, JobKind, JobState
from partwise.store.records import Collection as ShapeCollection
from partwise.workspace.workspace import Workspace
from partwise_cli.failures import ending_of, is_of_ray
from partwise_cli.jobs.cluster import Cluster
from partwise_cli.jobs.presence import Presence
from partwise_cli.jobs.pulse import Pulse
from partwise_cli.jobs.stopping import JobStoppedError, StopReason
from partwise_cli.jobs.work import Handler, Work

logger = logging.getLogger(__name__)

BACKOFF = 5
"""Times as long is waited after each attempt at a job that failed for reasons outside of it."""

NAMES_FILES = frozenset({JobKind.INGEST, JobKind.EXPORT})
"""Jobs of operators, whose errors name files that others need not know of."""

STOPPED = "its worker was stopped; it will be begun again"


def new_owner() -> str:
    """A name for this process that no other has or will have: `host:process:random`."""
    return f"{socket.gethostname()[:100]}:{os.getpid()}:{secrets.token_hex(4)}"


class Worker:
    """Does jobs of the kinds that it has handlers for.

    collection_id : only of this collection. on_job : told a job when it is begun and as it is left.
    """

    def __init__(
        self,
        workspace: Workspace,
        handlers: Mapping[JobKind, Handler],
        cluster: Cluster,
        *,
        kinds: Collection[JobKind] | None = None,
        collection_id: int | None = None,
        owner: str | None = None,
        on_job: Callable[[Job], None] = lambda _: None,
    ) -> None:
        self.owner = owner or new_owner()
        self._workspace = workspace
        self._catalog = workspace.catalog
        self._handlers = handlers
        self._kinds: Sequence[JobKind] = [kind for kind in handlers if kinds is None or kind in kinds]
        self._collection_id = collection_id
        self._cluster = cluster
        self._on_job = on_job
        lost_after = timedelta(seconds=workspace.config.jobs.lost_after_s)
        self._presence = Presence(workspace.catalog, self.owner, workspace.array_url, lost_after)
        self._never = threading.Event()

    def run(self, *, once: bool = False) -> None:
        """Works until it is interrupted, or with `once` until nothing waits. What it has in hand is then begun again.

        A catalog that cannot be reached is waited for, unless `once`.
        """
        try:
            with self._presence:
                self._go_on(once)
        finally:
            self._let_go()

    def _go_on(self, once: bool) -> None:
        while True:
            try:
                has_worked = self.work_once()
            except StoreError as error:
                if once:
                    raise
                logger.warning("waiting for the catalog: %s", error)
                has_worked = False
            if once and not has_worked:
                return
            if not has_worked:
                self._cluster.join()
                self._never.wait(self._workspace.config.jobs.poll_s)

    def work_once(self) -> bool:
        """Claims the next job and does it; whether there was one."""
        job = self._catalog.claim_job(self.owner, self._kinds, collection_id=self._collection_id)
        if job is None:
            return False
        self._on_job(job)
        self._do(job)
        self._on_job(self._catalog.job(job.id))
        return True

    def _do(self, job: Job) -> None:
        try:
            with Pulse(self._catalog, job, self.owner, self._workspace.config.jobs) as pulse:
                outcome = self._handlers[job.kind](self._work(job, pulse))
            if outcome is not None:
                self._catalog.finish_job(
                    job.id, self.owner, JobState.DONE, message=outcome.message, result=outcome.result
                )
        except JobStoppedError as stopped:
            self._stop(job, stopped)
        except Exception as error:  # noqa: BLE001 - a job's edge: the worker outlives whatever a job does
            self._fail(job, error)

    def _work(self, job: Job, pulse: Pulse) -> Work:
        return Work(
            self._workspace,
            _collection(self._workspace, job.collection_id),
            job,
            self.owner,
            self._kinds,
            self._collection_id,
            pulse,
            self._cluster.connect,
            self._presence.on_event,
        )

    def _stop(self, job: Job, stopped: JobStoppedError) -> None:
        try:
            if stopped.reason is StopReason.CANCELLED:
                self._catalog.finish_job(job.id, self.owner, JobState.CANCELLED, message=str(stopped))
            elif stopped.reason is StopReason.GIVES_WAY:
                self._catalog.release_jobs(self.owner, str(stopped))
            else:
                logger.warning("job %d is left alone: %s", job.id, stopped)
        except ConflictError as error:  # lost in this very moment
            logger.warning("job %d is left alone: %s", job.id, error)

    def _fail(self, job: Job, error: Exception) -> None:
        """Puts on record why a job cannot go on; one that may fare better later goes back."""
        ending = ending_of(error)
        is_for_all = ending.is_domain and job.kind not in NAMES_FILES
        message = ending.message if is_for_all else f"{job.kind} could not be done; an operator can see why"
        result = None if is_for_all else {WHY: ending.message}
        is_passing = isinstance(error, StoreError | WorkerError | OSError) or is_of_ray(error)
        if ending.is_fault:
            logger.error("job %d: a fault", job.id, exc_info=error)
        if is_of_ray(error) or isinstance(error, WorkerError):
            self._cluster.close()  # the next job gets another
        try:
            if is_passing:
                returned = self._catalog.return_job(job.id, self.owner, message, result=result)
                if not returned.is_over:  # what is in the way may take a while to go
                    self._never.wait(self._workspace.config.jobs.poll_s * BACKOFF**job.attempts)
            else:
                self._catalog.finish_job(job.id, self.owner, JobState.FAILED, message=message, result=result)
        except ConflictError as late:
            logger.warning("job %d is left alone: %s", job.id, late)
        except StoreError as gone:
            logger.warning("the end of job %d is not on record; it will count as lost: %s", job.id, gone)

    def _let_go(self) -> None:
        try:
            self._catalog.release_jobs(self.owner, STOPPED)
        except PartwiseError as error:
            logger.warning("its job will count as lost: %s", error)
        self._cluster.close()


def _collection(workspace: Workspace, collection_id: int) -> ShapeCollection:
    for collection in workspace.catalog.list_collections():
        if collection.id == collection_id:
            return collection
    raise NotFoundError(f"a job's collection must be there but {collection_id} is not; was the catalog restored?")
