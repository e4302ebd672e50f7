"""Polygons to triangles, in the order of the file."""

from array import array
from collections.abc import Sequence

import numpy as np
from jaxtyping import Int

from partwise.errors import FileFormatError
from partwise.io.limits import ReadLimits
from partwise.io.text import whole_numbers


class PolygonRows:
    """Collects the polygons of a text file, one at a time, and counts their triangles before it takes them.

    what : names the corners in errors.
    """

    def __init__(self, limits: ReadLimits, what: str) -> None:
        self._limits = limits
        self._what = what
        self._n_triangles = 0
        self._n_corners = array("q")
        self._corners = array("q")

    def __len__(self) -> int:
        return len(self._n_corners)

    @property
    def n_allowed(self) -> int:
        """Corners that the next polygon may have, at most."""
        return self._limits.max_faces - self._n_triangles + 2

    def check(self, n_corners: int) -> None:
        """Raises FileFormatError if the next polygon has too many corners."""
        self._limits.check_faces(self._n_triangles + n_corners - 2)

    def take(self, tokens: Sequence[bytes]) -> None:
        """Adds a polygon of these corners.

        Raises
        ------
        FileFormatError : there are too many, or one is no whole number.
        """
        self.check(len(tokens))
        self._n_triangles += max(len(tokens) - 2, 1)  # those with too few are refused at the end; until then they count
        self._n_corners.append(len(tokens))
        self._corners.extend(whole_numbers(tokens, self._what))

    def n_corners(self) -> Int[np.ndarray, " p"]:
        """(p,) corners of each polygon."""
        return np.array(self._n_corners, dtype=np.int64)

    def corners(self) -> Int[np.ndarray, " c"]:
        """(c,) corners as the file has them, of all polygons one after another."""
        return np.array(self._corners, dtype=np.int64)


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
