"""Random walks over a surface that are slow to cross creases, above all concave ones."""

import numpy as np
from jaxtyping import Float
from scipy import sparse
from scipy.sparse.linalg import splu

from partwise.geometry.adjacency import EdgeAdjacency
from partwise.geometry.dihedral import is_concave, normal_angles
from partwise.geometry.faces import bounding_box_diagonal, face_areas, face_centroids
from partwise.mesh import TriMesh
from partwise.segmentation.patch_parameters import RandomWalkParameters

_STEEPEST = 20.0  # times the mean crease: e⁻²⁰ is closed enough, and the equations stay solvable
_GREATEST_ASPECT = 100.0  # edge to centroid distance; slivers and faces that coincide would go to infinity
_LEAST_AREA = 1e-12  # of the total, so that a face without area is passed through and not divided by


def crease_distances(mesh: TriMesh, adjacency: EdgeAdjacency, convex_factor: float) -> Float[np.ndarray, " k"]:
    """How strongly each edge separates its faces, (k,) float64 in [0, 20]; 1 on average over the edges' length.

    η/2·|n − n′|² = η·(1 − cos a), a being the angle between normals, η = 1 at concave and `convex_factor` at convex
    edges; divided by the mean. 0 everywhere on a flat mesh.

    Source: Lai et al. 2008. Differs: the mean is taken over length, not over edges, so that finely meshed regions do
    not set it alone.
    """
    factor = np.where(is_concave(mesh, adjacency), 1.0, convex_factor)
    d = factor * (1.0 - np.cos(normal_angles(mesh, adjacency)))
    total = float(adjacency.lengths.sum())
    mean = float(d @ adjacency.lengths) / total if total > 0 else 0.0
    return np.minimum(d / mean, _STEEPEST) if mean > 0 else np.zeros_like(d)


def walk_conductances(
    mesh: TriMesh, adjacency: EdgeAdjacency, parameters: RandomWalkParameters
) -> Float[np.ndarray, " k"]:
    """How readily a walk crosses each edge, (k,) float64 ≥ 0, dimensionless: |e|/|c − c′|·exp(−d/σ).

    Source: Lai et al. 2008. Differs: divided by the distance between centroids, without which the outcome depends on
    how finely the mesh is cut.
    """
    centroids = face_centroids(mesh)
    steps = np.linalg.norm(centroids[adjacency.faces[:, 0]] - centroids[adjacency.faces[:, 1]], axis=1)
    shortest = adjacency.lengths / _GREATEST_ASPECT
    steps = np.maximum(steps, shortest)
    aspect = np.divide(adjacency.lengths, steps, out=np.zeros_like(steps), where=steps > 0)
    return aspect * np.exp(-crease_distances(mesh, adjacency, parameters.convex_factor) / parameters.crease_scale)


def walk_means(
    mesh: TriMesh, adjacency: EdgeAdjacency, values: Float[np.ndarray, "m d"], parameters: RandomWalkParameters
) -> Float[np.ndarray, "m d"]:
    """Expected value, (m, d) float64, at the face where a random walk from each face ends.

    A walk stops at a constant rate, after a time reach²·diagonal² in the mean. The expectation solves (M + tL)·x =
    M·values, M the faces' areas and L the Laplacian of the conductances: one sparse factorisation, one substitution a
    column. Faces that a crease divides end up far apart, faces of one bulge close together.
    """
    diagonal = bounding_box_diagonal(mesh) or 1.0
    areas = face_areas(mesh) / diagonal**2
    areas = np.maximum(areas, _LEAST_AREA * (float(areas.sum()) or 1.0))
    i, j = adjacency.faces.T
    w = parameters.reach**2 * walk_conductances(mesh, adjacency, parameters)
    m = mesh.n_faces
    off_diagonal = sparse.coo_array(
        (np.concatenate([-w, -w]), (np.concatenate([i, j]), np.concatenate([j, i]))), (m, m)
    )
    diagonal_sum = areas + np.bincount(i, weights=w, minlength=m) + np.bincount(j, weights=w, minlength=m)
    system = sparse.csc_matrix(off_diagonal + sparse.diags_array(diagonal_sum))
    # Symmetric and diagonally dominant: no pivoting is needed, and an ordering that knows it fills in less.
    factor = splu(system, permc_spec="MMD_AT_PLUS_A", diag_pivot_thresh=0.0, options={"SymmetricMode": True})
    return factor.solve(areas[:, None] * values)
