"""Spheres of several resolutions with labels, for what happens when a shape gets another mesh."""

import numpy as np
from jaxtyping import UInt16

from partwise.geometry.faces import face_centroids
from partwise.mesh import TriMesh
from partwise.testing.meshes import subdivided


def ball(n_splits: int) -> TriMesh:
    """An octahedron whose faces are split in four so many times, on the unit sphere."""
    corners = np.array([[1, 0, 0], [-1, 0, 0], [0, 1, 0], [0, -1, 0], [0, 0, 1], [0, 0, -1]], dtype=np.float64)
    faces = np.array([[0, 2, 4], [2, 1, 4], [1, 3, 4], [3, 0, 4], [2, 0, 5], [1, 2, 5], [3, 1, 5], [0, 3, 5]])
    mesh = TriMesh(corners, faces)
    for _ in range(n_splits):
        mesh = subdivided(mesh)
        mesh = TriMesh(mesh.vertices / np.linalg.norm(mesh.vertices, axis=1, keepdims=True), mesh.faces)
    return TriMesh(mesh.vertices.astype(np.float32), mesh.faces)


def halves(mesh: TriMesh) -> UInt16[np.ndarray, " m"]:
    """Part 1 above, part 2 below: at every resolution the border runs along edges."""
    return np.where(face_centroids(mesh)[:, 2] > 0, 1, 2).astype(np.uint16)


def speckles(mesh: TriMesh) -> UInt16[np.ndarray, " m"]:
    """Labels that no coarser mesh can hold."""
    return (np.arange(mesh.n_faces) % 2 + 1).astype(np.uint16)
