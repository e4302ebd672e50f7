"""Per-face quantities: area, unit normal, centroid; and the bounding box's diagonal."""

import numpy as np
from jaxtyping import Float

from partwise.mesh import TriMesh


def face_areas(mesh: TriMesh) -> Float[np.ndarray, " m"]:
    """Area of each face, (m,) float64, squared model units; 0 for degenerate faces."""
    return np.linalg.norm(_cross(mesh), axis=1) / 2.0


def face_normals(mesh: TriMesh) -> Float[np.ndarray, "m 3"]:
    """Unit normal of each face, (m, 3) float64, right-hand rule; the zero vector for degenerate faces."""
    cross = _cross(mesh)
    length = np.linalg.norm(cross, axis=1, keepdims=True)
    return np.divide(cross, length, out=np.zeros_like(cross), where=length > 0)


def face_centroids(mesh: TriMesh) -> Float[np.ndarray, "m 3"]:
    """Mean of each face's corners, (m, 3) float64, model units."""
    return mesh.vertices[mesh.faces].mean(axis=1)


def bounding_box_diagonal(mesh: TriMesh) -> float:
    """Length of the diagonal of the axis-aligned box around the vertices that faces use, model units."""
    used = mesh.vertices[np.unique(mesh.faces)]
    return float(np.linalg.norm(used.max(axis=0) - used.min(axis=0)))


def _cross(mesh: TriMesh) -> np.ndarray:
    a, b, c = (mesh.vertices[mesh.faces[:, k]] for k in range(3))
    return np.cross(b - a, c - a)
