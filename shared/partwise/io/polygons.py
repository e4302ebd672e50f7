"""Polygons to triangles, in the order of the file."""

import numpy as np
from jaxtyping import Int

from partwise.errors import FileFormatError


def fan_triangles(n_corners: Int[np.ndarray, " p"], corners: Int[np.ndarray, " c"]) -> Int[np.ndarray, "m 3"]:
    """Triangles of each polygon, fanned from its first corner; polygon order and then fan order.

    Parameters
    ----------
    n_corners : (p,) corners of each polygon, at least 3.
    corners : (c,) vertex indices of all polygons one after another, c = Σ n_corners.

    Returns
    -------
    triangles : (m, 3) int64, m = Σ (n_corners − 2). A concave polygon's fan may fold over itself.

    Raises
    ------
    FileFormatError : a polygon has fewer than 3 corners (dropping it would shift the faces after it).
    """
    if len(n_corners) and int(n_corners.min()) < 3:
        first = int(np.argmax(n_corners < 3))
        raise FileFormatError(
            f"a face must have at least 3 corners but face {first + 1} has {int(n_corners[first])}; "
            "remove points and lines from the file's faces"
        )
    n_triangles = n_corners - 2
    start = np.repeat(np.cumsum(n_corners) - n_corners, n_triangles)
    step = np.arange(len(start)) - np.repeat(np.cumsum(n_triangles) - n_triangles, n_triangles)
    return np.stack([corners[start], corners[start + step + 1], corners[start + step + 2]], axis=1).astype(np.int64)
