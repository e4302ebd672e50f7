"""Labels whose boundaries have moved by a smooth random amount: the wobble of a hand that refinement should undo."""

import numpy as np
from jaxtyping import Float, Int

from partwise.errors import LabelError, ParameterError
from partwise.geometry.adjacency import edge_adjacency
from partwise.geometry.faces import bounding_box_diagonal, face_centroids
from partwise.mesh import TriMesh
from partwise.segmentation.boundary_distances import SurfaceGraph, boundary_distances

FURTHEST = 0.03
WAVELENGTH = 0.1
"""Both as fractions of the diagonal."""
N_WAVES = 32


def displaced(
    mesh: TriMesh,
    labels: Int[np.ndarray, " m"],
    rng: np.random.Generator,
    furthest: float = FURTHEST,
    wavelength: float = WAVELENGTH,
) -> Int[np.ndarray, " m"]:
    """Labels whose boundaries have moved by up to `furthest` times the bounding box's diagonal along the surface.

    Each part l has a signed distance s_l from its boundary (negative inside) and a smooth random offset u_l with
    |u_l| ≤ furthest·diagonal; a face takes the part with the least s_l + u_l. Where l and k meet s_l = −s_k, so their
    boundary moves by (u_k − u_l)/2. Typical moves are half the greatest. A part thinner than that may be lost, and a
    part may come up where it was near.

    Raises
    ------
    LabelError : not one label per face, or some unlabelled.
    ParameterError : a distance or wavelength that is not positive and finite.
    """
    if labels.shape != (mesh.n_faces,) or int(labels.min()) < 0:
        raise LabelError(f"displacement needs {mesh.n_faces} labels ≥ 0 but got {labels.shape}; label every face first")
    for name, value in (("furthest", furthest), ("wavelength", wavelength)):
        if not 0 < value < np.inf:
            raise ParameterError(f"{name} must be positive and finite but is {value}; 0.03 and 0.1 are usual")
    part_ids, classes = np.unique(labels, return_inverse=True)
    diagonal = bounding_box_diagonal(mesh)
    if len(part_ids) < 2 or not diagonal > 0:
        return labels.astype(np.int64)
    limit = 3 * furthest * diagonal  # farther off, no offsets can close the gap
    distances = boundary_distances(SurfaceGraph.build(mesh, edge_adjacency(mesh)), classes, len(part_ids), limit)
    distances = np.minimum(distances, limit)
    signed = np.where(classes[:, None] == np.arange(len(part_ids)), -distances, distances)
    points = face_centroids(mesh) / (diagonal * wavelength)
    offsets = np.stack([smooth_field(points, rng) for _ in part_ids], axis=1) * (furthest * diagonal)
    return part_ids[np.argmin(signed + offsets, axis=1)].astype(np.int64)


def smooth_field(points: Float[np.ndarray, "m 3"], rng: np.random.Generator) -> Float[np.ndarray, " m"]:
    """A smooth random function of place, (m,) float64 in [−1, 1], with waves about one unit long.

    A sum of random plane waves, which is nearly Gaussian, folded into the range by a sine.
    """
    waves = rng.standard_normal((3, N_WAVES)) * (2 * np.pi / np.sqrt(3))
    phases = rng.uniform(0, 2 * np.pi, N_WAVES)
    field = np.cos(points @ waves + phases) @ rng.standard_normal(N_WAVES)
    return np.sin(field / np.sqrt(np.mean(field**2)) * np.pi / 2)
