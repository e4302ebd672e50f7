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
    n_rows = int(np.diff(sample.component_starts).max())
    if n_rows == 0:
        return histograms
    n_held = max(1, VALUES_HELD // (graph.n_nodes * LANES))
    stride = -(-n_rows // (n_held * LANES))
    sample = _every_nth_first(sample, stride)
    batches = np.arange(-(-n_rows // LANES))
    n_first = -(-n_rows // (stride * LANES))
    fields = np.empty((min(n_held, len(batches)), graph.n_nodes, LANES), dtype=np.float32)
    surface = _Surface.of(mesh, sample)
    reference = None
    for some in (batches[:n_first], *np.split(batches[n_first:], range(n_held, len(batches) - n_first, n_held))):
        held = fields[: len(some)]
        geodesic_batches(
            graph.starts, graph.neighbours, graph.lengths, sample.faces, sample.component_starts, some, held
        )
        if reference is None:
            reference = _reference_distance(held, some, graph, sample)
        if not reference > 0:
            break
        _bin(held, some, reference, graph, sample, surface, parameters, histograms)
    return histograms


def _every_nth_first(sample: FaceSample, n: int) -> FaceSample:
    """The same sample, in each component every nth face first: these are spread over all of it, and still in line."""
    starts = sample.component_starts
    position = np.arange(len(sample.faces)) - np.repeat(starts[:-1], np.diff(starts))
    component = np.repeat(np.arange(len(starts) - 1), np.diff(starts))
    order = np.lexsort((position % n != 0, component))
    new_index = np.append(np.argsort(order), -1)
    return FaceSample(
        sample.faces[order], starts, new_index[sample.cell], sample.areas[order], sample.n_cell_faces[order]
    )


@dataclass(frozen=True, slots=True, eq=False)
class _Surface:
    """For binning, all float32: faces' centroids (m, 3); targets' points and normals (3, t) and weights (t,)."""

    centroids: np.ndarray
    points: np.ndarray
    normals: np.ndarray
    weights: np.ndarray

    @classmethod
    def of(cls, mesh: TriMesh, sample: FaceSample) -> "_Surface":
        centroids = face_centroids(mesh)
        # Only directions are taken from them, and float32 keeps these best near the origin, at a scale of one.
        centroids -= centroids.mean(axis=0)
        centroids /= max(float(np.abs(centroids).max()), np.finfo(np.float64).tiny)
        return cls(
            centroids.astype(np.float32),
            np.ascontiguousarray(centroids[sample.faces].T, dtype=np.float32),
            np.ascontiguousarray(face_normals(mesh)[sample.faces].T, dtype=np.float32),
            (sample.areas / sample.areas.sum()).astype(np.float32),
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

    A target counts once for each face of its cell, and those of these batches stand for their whole component. Two
    rounds of histograms narrow it to 2^-24 of the greatest, what float32 resolves, without sorting millions of values.
    """
    n_bins = 4096
    low, high = 0.0, float(kernels.greatest_distance(fields, graph.n_faces))
    weights = _face_counts(sample, LANES * len(batches))
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


def _face_counts(sample: FaceSample, n_first: int) -> np.ndarray:
    """Faces that each of the n_first first targets of a component stands for, (t,) float64; 0 for those after them."""
    starts = sample.component_starts
    component = np.repeat(np.arange(len(starts) - 1), np.diff(starts))
    is_first = np.arange(len(sample.faces)) - starts[component] < n_first
    counts = np.where(is_first, sample.n_cell_faces, 0).astype(np.float64)
    n_faces = np.bincount(component, weights=sample.n_cell_faces, minlength=len(starts) - 1)
    n_counted = np.bincount(component, weights=counts, minlength=len(starts) - 1)
    return counts * (n_faces / np.maximum(n_counted, 1))[component]
