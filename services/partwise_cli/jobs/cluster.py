"""`Cluster`: Ray, started for the first job that needs it and kept for those after it, or joined where it runs."""

import logging
import os
import time
from collections.abc import Callable
from contextlib import ExitStack

from partwise.errors import WorkerError

logger = logging.getLogger(__name__)

AGAIN_S = 60.0
"""Seconds between two tries to join a cluster while no job needs it: each may take some."""


class Cluster:
    """connected : runs after Ray has been started, which takes over signals of the process."""

    def __init__(
        self, connected: Callable[[], None] = lambda: None, clock: Callable[[], float] = time.monotonic
    ) -> None:
        self._resources: ExitStack | None = None
        self._connected = connected
        self._clock = clock
        self._join_at = clock()

    def connect(self) -> None:
        """Starts Ray, or joins the cluster of `RAY_ADDRESS`, unless that is done.

        Raises
        ------
        WorkerError : it cannot be started or reached.
        """
        if self._resources is not None:
            return
        from partwise_workers.cluster import connected

        with ExitStack() as resources:
            resources.enter_context(connected())
            self._resources = resources.pop_all()
        self._connected()

    def join(self) -> None:
        """Joins the cluster that `RAY_ADDRESS` names, if it names one: metrics go through it between jobs, too.

        One that cannot be reached is tried again a minute later.
        """
        if self.is_connected or not os.environ.get("RAY_ADDRESS") or self._clock() < self._join_at:
            return
        self._join_at = self._clock() + AGAIN_S
        try:
            self.connect()
        except WorkerError as error:
            logger.warning("figures are not told yet: %s", error)

    @property
    def is_connected(self) -> bool:
        return self._resources is not None

    def close(self) -> None:
        """Lets go of it: the next job starts another."""
        resources, self._resources = self._resources, None
        if resources is not None:
            resources.close()
