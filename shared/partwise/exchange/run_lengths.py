"""Run lengths of a mask, as COCO counts them: unmarked, marked, unmarked, …; the first may be 0."""

import numpy as np
from jaxtyping import Bool, Int


def run_lengths(mask: Bool[np.ndarray, " m"]) -> Int[np.ndarray, " r"]:
    """Lengths of the runs of `mask`, (r,) int64; they sum to m. An empty mask has none."""
    if not len(mask):
        return np.zeros(0, dtype=np.int64)
    changes = np.flatnonzero(mask[1:] != mask[:-1]) + 1
    lengths = np.diff(np.concatenate([[0], changes, [len(mask)]])).astype(np.int64)
    return np.concatenate([[0], lengths]) if mask[0] else lengths


def mask_of(lengths: Int[np.ndarray, " r"]) -> Bool[np.ndarray, " m"]:
    """The mask of run lengths ≥ 0."""
    return np.repeat(np.arange(len(lengths)) % 2 == 1, lengths)
