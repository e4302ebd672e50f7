"""`Presence`: tells the catalog that a worker is there and what it takes of its machine, at work or waiting.

It also lets jobs of owners that are silent be begun again: all workers may be at jobs that take days.
"""

import logging
import os
from datetime import timedelta
from types import TracebackType
from typing import Self

from partwise.errors import PartwiseError, StoreError
from partwise.store.catalog import JobCatalog
from partwise.store.records import WorkerUsage
from partwise.workspace.disk import free_bytes
from partwise_cli.jobs.repeated import Repeated
from partwise_workers.events import ActorMemory, RunEvent
from partwise_workers.sentinel import resident_bytes

logger = logging.getLogger(__name__)

EVERY_S = 10.0


class Presence(Repeated):
    """Of one worker while the block lasts, from a thread of its own.

    array_url : of the workspace's array store. lost_after : of silence an owner of a job counts as lost.
    """

    def __init__(
        self, catalog: JobCatalog, owner: str, array_url: str, lost_after: timedelta, every_s: float | None = None
    ) -> None:
        super().__init__(f"presence of {owner}", EVERY_S if every_s is None else every_s)
        self._catalog = catalog
        self._owner = owner
        self._array_url = array_url
        self._lost_after = lost_after
        self._actors = ActorMemory(0, 0)

    def __enter__(self) -> Self:
        self.act()
        return super().__enter__()

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        super().__exit__(kind, error, trace)
        try:
            self._catalog.forget_worker(self._owner)
        except StoreError as failure:  # it is forgotten in a day
            logger.warning("that a worker has ended is not on record: %s", failure)

    def on_event(self, event: RunEvent, /) -> None:
        """Implements `OnEvent`: what the processes that compute take goes out with the next sign."""
        if isinstance(event, ActorMemory):
            self._actors = event

    def usage(self) -> WorkerUsage:
        """What is taken now."""
        actors = self._actors
        return WorkerUsage(
            resident_bytes(os.getpid()), actors.n_actors, actors.resident_bytes, free_bytes(self._array_url)
        )

    def act(self) -> None:
        try:
            self._catalog.note_worker(self._owner, self.usage())
            for lost in self._catalog.requeue_lost_jobs(self._lost_after):
                logger.warning("job %d: %s", lost.id, lost.progress.message)
        except PartwiseError as error:  # the thread's edge: the next turn may fare better
            logger.warning("a worker's sign of life is not on record: %s", error)
