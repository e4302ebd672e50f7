"""`Pulse`: tells the catalog, from a thread of its own, that a job is worked on and how far it is.

What works on the job tells its progress as often as it likes, and asks whether to stop: neither touches the database.
"""

import logging
import time
from collections.abc import Callable

from partwise.config import JobsConfig
from partwise.errors import ConflictError, StoreError
from partwise.store.catalog import JobCatalog
from partwise.store.records import Job, Progress
from partwise_cli.jobs.repeated import Repeated
from partwise_cli.jobs.stopping import JobStoppedError, StopReason

logger = logging.getLogger(__name__)


class Pulse(Repeated):
    """Of one job while the block lasts."""

    def __init__(
        self,
        catalog: JobCatalog,
        job: Job,
        owner: str,
        config: JobsConfig,
        clock: Callable[[], float] = time.monotonic,
    ) -> None:
        super().__init__(f"pulse of job {job.id}", config.pulse_s)
        self._catalog = catalog
        self._job_id = job.id
        self._owner = owner
        self._config = config
        self._clock = clock
        self._heard_at = clock()
        self._progress: Progress | None = None
        self._why: tuple[StopReason, str] | None = None

    def tell(self, progress: Progress) -> None:
        """How far the job is; the last one told goes out with the next sign of life."""
        self._progress = progress

    @property
    def is_stopped(self) -> bool:
        """Whether the work on the job should end."""
        return self._why is not None

    def raise_if_stopped(self) -> None:
        """Raises JobStoppedError if the work on the job should end."""
        if self._why is not None:
            raise JobStoppedError(*self._why)

    def act(self) -> None:
        if not self.is_stopped:
            self.give()

    def give(self) -> None:
        """One sign of life. Where the catalog cannot be reached for long, the job counts as lost, as it does there."""
        try:
            job = self._catalog.heartbeat_job(self._job_id, self._owner, self._progress)
        except ConflictError as error:
            self._why = (StopReason.LOST, str(error))
        except StoreError as error:
            if self._clock() - self._heard_at >= self._config.lost_after_s:
                self._why = (StopReason.LOST, f"the catalog must be reachable to work on a job but: {error}")
            logger.warning("no sign of life of a job: %s", error, extra={"job": self._job_id})
        else:
            self._heard_at = self._clock()
            if job.cancel_requested:
                self._why = (StopReason.CANCELLED, "cancelled; what was finished is kept")
