"""`Cluster`: Ray, started for the first job that needs it and kept for those after it."""

from collections.abc import Callable
from contextlib import ExitStack


class Cluster:
    """connected : runs after Ray has been started, which takes over signals of the process."""

    def __init__(self, connected: Callable[[], None] = lambda: None) -> None:
        self._resources: ExitStack | None = None
        self._connected = connected

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

    @property
    def is_connected(self) -> bool:
        return self._resources is not None

    def close(self) -> None:
        """Lets go of it: the next job starts another."""
        resources, self._resources = self._resources, None
        if resources is not None:
            resources.close()
