"""How much of a crease every edge lies on: its angle, the bend of the surface around it, the change of diameter."""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float
from scipy import sparse
from scipy.sparse.linalg import splu

from partwise.geometry.adjacency import EdgeAdjacency
from partwise.geometry.dihedral import is_concave, normal_angles
from partwise.geometry.faces import bounding_box_diagonal, face_areas, face_centroids, face_normals
from partwise.mesh import TriMesh
from partwise.segmentation.given_diameters import checked_diameters

SCALE = 0.01
"""Width over which normals and diameters are smoothed, as a fraction of the diagonal: below it lies noise."""
_DIAMETER_REACH = 0.02
_MOST_BEND = 1.5  # radians; slivers' centroids can lie so close that a difference over their distance says nothing
_MOST_STEP = 0.3
_LEAST_GAP, _LEAST_AREA = 1e-4, 1e-9  # of the diagonal and its square; degenerate faces leave the system definite


@dataclass(frozen=True, slots=True, eq=False)
class Creases:
    """Per edge between two faces, k in all; concave is positive.

    angles : (k,) float64, signed angle between the faces' normals, radians.
    bends : (k,) float64, signed turn of the smoothed normals per SCALE of the diagonal across the edge, radians.
    diameter_jumps : (k,) float64, |SDF_f − SDF_f'| of the two faces, ≥ 0; zeros without shape diameters.
    diameter_slopes : (k,) float64, change of the smoothed shape diameter per 2 % of the diagonal, ≥ 0; zeros without.
    has_diameter : whether shape diameters were given.
    """

    angles: Float[np.ndarray, " k"]
    bends: Float[np.ndarray, " k"]
    diameter_jumps: Float[np.ndarray, " k"]
    diameter_slopes: Float[np.ndarray, " k"]
    has_diameter: bool


def measure_creases(
    mesh: TriMesh, adjacency: EdgeAdjacency, shape_diameter: Float[np.ndarray, " m"] | None = None
) -> Creases:
    """Creases at every edge; does not depend on the mesh's size or place, and little on its resolution.

    Raises
    ------
    ParameterError : shape diameters that are not one finite value per face.

    Source: curvature as the change of normals across an edge; smoothing by one implicit step of heat flow
    (Desbrun et al. 1999).
    """
    diameter = np.zeros(mesh.n_faces) if shape_diameter is None else checked_diameters(mesh, shape_diameter)
    first, second = adjacency.faces.T
    angles = np.where(is_concave(mesh, adjacency), 1.0, -1.0) * normal_angles(mesh, adjacency)
    diagonal = bounding_box_diagonal(mesh)
    if not diagonal > 0 or not len(first):
        none = np.zeros(len(first))
        return Creases(angles, none, none, none, has_diameter=shape_diameter is not None)
    across = (face_centroids(mesh)[second] - face_centroids(mesh)[first]) / diagonal
    gap = np.maximum(np.linalg.norm(across, axis=1), _LEAST_GAP)
    smooth = _smoothed(mesh, adjacency, gap, np.column_stack([face_normals(mesh), diameter]))
    length = np.linalg.norm(smooth[:, :3], axis=1, keepdims=True)
    normals = np.divide(smooth[:, :3], length, out=np.zeros_like(smooth[:, :3]), where=length > 0)
    turn = np.einsum("ij,ij->i", normals[second] - normals[first], across)
    slopes = np.abs(smooth[second, 3] - smooth[first, 3]) / gap * _DIAMETER_REACH
    return Creases(
        angles=angles,
        bends=np.clip(-turn / gap**2 * SCALE, -_MOST_BEND, _MOST_BEND),
        diameter_jumps=np.abs(diameter[second] - diameter[first]),
        diameter_slopes=np.minimum(slopes, _MOST_STEP),
        has_diameter=shape_diameter is not None,
    )


def _smoothed(
    mesh: TriMesh, adjacency: EdgeAdjacency, gap: Float[np.ndarray, " k"], values: Float[np.ndarray, "m c"]
) -> Float[np.ndarray, "m c"]:
    """(M + t·L)⁻¹ M values with areas M, the Laplacian L of faces across edges, and t = SCALE²/2: a mean around each
    face, in units of the diagonal."""
    diagonal, m = bounding_box_diagonal(mesh), mesh.n_faces
    area = np.maximum(face_areas(mesh) / diagonal**2, _LEAST_AREA)
    conductance = SCALE**2 / 2 * adjacency.lengths / diagonal / gap
    first, second = adjacency.faces.T
    entries = np.concatenate([area, conductance, conductance, -conductance, -conductance])
    own = np.arange(m)
    rows = np.concatenate([own, first, second, first, second])
    columns = np.concatenate([own, first, second, second, first])
    system = sparse.csc_array((entries, (rows, columns)), shape=(m, m))
    solver = splu(system, permc_spec="MMD_AT_PLUS_A", options={"SymmetricMode": True})
    return np.asarray(solver.solve(values * area[:, None]))
