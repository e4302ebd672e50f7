"""Sets of faces as runs of consecutive indices, which is how patches and regions mostly come."""

import numpy as np
from jaxtyping import Int, Integer


def runs_of(
    faces: Int[np.ndarray, " k"], values: Integer[np.ndarray, " k"] | None = None
) -> tuple[Int[np.ndarray, " r"], Int[np.ndarray, " r"]]:
    """First face and count of each run of consecutive faces, which must ascend; with `values`, of one value each."""
    is_new = np.ones(len(faces), dtype=bool)
    is_new[1:] = np.diff(faces) != 1
    if values is not None:
        is_new[1:] |= values[1:] != values[:-1]
    starts = np.flatnonzero(is_new)
    return faces[starts], np.diff(starts, append=len(faces))
