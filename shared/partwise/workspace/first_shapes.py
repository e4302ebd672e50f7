"""Embeds the collection and chooses the shapes to label first."""

from collections.abc import Iterator

import numpy as np
from jaxtyping import Float32

from partwise.errors import NotEnoughDataError
from partwise.selection.clustering import clustered, nearest_to_centres
from partwise.selection.embedding import Embedding, fit_embedding, sample_rows
from partwise.store.records import Collection, FirstShape, StageRun
from partwise.workspace.light_fields import described_runs, light_fields
from partwise.workspace.placed_shapes import PlacedShapes, record_clusters, store_fit
from partwise.workspace.progress import OnRunProgress, RunProgress
from partwise.workspace.workspace import Workspace


def select_first_shapes(
    workspace: Workspace,
    collection: Collection,
    n_clusters: int,
    n_per_cluster: int,
    seed: int,
    on_progress: OnRunProgress = lambda _: None,
) -> list[FirstShape]:
    """Fits the embedding on the described shapes and clusters it.

    On record are then every shape's cluster, and the shapes nearest each centre as those to label first.
    `on_progress` is told as shapes are placed; what it raises leaves all as it was.

    Raises
    ------
    NotEnoughDataError : fewer described shapes than were asked for.
    """
    described = list(described_runs(workspace, collection))
    n_wanted = n_clusters * n_per_cluster
    if len(described) < max(2, n_wanted):
        raise NotEnoughDataError(
            f"selecting {n_clusters} × {n_per_cluster} shapes needs {max(2, n_wanted)} described ones but "
            f"{collection.name!r} has {len(described)}; run `partwise preprocess`, or ask for fewer"
        )
    sampling, fitting, seeding = np.random.default_rng(seed).spawn(3)
    sample = [described[row] for row in sample_rows(len(described), sampling)]
    embedding = fit_embedding(light_fields(workspace, sample), fitting)
    points = np.concatenate(list(_placed(workspace, embedding, described, on_progress)))
    ids = [str(run.shape_id) for run in described]
    clustering = clustered(points, n_clusters, seeding)
    chosen = nearest_to_centres(points, ids, clustering, n_per_cluster)
    shape_ids = np.array([run.shape_id for run in described], dtype=np.int64)
    store_fit(workspace, collection, embedding, PlacedShapes(shape_ids, points, clustering.centres, len(described)))
    record_clusters(workspace, collection, shape_ids, clustering.cluster_ids)
    firsts = [FirstShape(int(first.id), ordinal, first.cluster) for ordinal, first in enumerate(chosen)]
    workspace.catalog.replace_first_shapes(collection.id, firsts)
    return firsts


def _placed(
    workspace: Workspace, embedding: Embedding, described: list[StageRun], on_progress: OnRunProgress
) -> Iterator[Float32[np.ndarray, "b k"]]:
    n_done = 0
    for batch in light_fields(workspace, described):
        yield embedding.project(batch)
        n_done += len(batch)
        on_progress(RunProgress(n_done, 0, len(described)))
