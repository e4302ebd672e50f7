"""Points spread over a mesh's faces, in proportion to area, the same each time."""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float, Int

from partwise.errors import ParameterError
from partwise.geometry.faces import face_areas, face_normals
from partwise.mesh import TriMesh

# Roberts' R2 sequence: powers of the inverse plastic number, so that any run of points is spread evenly.
_R2 = np.array([0.7548776662466927, 0.5698402909980532])


@dataclass(frozen=True, slots=True, eq=False)
class SurfacePoints:
    """Points on faces, in order of face; the first of each face is its centroid.

    faces : (s,) int64, ascending, every face at least once.
    points : (s, 3) float64, model units. normals : (s, 3) float64 of the face; zero where it is degenerate.
    """

    faces: Int[np.ndarray, " s"]
    points: Float[np.ndarray, "s 3"]
    normals: Float[np.ndarray, "s 3"]


def surface_points(mesh: TriMesh, n_points: int, max_per_face: int) -> SurfacePoints:
    """About `n_points` points beyond one for each face, shared out by area; at most `max_per_face` on one face.

    Raises
    ------
    ParameterError : n_points is negative or max_per_face below 1.
    """
    if n_points < 0 or max_per_face < 1:
        raise ParameterError(
            f"n_points must be at least 0 and max_per_face at least 1 but are {n_points} and {max_per_face}; raise them"
        )
    areas = face_areas(mesh)
    total = float(areas.sum())
    share = areas / total if total > 0 else np.zeros_like(areas)
    counts = np.clip(np.ceil(share * n_points).astype(np.int64), 1, max_per_face)
    faces = np.repeat(np.arange(mesh.n_faces), counts)
    rank = np.arange(len(faces)) - np.repeat(np.cumsum(counts) - counts, counts)
    u, v = ((rank[:, None] * _R2 + 0.5) % 1.0).T
    beyond = u + v > 1.0
    u, v = np.where(beyond, 1.0 - u, u), np.where(beyond, 1.0 - v, v)
    u, v = np.where(rank == 0, 1.0 / 3.0, u), np.where(rank == 0, 1.0 / 3.0, v)
    a, b, c = (mesh.vertices[mesh.faces[faces, k]] for k in range(3))
    points = a + u[:, None] * (b - a) + v[:, None] * (c - a)
    return SurfacePoints(faces, points, face_normals(mesh)[faces])
