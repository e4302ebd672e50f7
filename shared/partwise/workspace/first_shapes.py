"""Embeds the collection and chooses the shapes to label first."""

import hashlib
from collections.abc import Iterator

import numpy as np
from jaxtyping import UInt8
from safetensors.numpy import save

from partwise.errors import NotEnoughDataError
from partwise.selection.clustering import clustered, nearest_to_centres
from partwise.selection.embedding import fit_embedding, sample_rows
from partwise.store.records import Collection, FirstShape, StageRun
from partwise.workspace.segmentations import DESCRIBE
from partwise.workspace.shapes import PAGE, pages_of_shapes
from partwise.workspace.workspace import Workspace

LIGHT_FIELDS_AT_ONCE = 64
"""Descriptors in memory at a time, 13 MB."""


def select_first_shapes(
    workspace: Workspace, collection: Collection, n_clusters: int, n_per_cluster: int, seed: int
) -> list[FirstShape]:
    """Fits the embedding on the described shapes and clusters it.

    On record are then every shape's cluster, and the shapes nearest each centre as those to label first.

    Raises
    ------
    NotEnoughDataError : fewer described shapes than were asked for.
    """
    described = list(_described(workspace, collection))
    n_wanted = n_clusters * n_per_cluster
    if len(described) < max(2, n_wanted):
        raise NotEnoughDataError(
            f"selecting {n_clusters} × {n_per_cluster} shapes needs {max(2, n_wanted)} described ones but "
            f"{collection.name!r} has {len(described)}; run `partwise preprocess`, or ask for fewer"
        )
    sampling, fitting, seeding = np.random.default_rng(seed).spawn(3)
    sample = [described[row] for row in sample_rows(len(described), sampling)]
    embedding = fit_embedding(_light_fields(workspace, sample), fitting)
    points = np.concatenate([embedding.project(batch) for batch in _light_fields(workspace, described)])
    ids = [str(run.shape_id) for run in described]
    clustering = clustered(points, n_clusters, seeding)
    chosen = nearest_to_centres(points, ids, clustering, n_per_cluster)
    shape_ids = np.array([run.shape_id for run in described], dtype=np.int64)
    stored = save({**embedding.to_arrays(), "points": points, "shape_ids": shape_ids})
    key = f"embeddings/{collection.id}/{hashlib.sha256(stored).hexdigest()}.safetensors"
    workspace.arrays.put_bytes(key, stored)
    workspace.catalog.set_embedding(collection.id, key)
    clusters = dict(zip(shape_ids.tolist(), clustering.cluster_ids.tolist(), strict=True))
    for start in range(0, len(described), PAGE):  # in pieces, as others wait while it writes
        some = shape_ids[start : start + PAGE].tolist()
        workspace.catalog.set_clusters(collection.id, {shape_id: clusters[shape_id] for shape_id in some})
    firsts = [FirstShape(int(first.id), ordinal, first.cluster) for ordinal, first in enumerate(chosen)]
    workspace.catalog.replace_first_shapes(collection.id, firsts)
    return firsts


def _described(workspace: Workspace, collection: Collection) -> Iterator[StageRun]:
    for page in pages_of_shapes(workspace.catalog, collection.id):
        runs = workspace.catalog.stage_runs([shape.id for shape in page], DESCRIBE)
        yield from (runs[shape.id] for shape in page if shape.id in runs)


def _light_fields(workspace: Workspace, runs: list[StageRun]) -> Iterator[UInt8[np.ndarray, "b d"]]:
    for start in range(0, len(runs), LIGHT_FIELDS_AT_ONCE):
        batch = runs[start : start + LIGHT_FIELDS_AT_ONCE]
        places = [(run.block_name, run.row) for run in batch if run.block_name is not None and run.row is not None]
        yield np.stack([workspace.arrays.read(name, row, "light_field") for name, row in places])
