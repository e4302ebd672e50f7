"""`Figures`: how collections are doing, as metrics, told from a thread of its own while a worker works or waits."""

import logging
from datetime import UTC, datetime

from partwise.errors import StoreError
from partwise.workspace.figures import collection_figures, stored_bytes
from partwise.workspace.workspace import Workspace
from partwise_cli.jobs.cluster import Cluster
from partwise_cli.jobs.repeated import Repeated

logger = logging.getLogger(__name__)

EVERY_S = 60.0
"""Some figures are counted over all shapes."""


class Figures(Repeated):
    """While the block lasts. Ray exports what is told: nothing is until a job needs it, or an idle worker joins it."""

    def __init__(self, workspace: Workspace, cluster: Cluster, every_s: float = EVERY_S) -> None:
        super().__init__("figures", every_s)
        self._workspace = workspace
        self._cluster = cluster

    def act(self) -> None:
        if not self._cluster.is_connected:
            return
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
