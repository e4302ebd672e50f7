"""`Figures`: how collections are doing, as metrics, told from a thread of its own while a worker works or waits."""

import logging
import threading
from datetime import UTC, datetime
from types import TracebackType
from typing import Self

from partwise.errors import StoreError
from partwise.workspace.figures import collection_figures, stored_bytes
from partwise.workspace.workspace import Workspace
from partwise_cli.jobs.cluster import Cluster

logger = logging.getLogger(__name__)

EVERY_S = 60.0
"""Some figures are counted over all shapes."""


class Figures:
    """While the block lasts. Ray exports what is told: before the first job that needs it, nothing is."""

    def __init__(self, workspace: Workspace, cluster: Cluster, every_s: float = EVERY_S) -> None:
        self._workspace = workspace
        self._cluster = cluster
        self._every_s = every_s
        self._has_ended = threading.Event()
        self._thread = threading.Thread(target=self._go_on, name="figures", daemon=True)

    def __enter__(self) -> Self:
        self._thread.start()
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self._has_ended.set()
        self._thread.join()

    def _go_on(self) -> None:
        while not self._has_ended.wait(self._every_s):
            if self._cluster.is_connected:
                try:
                    self.tell()
                except StoreError as error:
                    logger.warning("figures are not told: %s", error)

    def tell(self) -> None:
        """All figures, once. Needs a connected Ray."""
        from partwise_workers.metrics import CollectionMetrics

        metrics, now = CollectionMetrics(), datetime.now(UTC)
        for collection in self._workspace.catalog.list_collections():
            metrics.tell(collection.name, collection_figures(self._workspace, collection, now))
        metrics.tell_stored(stored_bytes(self._workspace))
