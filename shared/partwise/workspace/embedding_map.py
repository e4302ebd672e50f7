"""Where shapes lie beside each other, in two dimensions, for people to look at.

The stored embedding is large; what the map needs of it is put beside it on first use.
"""

from collections.abc import Sequence
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
        raise NotFoundError(
            f"collection {collection.name!r} has no embedding yet; preprocess shapes, or run `partwise select`"
        )
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


def spread_out(drawn: EmbeddingMap, shape_ids: Sequence[int], n_wanted: int) -> list[int]:
    """So many of the shapes as far apart on the map as can be: from the middle of them on, each farthest from the rest.

    Shapes that are not on the map are left out. Source: Gonzalez 1985, within twice the best radius.
    """
    rows = np.flatnonzero(np.isin(drawn.shape_ids, np.asarray(shape_ids, dtype=np.int64)))
    if not len(rows):
        return []
    points = drawn.points[rows].astype(np.float64)
    taken = [int(np.argmin(np.linalg.norm(points - points.mean(axis=0), axis=1)))]
    distances = np.linalg.norm(points - points[taken[0]], axis=1)
    while len(taken) < min(n_wanted, len(rows)):
        distances[taken] = -1.0  # of shapes in the very same place each may be taken
        taken.append(int(np.argmax(distances)))
        distances = np.minimum(distances, np.linalg.norm(points - points[taken[-1]], axis=1))
    return drawn.shape_ids[rows[taken]].tolist()


def _drawn(embedding: dict[str, np.ndarray]) -> dict[str, np.ndarray]:
    order = np.argsort(embedding["shape_ids"])
    points = np.zeros((len(order), 2), dtype=np.float32)
    first = embedding["points"][order][:, :2]  # a single direction where only two shapes differ
    points[:, : first.shape[1]] = first
    return {"shape_ids": embedding["shape_ids"][order], "points": points}
