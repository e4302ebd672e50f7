"""Angles between faces across their shared edge, and which of those edges are concave."""

import numpy as np
from jaxtyping import Bool, Float

from partwise.geometry.adjacency import EdgeAdjacency
from partwise.geometry.faces import face_centroids, face_normals
from partwise.mesh import TriMesh


def normal_angles(mesh: TriMesh, adjacency: EdgeAdjacency) -> Float[np.ndarray, " k"]:
    """Angle between the normals of each pair's faces, (k,) float64 in [0, π] radians; 0 where flat.

    It stands for π − θ, θ being the interior dihedral angle. Degenerate faces have no normal and give π/2.
    """
    N = face_normals(mesh)
    cosine = np.einsum("ij,ij->i", N[adjacency.faces[:, 0]], N[adjacency.faces[:, 1]])
    return np.arccos(np.clip(cosine, -1.0, 1.0))


def is_concave(mesh: TriMesh, adjacency: EdgeAdjacency) -> Bool[np.ndarray, " k"]:
    """Whether each pair's edge is concave seen from outside: (c′ − c)·n > 0. (k,) bool; flat edges are not."""
    N, C = face_normals(mesh), face_centroids(mesh)
    first, second = adjacency.faces.T
    rise = np.einsum("ij,ij->i", C[second] - C[first], N[first])
    # Relative to the distance, so that rounding on flat regions does not flip the answer.
    return rise > 1e-9 * np.linalg.norm(C[second] - C[first], axis=1)
