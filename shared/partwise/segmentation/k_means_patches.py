"""Over-segmentation by k-means on position and normal: the plain way, for comparison and for shapes without creases."""

import numpy as np
from jaxtyping import Float, Int
from scipy.spatial import cKDTree

from partwise.geometry.adjacency import edge_adjacency, label_regions
from partwise.geometry.faces import bounding_box_diagonal, face_areas, face_centroids, face_normals
from partwise.mesh import TriMesh
from partwise.segmentation.kernels.nearest_centres import nearest_centres
from partwise.segmentation.patch_parameters import KMeansParameters
from partwise.segmentation.patch_tree import check_n_patches, patch_tree

_DEFAULTS = KMeansParameters()
_MOST_CENTRES_BY_LOOP = 500  # beyond, a search tree is faster


class KMeansPatches:
    """Patches of one mesh by k-means on (centroid / diagonal, weight · normal), each face counting by its area.

    A cluster in several pieces is as many patches; then pieces merge with a neighbour, where that costs the objective
    least (so scraps go first), until the number asked for is left.

    Source: Lloyd 1982, started from farthest points, which makes it deterministic.
    """

    __slots__ = ("_areas", "_features", "_max_iterations", "_n_components", "_pairs")

    def __init__(self, mesh: TriMesh, parameters: KMeansParameters = _DEFAULTS) -> None:
        centroids = face_centroids(mesh)
        position = (centroids - centroids.mean(axis=0)) / (bounding_box_diagonal(mesh) or 1.0)
        self._features = np.column_stack([position, parameters.normal_weight * face_normals(mesh)])
        self._areas = face_areas(mesh)
        self._pairs = edge_adjacency(mesh).faces
        self._max_iterations = parameters.max_iterations
        self._n_components = int(label_regions(np.zeros(mesh.n_faces, dtype=np.int64), self._pairs).max()) + 1

    @property
    def n_faces(self) -> int:
        return len(self._areas)

    @property
    def n_components(self) -> int:
        return self._n_components

    def patches(self, n_patches: int) -> Int[np.ndarray, " m"]:
        """Patch of each face, (m,) int64 in 0 … max(n_patches, n_components) − 1; each connected across edges.

        Not nested: another number gives other patches.

        Raises
        ------
        ParameterError : n_patches is not in 1 … n_faces.
        """
        check_n_patches(n_patches, self.n_faces)
        clusters = _lloyd(self._features, self._areas, n_patches, self._max_iterations)
        pieces = label_regions(clusters, self._pairs)
        n_pieces = int(pieces.max()) + 1
        if n_pieces < n_patches:  # faces that look the same share a cluster: take pieces apart
            inside = self._pairs[pieces[self._pairs[:, 0]] == pieces[self._pairs[:, 1]]]
            return patch_tree(inside, self._areas, self._features).cut(n_patches)
        weights = np.bincount(pieces, weights=self._areas, minlength=n_pieces)
        between = np.sort(pieces[self._pairs], axis=1)
        between = np.unique(between[between[:, 0] != between[:, 1]], axis=0)
        tree = patch_tree(between, weights, _means(self._features, self._areas, pieces, n_pieces))
        merged: np.ndarray = tree.cut(n_patches)[pieces]
        return merged


def _lloyd(
    features: Float[np.ndarray, "m d"], areas: Float[np.ndarray, " m"], n_clusters: int, max_iterations: int
) -> Int[np.ndarray, " m"]:
    """Nearest centre of each row, (m,) int64; a cluster may be empty."""
    centres = features[_farthest_points(features, n_clusters)]
    clusters = _nearest(features, centres, np.zeros(len(features), dtype=np.int64))
    for _ in range(max_iterations):
        is_used = np.bincount(clusters, minlength=n_clusters) > 0
        centres = np.where(is_used[:, None], _means(features, areas, clusters, n_clusters), centres)
        moved = _nearest(features, centres, clusters)
        if np.array_equal(moved, clusters):
            break
        clusters = moved
    return clusters


def _nearest(features: np.ndarray, centres: np.ndarray, first_guess: np.ndarray) -> Int[np.ndarray, " m"]:
    nearest: np.ndarray
    if len(centres) > _MOST_CENTRES_BY_LOOP:
        nearest = np.asarray(cKDTree(centres).query(features)[1], dtype=np.int64)
    else:
        nearest = nearest_centres(features, centres, first_guess)
    return nearest


def _farthest_points(features: Float[np.ndarray, "m d"], count: int) -> Int[np.ndarray, " count"]:
    """Rows that spread out, starting with the one farthest from the mean; ties go to the lower index."""
    chosen = np.empty(count, dtype=np.int64)
    squared = ((features - features.mean(axis=0)) ** 2).sum(axis=1)
    for k in range(count):
        chosen[k] = np.argmax(squared)
        to_chosen = ((features - features[chosen[k]]) ** 2).sum(axis=1)
        squared = to_chosen if k == 0 else np.minimum(squared, to_chosen)
    return chosen


def _means(features: np.ndarray, areas: np.ndarray, group: np.ndarray, n_groups: int) -> np.ndarray:
    """Mean of each group's rows by area, (n_groups, d); a group without area takes the plain mean, an empty one 0."""
    n_faces = np.bincount(group, minlength=n_groups)
    total = np.bincount(group, weights=areas, minlength=n_groups)
    weights = np.where(total[group] > 0, areas, 1.0)
    divisor = np.maximum(np.where(total > 0, total, n_faces), np.finfo(np.float64).tiny)
    sums = [np.bincount(group, weights=weights * column, minlength=n_groups) for column in features.T]
    return np.stack(sums, axis=1) / divisor[:, None]
