"""Per-vertex quantities: share of area, and normal."""

import numpy as np
from jaxtyping import Float

from partwise.geometry.faces import face_areas, face_normals
from partwise.mesh import TriMesh


def vertex_areas(mesh: TriMesh) -> Float[np.ndarray, " n"]:
    """A third of the area of the faces around each vertex, (n,) float64, squared model units; sums to the area."""
    shares = np.repeat(face_areas(mesh) / 3.0, 3)
    return np.bincount(mesh.faces.ravel(), weights=shares, minlength=mesh.n_vertices)


def vertex_normals(mesh: TriMesh) -> Float[np.ndarray, "n 3"]:
    """Unit mean of the normals around each vertex, weighted by area, (n, 3) float64; zero where they cancel out."""
    weighted = np.repeat(face_normals(mesh) * face_areas(mesh)[:, None], 3, axis=0)
    flat = mesh.faces.ravel()
    total = np.stack([np.bincount(flat, weights=weighted[:, k], minlength=mesh.n_vertices) for k in range(3)], axis=1)
    length = np.linalg.norm(total, axis=1, keepdims=True)
    return np.divide(total, length, out=np.zeros_like(total), where=length > 1e-12 * face_areas(mesh).max())
