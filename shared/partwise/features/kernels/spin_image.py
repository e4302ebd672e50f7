"""Compiled inner loop of the spin image. Parallel over faces, each adding its vertices in a fixed order."""

# Types are inferred at compile time and array shapes are in the docstrings.
# mypy: allow-untyped-defs, allow-untyped-calls

import numpy as np
from numba import njit, prange

NARROWNESS = 0.2
LEAST_WEIGHT = 0.02


@njit(cache=True, parallel=True)
def spin_images(centroids, normals, points, point_normals, point_weights, support, n_bins):
    """(m, n_bins²) float32 from float32 arrays; see `partwise.features.spin_image`."""
    result = np.zeros((len(centroids), n_bins * n_bins), np.float32)
    bins_per_unit = np.float32(n_bins / support)
    half = np.float32(support / 2)
    greatest_square = np.float32(-NARROWNESS * np.log(LEAST_WEIGHT))
    support_square = np.float32(support * support)
    slope = np.float32(2.0 / NARROWNESS)
    one, zero, centre = np.float32(1.0), np.float32(0.0), np.float32(0.5)
    for face in prange(len(centroids)):
        row = result[face]
        x, y, z = centroids[face]
        nx, ny, nz = normals[face]
        for p in range(len(points)):
            if point_normals[p, 0] * nx + point_normals[p, 1] * ny + point_normals[p, 2] * nz < zero:
                continue
            dx, dy, dz = points[p, 0] - x, points[p, 1] - y, points[p, 2] - z
            beta = dx * nx + dy * ny + dz * nz
            alpha_square = max(dx * dx + dy * dy + dz * dz - beta * beta, zero)
            if alpha_square >= support_square:
                continue
            # Bin centres lie at whole numbers: the four around the point are at distances u or 1 − u, v or 1 − v.
            column = np.sqrt(alpha_square) * bins_per_unit - centre
            line = (min(max(beta, -half), half) + half) * bins_per_unit - centre
            j, i = int(np.floor(column)), int(np.floor(line))
            u, v = column - j, line - i
            # exp(−(1−u)²/w) = exp(−u²/w)·exp((2u−1)/w); the common factor falls out of the normalisation.
            right, below = np.exp((u - centre) * slope), np.exp((v - centre) * slope)
            uu, vv, uu1, vv1 = u * u, v * v, (one - u) * (one - u), (one - v) * (one - v)
            w00 = one if uu + vv <= greatest_square and i >= 0 and j >= 0 else zero
            w01 = right if uu1 + vv <= greatest_square and i >= 0 and j + 1 < n_bins else zero
            w10 = below if uu + vv1 <= greatest_square and i + 1 < n_bins and j >= 0 else zero
            w11 = right * below if uu1 + vv1 <= greatest_square and i + 1 < n_bins and j + 1 < n_bins else zero
            total = w00 + w01 + w10 + w11
            if total <= zero:
                continue
            share = point_weights[p] / total
            at = i * n_bins + j
            if w00 > zero:
                row[at] += w00 * share
            if w01 > zero:
                row[at + 1] += w01 * share
            if w10 > zero:
                row[at + n_bins] += w10 * share
            if w11 > zero:
                row[at + n_bins + 1] += w11 * share
    return result
