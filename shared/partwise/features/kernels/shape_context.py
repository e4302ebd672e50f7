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


@njit(cache=True, parallel=True)
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


@njit(cache=True, parallel=True)
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


@njit(cache=True)
def _bin_of(value, low, cells_per_unit, first_bin, edges):
    """Bin of `value`, edges[bin] ≤ value < edges[bin + 1], from a table of the bin at the start of equal cells."""
    cell = min(max(int((value - low) * cells_per_unit), 0), len(first_bin) - 1)
    found = first_bin[cell]
    while found + 2 < len(edges) and value >= edges[found + 1]:
        found += 1
    return found


@njit(cache=True)
def _first_bins(edges, n_cells):
    """The bin in which each of n_cells equal cells between the first and the last edge begins."""
    first = np.zeros(n_cells, np.int64)
    for cell in range(n_cells):
        start = edges[0] + (edges[-1] - edges[0]) * cell / n_cells
        while first[cell] + 2 < len(edges) and start >= edges[first[cell] + 1]:
            first[cell] += 1
    return first


@njit(cache=True, parallel=True)
def add_to_histograms(
    fields, batches, component, targets, target_starts, target_points, target_normals, target_weights,
    centroids, reference, weight_offset, sine_edges, distance_edges, histograms,
):  # fmt: skip
    """Adds these batches' targets to histograms (m, angle bins · distance bins) float32.

    sine_edges are the sines of the angle bins' edges, distance_edges are relative to `reference`, the g95.
    """
    n_angles, n_distances = len(sine_edges) - 1, len(distance_edges) - 1
    sine_cells, distance_cells = _first_bins(sine_edges, 16 * n_angles), _first_bins(distance_edges, 4 * n_distances)
    sines_per_unit = len(sine_cells) / (sine_edges[-1] - sine_edges[0])
    distances_per_unit = len(distance_cells) / distance_edges[-1]
    for face in prange(len(component)):
        row = histograms[face]
        x, y, z = centroids[face]
        end = target_starts[component[face] + 1]
        for b in range(len(batches)):
            first = target_starts[component[face]] + LANES * batches[b]
            for t in range(first, min(first + LANES, end)):
                distance = fields[b, face, t - first] / reference
                if targets[t] == face or not distance < distance_edges[-1]:
                    continue
                dx, dy, dz = target_points[t, 0] - x, target_points[t, 1] - y, target_points[t, 2] - z
                length = np.sqrt(dx * dx + dy * dy + dz * dz)
                sine = dx * target_normals[t, 0] + dy * target_normals[t, 1] + dz * target_normals[t, 2]
                sine = sine / length if length > 0 else 0.0
                angle_bin = _bin_of(sine, sine_edges[0], sines_per_unit, sine_cells, sine_edges)
                distance_bin = _bin_of(distance, 0.0, distances_per_unit, distance_cells, distance_edges)
                row[angle_bin * n_distances + distance_bin] += target_weights[t] / (distance + weight_offset)
