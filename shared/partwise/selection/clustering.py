"""The first shapes to label: a few of each kind in the collection, before any model exists."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float, Int
from scipy.spatial.distance import cdist
from sklearn.cluster import KMeans
from sklearn.neighbors import NearestNeighbors

from partwise.errors import NotEnoughDataError, ParameterError

N_RESTARTS = 10
MAX_ITERATIONS = 300
N_TYPICALITY_NEIGHBOURS = 20


@dataclass(frozen=True, slots=True)
class FirstShape:
    """A shape chosen to be labelled first.

    id : the shape's. cluster : 0 for the cluster with most shapes, ascending. distance : Euclidean, to that cluster's
    centre, in units of the embedding.
    """

    id: str
    cluster: int
    distance: float


@dataclass(frozen=True, slots=True, eq=False)
class Clustering:
    """centres : (k, d), the cluster with most shapes first. cluster_ids : (n,) int64, 0 to k − 1, of each point."""

    centres: Float[np.ndarray, "k d"]
    cluster_ids: Int[np.ndarray, " n"]


def first_shapes(
    points: Float[np.ndarray, "n d"], ids: Sequence[str], n_clusters: int, n_per_cluster: int, rng: np.random.Generator
) -> list[FirstShape]:
    """The shapes nearest to each centre of a k-means clustering.

    Parameters
    ----------
    points : (n, d) embedding, one row a shape. ids : n distinct ids in the same order.
    n_clusters, n_per_cluster : ≥ 1, product ≤ n.
    rng : seeds the clustering; the same seed and points give the same shapes.

    Returns
    -------
    n_clusters · n_per_cluster distinct shapes, by cluster (largest first), then by distance. A cluster with fewer than
    n_per_cluster members is filled up with the nearest shapes of others that are still free.

    Raises
    ------
    ParameterError : counts below 1, ids of another number or not distinct, points not (n, d) or not finite.
    NotEnoughDataError : n_clusters · n_per_cluster > n, or fewer than n_clusters points differ.

    Source: George, Xie, Lai, Tam 2018.
    """
    _check(points, ids, n_clusters, n_per_cluster)
    return nearest_to_centres(points, ids, clustered(points, n_clusters, rng), n_per_cluster)


def clustered(points: Float[np.ndarray, "n d"], n_clusters: int, rng: np.random.Generator) -> Clustering:
    """K-means of (n, d) points, n ≥ n_clusters.

    Raises
    ------
    NotEnoughDataError : fewer than n_clusters points differ.
    """
    centres, members = _clusters(points, n_clusters, rng)
    cluster_ids = np.empty(len(points), dtype=np.int64)
    for cluster, rows in enumerate(members):
        cluster_ids[rows] = cluster
    return Clustering(centres, cluster_ids)


def nearest_centres(points: Float[np.ndarray, "n d"], centres: Float[np.ndarray, "k d"]) -> Int[np.ndarray, " n"]:
    """The cluster of each point, (n,) int64, by the nearest of the centres."""
    nearest: Int[np.ndarray, " n"] = cdist(points, centres).argmin(axis=1)
    return nearest


def nearest_to_centres(
    points: Float[np.ndarray, "n d"], ids: Sequence[str], clustering: Clustering, n_per_cluster: int
) -> list[FirstShape]:
    """As `first_shapes`, of a clustering of these points."""
    _check(points, ids, len(clustering.centres), n_per_cluster)
    members = [np.flatnonzero(clustering.cluster_ids == k) for k in range(len(clustering.centres))]
    distances = cdist(points, clustering.centres)
    nearest_own = [own[np.argsort(distances[own, k], kind="stable")][:n_per_cluster] for k, own in enumerate(members)]
    is_free = np.ones(len(ids), dtype=bool)
    is_free[np.concatenate(nearest_own)] = False
    chosen = []
    for cluster, own in enumerate(nearest_own):
        free = np.flatnonzero(is_free)
        nearest_free = free[np.argsort(distances[free, cluster], kind="stable")]
        filling = nearest_free[: n_per_cluster - len(own)]
        is_free[filling] = False
        rows = np.concatenate([own, filling])
        chosen += [FirstShape(ids[row], cluster, float(distances[row, cluster])) for row in rows]
    return chosen


def typical_shapes(
    points: Float[np.ndarray, "n d"], ids: Sequence[str], n_shapes: int, rng: np.random.Generator
) -> list[FirstShape]:
    """The most typical shape of each of n_shapes clusters: that with the nearest neighbours inside its cluster.

    Unlike the shape nearest to the centre it lies where the cluster is dense, so it is never between two kinds.

    Parameters, errors
    ------------------
    As for `first_shapes` with n_per_cluster = 1.

    Source: Hacohen, Dekel, Weinshall 2022 (TypiClust). Differs: one round from nothing, on the PCA embedding.
    """
    _check(points, ids, n_shapes, 1)
    centres, members = _clusters(points, n_shapes, rng)
    chosen = []
    for cluster, own in enumerate(members):
        row = own[_most_typical(points[own])]
        distance = np.linalg.norm(points[row].astype(np.float64) - centres[cluster])
        chosen.append(FirstShape(ids[row], cluster, float(distance)))
    return chosen


def _clusters(points: np.ndarray, n_clusters: int, rng: np.random.Generator) -> tuple[np.ndarray, list[np.ndarray]]:
    """Centres (k, d) and the rows of each cluster, largest cluster first."""
    seed = int(rng.integers(2**31))
    fitted = KMeans(n_clusters, n_init=N_RESTARTS, max_iter=MAX_ITERATIONS, random_state=seed).fit(
        points.astype(np.float64)
    )
    cluster_ids: Int[np.ndarray, " n"] = fitted.labels_
    sizes = np.bincount(cluster_ids, minlength=n_clusters)
    if not sizes.all():
        raise NotEnoughDataError(
            f"{n_clusters} clusters need as many different shapes but only {np.count_nonzero(sizes)} differ; "
            "ask for fewer"
        )
    order = np.argsort(-sizes, kind="stable")
    return fitted.cluster_centers_[order], [np.flatnonzero(cluster_ids == k) for k in order]


def _most_typical(points: np.ndarray) -> int:
    """Row with the least mean distance to its (at most 20) nearest neighbours."""
    n_neighbours = min(N_TYPICALITY_NEIGHBOURS, len(points) - 1)
    if n_neighbours == 0:
        return 0
    distances, _ = NearestNeighbors(n_neighbors=n_neighbours).fit(points).kneighbors()
    return int(distances.mean(axis=1).argmin())


def _check(points: np.ndarray, ids: Sequence[str], n_clusters: int, n_per_cluster: int) -> None:
    if n_clusters < 1 or n_per_cluster < 1:
        raise ParameterError(
            f"clusters and shapes per cluster must be at least 1 but are {n_clusters} and {n_per_cluster}; raise them"
        )
    if points.ndim != 2 or points.shape[0] != len(ids) or points.shape[1] == 0:
        raise ParameterError(
            f"points must be (shapes, dimensions) but are {points.shape} for {len(ids)} ids; embed the same shapes"
        )
    if len(set(ids)) != len(ids):
        repeated = next(name for k, name in enumerate(ids) if name in ids[:k])
        raise ParameterError(f"shape ids must be distinct but {repeated!r} is there twice; drop one")
    finite = np.isfinite(points).all(axis=1)
    if not finite.all():
        row = int(np.argmin(finite))
        raise ParameterError(f"points must be finite but those of {ids[row]!r} are not; describe that shape again")
    if n_clusters * n_per_cluster > len(ids):
        raise NotEnoughDataError(
            f"{n_clusters} clusters × {n_per_cluster} shapes are {n_clusters * n_per_cluster} but there are only "
            f"{len(ids)}; ask for fewer or ingest more"
        )
