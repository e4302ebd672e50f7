"""Vertices at exactly one position made one: for formats that repeat a vertex per face or per seam."""

import numpy as np
from jaxtyping import Float, Int


def weld_equal_vertices(
    vertices: Float[np.ndarray, "n 3"], faces: Int[np.ndarray, "m 3"]
) -> tuple[Float[np.ndarray, "k 3"], Int[np.ndarray, "m 3"]]:
    """Keeps the first of exactly equal vertices (0.0 equals −0.0; no tolerance) and renumbers the faces' corners.

    Vertices stay in order of first appearance and faces in theirs; a face may become degenerate, never vanish.
    """
    _, first, inverse = np.unique(vertices + 0.0, axis=0, return_index=True, return_inverse=True)
    order = np.argsort(first, kind="stable")
    rank = np.empty(len(order), dtype=np.int64)
    rank[order] = np.arange(len(order))
    return vertices[first[order]], rank[inverse.ravel()][faces]
