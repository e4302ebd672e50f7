"""Shape context of every face: where the rest of the surface lies, by geodesic distance and by how it faces."""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float, Float32

from partwise.features.kernels import shape_context as kernels
from partwise.features.parameters import ShapeContextParameters
from partwise.geometry.faces import face_centroids, face_normals
from partwise.geometry.geodesics import FaceGraph, face_graph
from partwise.geometry.kernels.geodesics import LANES, geodesic_batches
from partwise.geometry.sampling import FaceSample, farthest_point_faces
from partwise.mesh import TriMesh

REFERENCE_QUANTILE = 0.95
DISTANCE_LIMIT = 1.2
BIN_EXPONENT = 0.9
WEIGHT_OFFSET = 0.1
VALUES_HELD = 2**25
"""Distances kept at a time (134 MB): all of them on most meshes; else the reference comes from an even part of them."""


def distance_bin_edges(n_bins: int) -> Float[np.ndarray, " edges"]:
    """Edges of the geodesic bins as multiples of g95: (n_bins + 1,) float64, 0 to 1.2, finer towards 0.

    D·(−ln((s−x)/s)/ln s)^0.9 with s = n_bins + 1 and x = 0 … n_bins.
    """
    s = n_bins + 1
    x = np.arange(n_bins + 1)
    return DISTANCE_LIMIT * (-np.log((s - x) / s) / np.log(s)) ** BIN_EXPONENT


def shape_context(mesh: TriMesh, parameters: ShapeContextParameters | None = None) -> Float32[np.ndarray, "m d"]:
    """Shape context of every face.

    A target k adds (A_k/ΣA)/(g_ik/g95 + 0.1) to face i's bin of the angle ∠(c_k−c_i, −n_k) − 90° and of the geodesic
    g_ik. The face itself, faces out of reach and those at 1.2·g95 or beyond add nothing. g95 is the 95th percentile
    of the finite geodesics between two faces.

    Parameters
    ----------
    mesh : any mesh; invariant to rotation, translation and scale.

    Returns
    -------
    (m, n_angle_bins · n_distance_bins) float32, angle-major: reshape to (m, angle, distance). Dimensionless, ≥ 0,
    the same for any number of threads. Zero where a face reaches no other. Where a target's centroid coincides with
    the face's, or its normal is undefined, the angle counts as 0°.

    Source: Kalogerakis, Hertzmann, Singh 2010, in the form of George et al. 2018. Differs: above `all_pairs_below`
    faces, targets are farthest-point samples of each component, carrying their Voronoi areas (and, for g95, the
    number of faces in their cells).
    """
    parameters = parameters or ShapeContextParameters()
    graph = face_graph(mesh)
    takes_all = mesh.n_faces <= parameters.all_pairs_below
    sample = farthest_point_faces(mesh, graph, mesh.n_faces if takes_all else parameters.n_targets)
    histograms = np.zeros((mesh.n_faces, parameters.n_angle_bins * parameters.n_distance_bins), dtype=np.float32)
    n_batches = -(-int(np.diff(sample.component_starts).max()) // LANES)
    if n_batches == 0:
        return histograms
    n_held = min(n_batches, max(1, VALUES_HELD // (graph.n_nodes * LANES)))
    fields = np.empty((n_held, graph.n_nodes, LANES), dtype=np.float32)
    # Neighbours in the list lie close, so batches spread over the list are spread over the surface.
    first = np.arange(n_held) * n_batches // n_held
    rest = np.setdiff1d(np.arange(n_batches), first)
    _fill(fields, first, graph, sample)
    reference = _reference_distance(fields, first, graph, sample)
    if not reference > 0:
        return histograms
    surface = _Surface.of(mesh, sample)
    _bin(fields, first, reference, graph, sample, surface, parameters, histograms)
    for at in range(0, len(rest), n_held):
        batches = rest[at : at + n_held]
        held = fields[: len(batches)]
        _fill(held, batches, graph, sample)
        _bin(held, batches, reference, graph, sample, surface, parameters, histograms)
    return histograms


@dataclass(frozen=True, slots=True, eq=False)
class _Surface:
    """What binning needs to know, float32: faces' centroids (m, 3); targets' points and normals (3, t), weights (t,)."""

    centroids: np.ndarray
    points: np.ndarray
    normals: np.ndarray
    weights: np.ndarray

    @classmethod
    def of(cls, mesh: TriMesh, sample: FaceSample) -> "_Surface":
        centroids = face_centroids(mesh)
        return cls(
            centroids.astype(np.float32),
            np.ascontiguousarray(centroids[sample.faces].T, dtype=np.float32),
            np.ascontiguousarray(face_normals(mesh)[sample.faces].T, dtype=np.float32),
            (sample.areas / sample.areas.sum()).astype(np.float32),
        )


def _fill(fields: np.ndarray, batches: np.ndarray, graph: FaceGraph, sample: FaceSample) -> None:
    """Geodesics of these batches of targets into fields (b, nodes, LANES)."""
    geodesic_batches(
        graph.starts, graph.neighbours, graph.lengths, sample.faces, sample.component_starts, batches, fields
    )


def _bin(
    fields: np.ndarray,
    batches: np.ndarray,
    reference: float,
    graph: FaceGraph,
    sample: FaceSample,
    surface: _Surface,
    parameters: ShapeContextParameters,
    histograms: np.ndarray,
) -> None:
    """Adds these batches of targets to the histograms (m, d)."""
    sine_edges = np.sin(np.linspace(-np.pi / 2, np.pi / 2, parameters.n_angle_bins + 1))
    distance_edges = distance_bin_edges(parameters.n_distance_bins)
    kernels.add_to_histograms(
        fields,
        batches,
        graph.component,
        sample.faces,
        sample.component_starts,
        surface.points,
        surface.normals,
        surface.weights,
        surface.centroids,
        np.float32(reference),
        np.float32(DISTANCE_LIMIT),
        np.float32(WEIGHT_OFFSET),
        _inner_edges(sine_edges),
        _inner_edges(distance_edges),
        parameters.n_distance_bins,
        histograms,
    )


def _inner_edges(edges: np.ndarray) -> np.ndarray:
    """All but the first and last, filled up with infinity to a multiple of 8, as the kernel wants them."""
    inner = edges[1:-1].astype(np.float32)
    return np.pad(inner, (0, -len(inner) % 8), constant_values=np.inf)


def _reference_distance(fields: np.ndarray, batches: np.ndarray, graph: FaceGraph, sample: FaceSample) -> float:
    """g95: the REFERENCE_QUANTILE of the finite geodesics of face pairs, 0 if there are none.

    A target counts once for each face of its cell. Two rounds of histograms narrow it to 2^-24 of the greatest, which
    is what float32 resolves, without sorting (or copying) millions of values.
    """
    n_bins = 4096
    low, high = 0.0, float(kernels.greatest_distance(fields, graph.n_faces))
    weights = sample.n_cell_faces.astype(np.float64)
    wanted = None
    for _ in range(2):
        if not high > low:
            break
        below, inside = kernels.distance_histogram(
            fields, batches, graph.component, sample.faces, sample.component_starts, weights, low, high, n_bins
        )
        wanted = REFERENCE_QUANTILE * inside.sum() if wanted is None else wanted
        found = min(int(np.searchsorted(below + np.cumsum(inside), wanted)), n_bins - 1)
        step = (high - low) / n_bins
        low, high = low + found * step, low + (found + 1) * step
    return high
