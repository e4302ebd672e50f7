"""Compiled inner loops of the spin image. Parallel over faces, each adding its vertices in a fixed order."""

# Types are inferred at compile time and array shapes are in the docstrings.
# mypy: allow-untyped-defs, allow-untyped-calls

import numpy as np
from numba import njit, prange

# error_model="numpy": a division that could raise would keep its loop from becoming vector instructions.

NARROWNESS = 0.2
LEAST_WEIGHT = 0.02
BLOCK = 512
"""Points taken at a time: their intermediate values stay in the nearest cache."""


@njit(cache=True, error_model="numpy")
def _select_points(points, point_normals, point_weights, origin, axis, support_square, all_points, selected):
    """Squared α, β and weight of the points that count, into the first columns of `selected`; returns how many.

    all_points (3, BLOCK) is scratch space: squared α, β and whether the point counts, of every point.
    """
    x, y, z = origin[0], origin[1], origin[2]
    nx, ny, nz = axis[0], axis[1], axis[2]
    px, py, pz = points[0], points[1], points[2]
    qx, qy, qz = point_normals[0], point_normals[1], point_normals[2]
    square, height, counts = all_points[0], all_points[1], all_points[2]
    for p in range(len(px)):
        dx, dy, dz = px[p] - x, py[p] - y, pz[p] - z
        along = dx * nx + dy * ny + dz * nz
        square[p], height[p] = dx * dx + dy * dy + dz * dz - along * along, along
        counts[p] = qx[p] * nx + qy[p] * ny + qz[p] * nz >= np.float32(0)
    alpha_square, beta, weight = selected[0], selected[1], selected[2]
    n = 0
    for p in range(len(px)):
        # Writing always and counting on demand avoids a branch that is wrong half of the time.
        alpha_square[n], beta[n], weight[n] = square[p], height[p], point_weights[p]
        n += (counts[p] > 0) & (square[p] < support_square)
    return n


@njit(cache=True, error_model="numpy")
def _exponential(x):
    """e^x for |x| ≤ 5 to 1e-6, relative: a Taylor series of x / 16, to the 16th. Unlike exp, it vectorises."""
    y = x * np.float32(1 / 16)
    series = np.float32(1 / 120) + y * np.float32(1 / 720)
    series = np.float32(1 / 6) + y * (np.float32(1 / 24) + y * series)
    series = np.float32(1) + y * (np.float32(1) + y * (np.float32(0.5) + y * series))
    square = series * series
    fourth = square * square
    eighth = fourth * fourth
    return eighth * eighth


@njit(cache=True, error_model="numpy")
def _corner_weights(selected, n, half, bins_per_unit, n_bins, corners, at):
    """Shares of each point in the four bins around it, into corners (4, n), and the first bin's place, into at (n,)."""
    alpha_square, beta, weight = selected[0], selected[1], selected[2]
    c00, c01, c10, c11 = corners[0], corners[1], corners[2], corners[3]
    slope = np.float32(2.0 / NARROWNESS)
    cut = np.float32(-NARROWNESS * np.log(LEAST_WEIGHT))
    one, zero, middle, last = np.float32(1), np.float32(0), np.float32(0.5), np.float32(n_bins - 1)
    for p in range(n):
        # Bin centres lie at whole numbers: the four around the point are at distances u or 1 − u, v or 1 − v.
        column = np.sqrt(max(alpha_square[p], zero)) * bins_per_unit - middle
        line = (min(max(beta[p], -half), half) + half) * bins_per_unit - middle
        j, i = np.floor(column), np.floor(line)
        u, v = column - j, line - i
        # exp(−(1−u)²/w) = exp(−u²/w)·exp((2u−1)/w): the factor common to all four falls out of the normalisation.
        left, right = (one if j >= zero else zero), (_exponential((u - middle) * slope) if j < last else zero)
        above, below = (one if i >= zero else zero), (_exponential((v - middle) * slope) if i < last else zero)
        uu, vv, uu1, vv1 = u * u, v * v, (one - u) * (one - u), (one - v) * (one - v)
        w00 = left * above if uu + vv <= cut else zero
        w01 = right * above if uu1 + vv <= cut else zero
        w10 = left * below if uu + vv1 <= cut else zero
        w11 = right * below if uu1 + vv1 <= cut else zero
        share = weight[p] / (w00 + w01 + w10 + w11)
        c00[p], c01[p], c10[p], c11[p] = w00 * share, w01 * share, w10 * share, w11 * share
        # The image has a border one bin wide, so that the bins outside it need no test.
        at[p] = np.uint32((i + one) * np.float32(n_bins + 2) + j + one)


@njit(cache=True, error_model="numpy")
def _add(image, width, corners, at):
    c00, c01, c10, c11 = corners[0], corners[1], corners[2], corners[3]
    for p in range(len(at)):
        image[at[p]] += c00[p]
        image[at[p] + 1] += c01[p]
        image[at[p] + width] += c10[p]
        image[at[p] + width + 1] += c11[p]


@njit(cache=True, parallel=True, error_model="numpy")
def spin_images(centroids, normals, points, point_normals, point_weights, support, n_bins):
    """(m, n_bins²) float32; see `partwise.features.spin_image`.

    All float32: centroids and normals (m, 3) of the faces, points and point_normals (3, n), point_weights (n,).
    """
    result = np.empty((len(centroids), n_bins * n_bins), np.float32)
    bins_per_unit, half = np.float32(n_bins / support), np.float32(support / 2)
    # A shade inside, so that rounding cannot put a point past the last bin's outer edge.
    support_square = np.float32(support * support * (1 - 1e-6))
    width = n_bins + 2
    for face in prange(len(centroids)):
        image = np.zeros(width * width, np.float32)
        all_points, selected = np.empty((3, BLOCK), np.float32), np.empty((3, BLOCK), np.float32)
        corners, at = np.empty((4, BLOCK), np.float32), np.empty(BLOCK, np.uint32)
        for first in range(0, len(point_weights), BLOCK):
            block = slice(first, min(first + BLOCK, len(point_weights)))
            n = _select_points(
                points[:, block], point_normals[:, block], point_weights[block],
                centroids[face], normals[face], support_square, all_points, selected,
            )  # fmt: skip
            _corner_weights(selected, n, half, bins_per_unit, n_bins, corners, at)
            _add(image, width, corners, at[:n])
        for i in range(n_bins):
            result[face, i * n_bins : (i + 1) * n_bins] = image[(i + 1) * width + 1 : (i + 1) * width + 1 + n_bins]
    return result
