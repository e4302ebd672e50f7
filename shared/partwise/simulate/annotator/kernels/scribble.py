"""Compiled inner loop of planning a drag."""

# Types are inferred at compile time and array shapes are in the docstrings.
# mypy: allow-untyped-defs, allow-untyped-calls

import numpy as np
from numba import njit


@njit(cache=True)
def scribble(points, is_eligible, start, radius, jump, max_seeds):
    """Places (k,) int64 that a drag passes, and which places (n,) bool lie within the radius of one of them.

    points (n, 3), is_eligible (n,) where the brush may be put, start one of them. From each place the drag goes on to
    the nearest eligible one that no ball covers yet, at most `jump` away.
    """
    n = len(points)
    is_covered = np.zeros(n, np.bool_)
    seeds = np.empty(max_seeds, np.int64)
    n_seeds, at = 0, start
    reach, farthest = radius * radius, jump * jump
    while at >= 0 and n_seeds < max_seeds:
        seeds[n_seeds] = at
        n_seeds += 1
        following, least = -1, np.inf
        for i in range(n):
            dx = points[i, 0] - points[at, 0]
            dy = points[i, 1] - points[at, 1]
            dz = points[i, 2] - points[at, 2]
            squared = dx * dx + dy * dy + dz * dz
            if squared <= reach:
                is_covered[i] = True
            elif is_eligible[i] and not is_covered[i] and squared <= farthest and squared < least:
                following, least = i, squared
        at = following
    return seeds[:n_seeds], is_covered
