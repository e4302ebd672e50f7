"""`EmbeddingMaps`: the maps looked at last, in memory."""

from collections import OrderedDict
from threading import Lock

from partwise.workspace.embedding_map import EmbeddingMap, read_embedding_map
from partwise.workspace.workspace import Workspace


class EmbeddingMaps:
    """Keeps a few maps, 16 bytes a shape, so that their pages need no store. Threads may share it."""

    def __init__(self, max_maps: int = 8) -> None:
        self._maps: OrderedDict[str, EmbeddingMap] = OrderedDict()
        self._max_maps = max_maps
        self._lock = Lock()

    def get(self, workspace: Workspace, key: str) -> EmbeddingMap:
        """The map of a stored embedding; errors as `read_embedding_map`."""
        with self._lock:
            if key in self._maps:
                self._maps.move_to_end(key)
                return self._maps[key]
        found = read_embedding_map(workspace, key)
        with self._lock:
            self._maps[key] = found
            while len(self._maps) > self._max_maps:
                self._maps.popitem(last=False)
        return found
