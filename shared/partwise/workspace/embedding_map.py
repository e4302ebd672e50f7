"""Where shapes lie beside each other, in two dimensions, for people to look at.

The stored embedding is large; what the map needs of it is put beside it on first use.
"""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float32, Int64
from safetensors.numpy import load, save

from partwise.errors import NotFoundError
from partwise.store.records import Collection
from partwise.workspace.workspace import Workspace

_ENDING = ".safetensors"


@dataclass(frozen=True, slots=True, eq=False)
class EmbeddingMap:
    """shape_ids : (n,) int64, ascending. points : (n, 2) float32 along the directions of most variance, in units of the
    embedding. key : which stored embedding it is of.
    """

    key: str
    shape_ids: Int64[np.ndarray, " n"]
    points: Float32[np.ndarray, "n 2"]


def embedding_key(workspace: Workspace, collection: Collection) -> str:
    """Which stored embedding of the collection is the present one.

    Raises
    ------
    NotFoundError : it was never embedded.
    """
    found = workspace.catalog.embedding(collection.id)
    if found is None:
        raise NotFoundError(f"collection {collection.name!r} has no embedding yet; run `partwise select`")
    return found.key


def read_embedding_map(workspace: Workspace, key: str) -> EmbeddingMap:
    """The map of a stored embedding.

    Raises
    ------
    NotFoundError : it is no longer stored. StoreError : the store cannot be read.
    """
    map_key = f"{key.removesuffix(_ENDING)}.map{_ENDING}"
    if not workspace.arrays.exists(map_key):
        workspace.arrays.put_bytes(map_key, save(_drawn(load(workspace.arrays.get_bytes(key)))))
    arrays = load(workspace.arrays.get_bytes(map_key))
    return EmbeddingMap(key, arrays["shape_ids"], arrays["points"])


def _drawn(embedding: dict[str, np.ndarray]) -> dict[str, np.ndarray]:
    order = np.argsort(embedding["shape_ids"])
    points = np.zeros((len(order), 2), dtype=np.float32)
    first = embedding["points"][order][:, :2]  # a single direction where only two shapes differ
    points[:, : first.shape[1]] = first
    return {"shape_ids": embedding["shape_ids"][order], "points": points}
