"""Which shapes a new model should see first: those most like what was confirmed since the model before it.

Where labels changed, predictions change most; the embedding that chose the first shapes says what is alike.
"""

import numpy as np
from jaxtyping import Float, Float32, Int64
from safetensors.numpy import load

from partwise.errors import NotFoundError
from partwise.store.records import Collection, Model
from partwise.workspace.shapes import pages_of_shapes
from partwise.workspace.workspace import Workspace

MAX_REFERENCES = 256
"""Newly confirmed shapes that others are compared with, the newest ones: more would cost time and change little."""

_ROWS_AT_ONCE = 4096


def most_similar_first(workspace: Workspace, collection: Collection, model: Model) -> list[int]:
    """Ids of all shapes of the collection, by distance in the embedding to the nearest newly confirmed shape.

    Shapes that are not embedded come last, by id; so do all where nothing is embedded or nothing is new.

    Raises
    ------
    StoreError : the embedding cannot be read.
    """
    all_ids = [shape.id for page in pages_of_shapes(workspace.catalog, collection.id) for shape in page]
    embedded = _embedded(workspace, collection)
    if embedded is None:
        return all_ids
    shape_ids, points = embedded
    is_new = np.isin(shape_ids, newly_confirmed(workspace, collection, model))
    if not is_new.any():
        return all_ids
    order = np.lexsort((shape_ids, nearest_distances(points, points[is_new])))
    near = shape_ids[order].tolist()
    known, placed = set(all_ids), set(near)
    return [*(each for each in near if each in known), *(each for each in all_ids if each not in placed)]


def newly_confirmed(workspace: Workspace, collection: Collection, model: Model) -> list[int]:
    """Shapes with labels that the model learned from and the one before it had not, the newest labels first."""
    catalog, before = workspace.catalog, set[int]()
    if model.version > 1:
        before.update(catalog.trained_on(catalog.model(collection.id, model.version - 1).id))
    new = sorted(set(catalog.trained_on(model.id)) - before, reverse=True)[:MAX_REFERENCES]
    return [catalog.revision(revision_id).shape_id for revision_id in new]


def nearest_distances(
    points: Float[np.ndarray, "n d"], references: Float[np.ndarray, "r d"]
) -> Float[np.ndarray, " n"]:
    """Euclidean distance of each point to the nearest reference, (n,) float64, in the points' units; r ≥ 1."""
    targets = references.astype(np.float64)
    squared_lengths = np.einsum("rd,rd->r", targets, targets)
    nearest = np.empty(len(points))
    for start in range(0, len(points), _ROWS_AT_ONCE):
        some = points[start : start + _ROWS_AT_ONCE].astype(np.float64)
        squared = np.einsum("nd,nd->n", some, some)[:, None] - 2 * some @ targets.T + squared_lengths
        nearest[start : start + _ROWS_AT_ONCE] = np.sqrt(np.maximum(squared.min(axis=1), 0))
    return nearest


def _embedded(
    workspace: Workspace, collection: Collection
) -> tuple[Int64[np.ndarray, " n"], Float32[np.ndarray, "n d"]] | None:
    found = workspace.catalog.embedding(collection.id)
    if found is None:
        return None
    try:
        arrays = load(workspace.arrays.get_bytes(found.key))
    except NotFoundError:  # lost with the array store: the order is a courtesy
        return None
    return arrays["shape_ids"], arrays["points"]
