"""Compiled inner loops of the shape context: percentile of the geodesics, and binning.

`fields` is (b, nodes, LANES) float32, as `partwise.geometry.kernels.geodesics.geodesic_batches` fills it: the target of
fields[b, face, lane] is target_starts[component[face]] + LANES·batches[b] + lane. Face-parallel loops add in a fixed
order, so that results do not depend on the number of threads.
"""

# Types are inferred at compile time and array shapes are in the docstrings.
# mypy: allow-untyped-defs, allow-untyped-calls

import numpy as np
from numba import njit, prange

from partwise.geometry.kernels.geodesics import LANES

# error_model="numpy": a division that could raise would keep its loop from becoming vector instructions.


@njit(cache=True, parallel=True, error_model="numpy")
def greatest_distance(fields, n_faces):
    """The greatest finite distance, 0 if there is none."""
    greatest = np.zeros(len(fields), np.float32)
    for b in prange(len(fields)):
        for face in range(n_faces):
            for lane in range(LANES):
                distance = fields[b, face, lane]
                if distance > greatest[b] and distance < np.inf:
                    greatest[b] = distance
    return greatest.max()


@njit(cache=True, parallel=True, error_model="numpy")
def distance_histogram(fields, batches, component, targets, target_starts, weights, low, high, n_bins):
    """Weight of the pairs (face, target) below `low`, and in n_bins equal bins over [low, high]; no self pairs."""
    below = np.zeros(len(batches))
    inside = np.zeros((len(batches), n_bins))
    scale = n_bins / (high - low)
    for b in prange(len(batches)):
        for face in range(len(component)):
            first = target_starts[component[face]] + LANES * batches[b]
            for t in range(first, min(first + LANES, target_starts[component[face] + 1])):
                distance = fields[b, face, t - first]
                if targets[t] == face or distance > high:
                    continue
                if distance < low:
                    below[b] += weights[t]
                else:
                    inside[b, min(int((distance - low) * scale), n_bins - 1)] += weights[t]
    return below.sum(), inside.sum(axis=0)


@njit(cache=True, error_model="numpy")
def _sines(points, normals, x, y, z, first, last, sine):
    """Sine of the angle of targets first … last − 1 seen from (x, y, z); 0 where the two coincide."""
    # Slices and not offsets: an index that may be negative keeps the loop from becoming vector instructions.
    px, py, pz = points[0, first:last], points[1, first:last], points[2, first:last]
    nx, ny, nz = normals[0, first:last], normals[1, first:last], normals[2, first:last]
    for lane in range(last - first):
        dx, dy, dz = px[lane] - x, py[lane] - y, pz[lane] - z
        square = dx * dx + dy * dy + dz * dz
        along = dx * nx[lane] + dy * ny[lane] + dz * nz[lane]
        sine[lane] = along / np.sqrt(max(square, np.float32(1e-30)))


@njit(cache=True, error_model="numpy")
def _count_passed(values, edges, stride, bins, n):
    """Adds `stride` to each of n bins for every edge that its value has reached; edges come in multiples of 8."""
    for at in range(0, len(edges), 8):
        group = edges[at : at + 8]
        for lane in range(n):
            passed = np.int32(0)
            for k in range(8):  # a fixed number, so that it unrolls within the vector loop
                passed += np.int32(values[lane] >= group[k])
            bins[lane] += passed * stride


@njit(cache=True, error_model="numpy")
def _deposit(row, bins, distance, limit, weights, weight_offset, targets, face):
    for lane in range(len(targets)):
        if distance[lane] < limit and targets[lane] != face:
            row[bins[lane]] += weights[lane] / (distance[lane] + weight_offset)


@njit(cache=True, parallel=True, error_model="numpy")
def add_to_histograms(
    fields, batches, component, targets, target_starts, points, normals, weights,
    centroids, reference, limit, weight_offset, sine_edges, distance_edges, n_distance_bins, histograms,
):  # fmt: skip
    """Adds these batches' targets to histograms (m, angle bins · distance bins) float32.

    points and normals (3, t) and weights (t,) are the targets', centroids (m, 3) the faces'. sine_edges are the sines
    of the inner edges of the angle bins, distance_edges the inner edges relative to `reference`, the g95; both filled
    up with infinity to a multiple of 8. Distances from `limit` on are dropped. All float32.
    """
    scale = np.float32(1.0) / reference
    for face in prange(len(component)):
        row = histograms[face]
        sine, distance = np.empty(LANES, np.float32), np.empty(LANES, np.float32)
        bins = np.empty(LANES, np.uint32)
        x, y, z = centroids[face, 0], centroids[face, 1], centroids[face, 2]
        for b in range(len(batches)):
            first = target_starts[component[face]] + LANES * batches[b]
            last = min(first + LANES, target_starts[component[face] + 1])
            if last <= first:
                continue
            n = last - first
            field = fields[b, face]
            for lane in range(n):
                distance[lane] = field[lane] * scale
            _sines(points, normals, x, y, z, first, last, sine)
            bins[:] = 0
            _count_passed(sine, sine_edges, np.uint32(n_distance_bins), bins, n)
            _count_passed(distance, distance_edges, np.uint32(1), bins, n)
            _deposit(row, bins, distance, limit, weights[first:last], weight_offset, targets[first:last], face)
