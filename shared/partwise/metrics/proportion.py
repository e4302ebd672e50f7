"""A share that was counted on a sample, and what it may be in truth."""

import math

from partwise.errors import ParameterError

_Z_95 = 1.959963984540054


def share_interval(n_hits: int, n_tried: int) -> tuple[float, float]:
    """The 95 % interval of a share of which `n_hits` of `n_tried` were seen; (0, 1) where nothing was tried.

    Raises
    ------
    ParameterError : fewer tries than hits, or a count below 0.

    Source: Wilson 1927, the score interval: it stays inside [0, 1] and holds for few tries and for no hits.
    """
    if not 0 <= n_hits <= n_tried:
        raise ParameterError(f"hits must be 0 to the number of tries but are {n_hits} of {n_tried}; count them again")
    if n_tried == 0:
        return 0.0, 1.0
    share, z2 = n_hits / n_tried, _Z_95**2
    centre = (share + z2 / (2 * n_tried)) / (1 + z2 / n_tried)
    half = _Z_95 / (1 + z2 / n_tried) * math.sqrt(share * (1 - share) / n_tried + z2 / (4 * n_tried**2))
    low = 0.0 if n_hits == 0 else max(0.0, centre - half)
    high = 1.0 if n_hits == n_tried else min(1.0, centre + half)
    return low, high
