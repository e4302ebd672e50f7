"""Shape diameter of every face: how thick the body is behind it."""

import numpy as np
from embreex.mesh_construction import TriangleMesh
from embreex.rtcore_scene import EmbreeScene
from jaxtyping import Float, Float32
from scipy import sparse

from partwise.features.kernels.shape_diameter import inward_rays, robust_means, smooth_bilaterally
from partwise.features.parameters import ShapeDiameterParameters
from partwise.geometry.adjacency import edge_adjacency
from partwise.geometry.faces import bounding_box_diagonal, face_centroids, face_normals
from partwise.mesh import TriMesh

OFFSET = 1e-5
"""Rays start this far inside, relative to the bounding box's diagonal: float32 cannot tell much less."""
ALLOWED_SPREAD = 1.5
RANGE_FACTOR = 1.5
FACES_PER_WINDOW = 2000
RAYS_PER_BATCH = 500_000


def shape_diameter(mesh: TriMesh, parameters: ShapeDiameterParameters | None = None) -> Float32[np.ndarray, " m"]:
    """Shape diameter of every face, smoothed, and scaled logarithmically to [0, 1].

    Missing diameters (open surfaces, faces without area) become the mean of the neighbours' across edges, else the
    minimum. Bilateral smoothing over w = ⌊√(m/2000)⌋ + 1 rings (σ_s = w/2, σ_r = 1.5·local RMS), then
    x = (d − min)/(max − min) and ln(αx + 1)/ln(α + 1).

    Parameters
    ----------
    mesh : any mesh; invariant to rotation, translation and scale up to float32 rays.

    Returns
    -------
    (m,) float32 in [0, 1]; 0 everywhere if the diameter is the same everywhere or nowhere defined.

    Source: Shapira, Shamir, Cohen-Or 2008; filling and smoothing as in CGAL.
    """
    parameters = parameters or ShapeDiameterParameters()
    starts, neighbours = _edge_neighbours(mesh)
    diameter = _fill_missing(ray_diameter(mesh, parameters), starts, neighbours)
    window = int(np.sqrt(mesh.n_faces / FACES_PER_WINDOW)) + 1
    smooth = smooth_bilaterally(diameter, starts, neighbours, window, RANGE_FACTOR)
    low, high = smooth.min(), smooth.max()
    if high - low <= 1e-6 * high:  # rays are cast in float32: less is noise
        return np.zeros(mesh.n_faces, dtype=np.float32)
    scaled = (smooth - low) / (high - low)
    return (np.log1p(parameters.alpha * scaled) / np.log1p(parameters.alpha)).astype(np.float32)


def ray_diameter(mesh: TriMesh, parameters: ShapeDiameterParameters | None = None) -> Float[np.ndarray, " m"]:
    """Mean length of the rays from each face into the body, before smoothing and scaling.

    A cone of rays on a Vogel disk around −n; first hits only; hits with n_hit·n_f ≥ 0 do not count; of the others,
    those with |d − median| ≤ 1.5·MAD are averaged. The disk is turned with the face's first edge: no randomness.

    Returns
    -------
    (m,) float64, model units; NaN where no ray counts.
    """
    parameters = parameters or ShapeDiameterParameters()
    centroids, normals = face_centroids(mesh), face_normals(mesh)
    edges = mesh.vertices[mesh.faces[:, 1]] - mesh.vertices[mesh.faces[:, 0]]
    length = np.linalg.norm(edges, axis=1, keepdims=True)
    tangents = np.divide(edges, length, out=np.zeros_like(edges), where=length > 0)
    disk = _vogel_disk(parameters.n_rays) * np.tan(np.radians(parameters.cone_degrees / 2))
    scene = EmbreeScene()
    # Embree works in float32: a shape far from the origin would lose its digits.
    centre = mesh.vertices.mean(axis=0)
    size = bounding_box_diagonal(mesh) or 1.0
    points = (mesh.vertices - centre) / size
    centroids = (centroids - centre) / size
    TriangleMesh(scene, vertices=points.astype(np.float32), indices=mesh.faces.astype(np.int32))
    result = np.empty(mesh.n_faces)
    count = max(1, RAYS_PER_BATCH // parameters.n_rays)
    for first in range(0, mesh.n_faces, count):
        out = result[first : first + count]
        origins, directions = inward_rays(centroids, normals, tangents, disk, OFFSET, first, len(out))
        hits = scene.run(origins, directions)
        robust_means(hits, directions, centroids, normals, points[mesh.faces[:, 0]], first, ALLOWED_SPREAD, out)
    # Without a normal there is no inside.
    result[~normals.any(axis=1)] = np.nan
    return result * size


def _vogel_disk(n: int) -> np.ndarray:
    """n points spread evenly over the unit disk, (n, 2): radius √((k + ½)/n), turned by the golden angle each."""
    k = np.arange(n)
    radius, angle = np.sqrt((k + 0.5) / n), k * np.pi * (3.0 - np.sqrt(5.0))
    return np.stack([radius * np.cos(angle), radius * np.sin(angle)], axis=1)


def _edge_neighbours(mesh: TriMesh) -> tuple[np.ndarray, np.ndarray]:
    """Faces across edges as compressed rows: starts (m + 1,), neighbours."""
    pairs = edge_adjacency(mesh).faces
    both = np.concatenate([pairs, pairs[:, ::-1]])
    graph = sparse.csr_array((np.ones(len(both), dtype=np.int8), (both[:, 0], both[:, 1])), shape=(mesh.n_faces,) * 2)
    graph.sort_indices()
    return graph.indptr.astype(np.int64), graph.indices.astype(np.int64)


def _fill_missing(diameter: np.ndarray, starts: np.ndarray, neighbours: np.ndarray) -> np.ndarray:
    """NaN becomes the mean of the known neighbours, else the least of all, else 0."""
    known = np.isfinite(diameter)
    if not known.any():
        return np.zeros_like(diameter)
    value = np.where(known, diameter, 0.0)
    owner = np.repeat(np.arange(len(diameter)), np.diff(starts))
    total = np.bincount(owner, weights=value[neighbours], minlength=len(diameter))
    n_known = np.bincount(owner, weights=known[neighbours].astype(np.float64), minlength=len(diameter))
    mean = np.divide(total, n_known, out=np.full_like(diameter, value[known].min()), where=n_known > 0)
    return np.where(known, diameter, mean)
