"""Compiled inner loops of the shape diameter. Parallel over faces; nothing depends on the number of threads."""

# Types are inferred at compile time and array shapes are in the docstrings.
# mypy: allow-untyped-defs, allow-untyped-calls

import numpy as np
from numba import njit, prange


@njit(cache=True, parallel=True, error_model="numpy")
def inward_rays(centroids, normals, tangents, disk, offset, first, count):
    """Origins and unit directions, (count · rays, 3) float32, of the cones of faces first … first + count − 1.

    disk (rays, 2): where each ray pierces the plane at distance 1; x along the tangent, y along normal × tangent.
    """
    n_rays = len(disk)
    origins = np.empty((count * n_rays, 3), np.float32)
    directions = np.empty((count * n_rays, 3), np.float32)
    for k in prange(count):
        normal, tangent = normals[first + k], tangents[first + k]
        other = np.cross(normal, tangent)
        for r in range(n_rays):
            length = np.sqrt(1.0 + disk[r, 0] ** 2 + disk[r, 1] ** 2)
            for axis in range(3):
                inward = -normal[axis] + disk[r, 0] * tangent[axis] + disk[r, 1] * other[axis]
                origins[k * n_rays + r, axis] = centroids[first + k, axis] - offset * normal[axis]
                directions[k * n_rays + r, axis] = inward / length
    return origins, directions


@njit(cache=True, parallel=True, error_model="numpy")
def robust_means(hits, directions, centroids, normals, points, first, spread, out):
    """Mean ray length of faces first … into out, NaN where no ray counts.

    hits (count · rays,): face hit or −1. A ray counts if it hits a surface facing away from the cone's face; of those,
    the ones within `spread` median absolute deviations of the median. points: a point of each face.
    """
    count = len(out)
    n_rays = len(hits) // count
    for k in prange(count):
        face = first + k
        lengths = np.empty(n_rays)
        n = 0
        for r in range(n_rays):
            hit = hits[k * n_rays + r]
            if hit < 0 or np.sum(normals[hit] * normals[face]) >= 0:
                continue
            towards, height = 0.0, 0.0
            for axis in range(3):
                towards += directions[k * n_rays + r, axis] * normals[hit, axis]
                height += (points[hit, axis] - centroids[face, axis]) * normals[hit, axis]
            if towards != 0 and height / towards >= 0:
                lengths[n] = height / towards
                n += 1
        out[k] = np.nan
        if n > 0:
            median = np.median(lengths[:n])
            allowed = spread * np.median(np.abs(lengths[:n] - median)) + 1e-9 * median
            total, kept = 0.0, 0
            for value in lengths[:n]:
                if abs(value - median) <= allowed:
                    total += value
                    kept += 1
            # The middle of two far-apart halves may be near neither of them.
            out[k] = total / kept if kept > 0 else median


@njit(cache=True, error_model="numpy")
def _rings(face, n_rings, starts, neighbours, found, ring):
    """Faces within n_rings steps of `face`, itself first, with their ring; returns how many (at most len(found))."""
    found[0], ring[0] = face, 0
    n, at = 1, 0
    while at < n and ring[at] < n_rings:
        for e in range(starts[found[at]], starts[found[at] + 1]):
            other = neighbours[e]
            is_new = True
            for seen in found[:n]:
                if seen == other:
                    is_new = False
                    break
            if is_new and n < len(found):
                found[n], ring[n] = other, ring[at] + 1
                n += 1
        at += 1
    return n


@njit(cache=True, parallel=True, error_model="numpy")
def smooth_bilaterally(values, starts, neighbours, n_rings, range_factor):
    """Mean over the rings around each face, weighted by ring (σ = n_rings/2) and likeness (σ = factor · local RMS)."""
    result = np.empty_like(values)
    spatial = n_rings / 2.0
    most = 4 * (n_rings + 1) * (n_rings + 1)
    for face in prange(len(values)):
        found, ring = np.empty(most, np.int64), np.empty(most, np.int64)
        n = _rings(face, n_rings, starts, neighbours, found, ring)
        square = 0.0
        for other in found[:n]:
            square += (values[other] - values[face]) ** 2
        likeness = range_factor * np.sqrt(square / n)
        total, weights = 0.0, 0.0
        for k in range(n):
            weight = np.exp(-0.5 * (ring[k] / spatial) ** 2)
            if likeness > 0:
                weight *= np.exp(-0.5 * ((values[found[k]] - values[face]) / likeness) ** 2)
            total += weight * values[found[k]]
            weights += weight
        result[face] = total / weights
    return result
