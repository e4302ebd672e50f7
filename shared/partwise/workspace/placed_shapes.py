"""Where the shapes of a collection lie in its embedding, as the array store has it.

`embeddings/<collection>/<fit>/embedding.safetensors` has the directions, some 100 MB, written once a fit. Beside it,
`<points>.safetensors` has where shapes lie, written anew as shapes are placed; the catalog names that object. The one
before it is kept, as a page may be in the middle of it; older ones are deleted.
"""

import hashlib
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from jaxtyping import Float32, Float64, Int64
from safetensors.numpy import load, save

from partwise.errors import NotFoundError
from partwise.selection.clustering import nearest_centres
from partwise.selection.embedding import Embedding
from partwise.store.records import Collection
from partwise.workspace.embedding_map import embedding_key
from partwise.workspace.light_fields import described_runs, light_fields
from partwise.workspace.shapes import PAGE
from partwise.workspace.workspace import Workspace

_ENDING = ".safetensors"
_EMBEDDING = f"embedding{_ENDING}"


@dataclass(frozen=True, slots=True, eq=False)
class PlacedShapes:
    """shape_ids : (n,) int64. points : (n, k) float32, in units of the embedding.

    centres : (c, k) float64, of the clusters. n_fitted : how many of the shapes the embedding was fitted for.
    """

    shape_ids: Int64[np.ndarray, " n"]
    points: Float32[np.ndarray, "n k"]
    centres: Float64[np.ndarray, "c k"]
    n_fitted: int

    @property
    def n_clusters(self) -> int:
        return len(self.centres)


def store_fit(workspace: Workspace, collection: Collection, embedding: Embedding, placed: PlacedShapes) -> None:
    """Puts a new embedding in the place of the collection's, with where its shapes lie."""
    stored = save(embedding.to_arrays())
    folder = f"{_folder(collection)}/{hashlib.sha256(stored).hexdigest()}"
    workspace.arrays.put_bytes(f"{folder}/{_EMBEDDING}", stored)
    before = workspace.catalog.embedding(collection.id)
    key = _put_placed(workspace, folder, placed)
    workspace.catalog.set_embedding(collection.id, key)
    kept = [key] if before is None else [key, before.key]
    _sweep(workspace, _folder(collection), [f"{folder}/{_EMBEDDING}", *kept])


def read_placed(workspace: Workspace, key: str) -> PlacedShapes | None:
    """What is stored under an embedding's key; None where it was lost, or stored without what placing more needs.

    Raises
    ------
    StoreError : the store cannot be read.
    """
    try:
        arrays = load(workspace.arrays.get_bytes(key))
    except NotFoundError:
        return None
    if "centres" not in arrays:
        return None
    return PlacedShapes(arrays["shape_ids"], arrays["points"], arrays["centres"], int(arrays["n_fitted"][0]))


def place_new_shapes(workspace: Workspace, collection: Collection) -> int:
    """Places the shapes that were described since, without fitting anew; how many those are.

    Each is of the cluster with the nearest centre. Where the embedding was replaced meanwhile, nothing is placed.

    Raises
    ------
    NotFoundError : nothing was embedded, or it is lost. StoreError : a store cannot be reached.
    """
    key = embedding_key(workspace, collection)
    placed, folder = read_placed(workspace, key), key.rpartition("/")[0]
    if placed is None:
        raise NotFoundError(f"the embedding {key} must be stored to place shapes in it but is not; fit it anew")
    known = set(placed.shape_ids.tolist())
    new = [run for run in described_runs(workspace, collection) if run.shape_id not in known]
    if not new:
        return 0
    embedding = Embedding.from_arrays(load(workspace.arrays.get_bytes(f"{folder}/{_EMBEDDING}")))
    points = np.concatenate([embedding.project(batch) for batch in light_fields(workspace, new)])
    shape_ids = np.array([run.shape_id for run in new], dtype=np.int64)
    with_new = replace(
        placed,
        shape_ids=np.concatenate([placed.shape_ids, shape_ids]),
        points=np.concatenate([placed.points, points]),
    )
    with_new_key = _put_placed(workspace, folder, with_new)
    if not workspace.catalog.set_embedding(collection.id, with_new_key, replacing=key):
        return 0  # what was put stays for the next sweep: whoever placed the same meanwhile named the same key
    _sweep(workspace, folder, [f"{folder}/{_EMBEDDING}", key, with_new_key])  # another fit may be on its way beside it
    record_clusters(workspace, collection, shape_ids, nearest_centres(points, placed.centres))
    return len(new)


def record_clusters(
    workspace: Workspace, collection: Collection, shape_ids: Int64[np.ndarray, " n"], clusters: Int64[np.ndarray, " n"]
) -> None:
    """Puts the cluster of each shape on record, in pieces, as others wait while it writes."""
    for start in range(0, len(shape_ids), PAGE):
        some = slice(start, start + PAGE)
        of_shapes = dict(zip(shape_ids[some].tolist(), clusters[some].tolist(), strict=True))
        workspace.catalog.set_clusters(collection.id, of_shapes)


def _put_placed(workspace: Workspace, folder: str, placed: PlacedShapes) -> str:
    """The key of what it has put there."""
    arrays = {"shape_ids": placed.shape_ids, "points": placed.points, "centres": placed.centres}
    stored = save({**arrays, "n_fitted": np.array([placed.n_fitted], dtype=np.int64)})
    key = f"{folder}/{hashlib.sha256(stored).hexdigest()}{_ENDING}"
    workspace.arrays.put_bytes(key, stored)
    return key


def _sweep(workspace: Workspace, folder: str, kept: Sequence[str]) -> None:
    """Deletes what is in the folder and not kept, nor belongs to what is."""
    names = tuple(key.removesuffix(_ENDING) for key in kept)
    for key in workspace.arrays.list(folder):
        if not key.startswith(names):
            workspace.arrays.delete(key)


def _folder(collection: Collection) -> str:
    return f"embeddings/{collection.id}"
