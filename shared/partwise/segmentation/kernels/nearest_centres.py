"""Compiled inner loop of k-means: which centre is nearest."""

# Types are inferred at compile time and array shapes are in the docstrings.
# mypy: allow-untyped-defs, allow-untyped-calls

import numpy as np
from numba import njit


@njit(cache=True, error_model="numpy")
def nearest_centres(features, centres, first_guess):
    """Index of each row's nearest centre, (m,) int64. features (m, d), centres (n, d), first_guess (m,) int64.

    Ties go to the guess, then to the lower index. A good guess lets most centres be given up after a term or two.
    """
    m, d = features.shape
    nearest = np.empty(m, np.int64)
    for f in range(m):
        best = first_guess[f]
        least = 0.0
        for k in range(d):
            least += (features[f, k] - centres[best, k]) ** 2
        for c in range(len(centres)):
            squared = 0.0
            for k in range(d):
                squared += (features[f, k] - centres[c, k]) ** 2
                if squared >= least:
                    break
            if squared < least:
                best, least = c, squared
        nearest[f] = best
    return nearest
