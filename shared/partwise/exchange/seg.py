"""Per-face `.seg`: one whole number a face, without names; −1 = unlabelled."""

from pathlib import Path

import numpy as np
from jaxtyping import Int

from partwise.errors import FileFormatError, LabelError
from partwise.exchange.label_files import read_label_bytes
from partwise.io.atomic import write_atomically
from partwise.io.text import parse_integers


def read_seg(path: Path | str, n_faces: int, data: bytes | None = None) -> Int[np.ndarray, " m"]:
    """Label of each face, (m,) int64, numbers as in the file.

    Raises
    ------
    FileFormatError : missing, empty, or not whole numbers.
    LabelError : not one number per face, or one below −1.
    """
    tokens = read_label_bytes(path, data).split()
    try:
        labels = parse_integers(tokens, "labels")
    except FileFormatError as error:
        raise FileFormatError(f"{path}: {error}") from error
    if len(labels) != n_faces:
        raise LabelError(f"{path}: {n_faces} faces must have a label each but there are {len(labels)}; another mesh's?")
    if n_faces and int(labels.min()) < -1:
        raise LabelError(f"{path}: labels must be −1 or more but one is {int(labels.min())}; −1 means unlabelled")
    return labels


def write_seg(path: Path | str, labels: Int[np.ndarray, " m"]) -> None:
    """Writes one label a line.

    Raises
    ------
    LabelError : labels are not (m,) whole numbers ≥ −1.
    StoreError : the file cannot be written.
    """
    if labels.ndim != 1 or labels.dtype.kind not in "iu" or (len(labels) and int(labels.min()) < -1):
        raise LabelError(
            f"{path}: labels must be (m,) whole numbers ≥ −1 but are {labels.shape} {labels.dtype}; map them"
        )
    write_atomically(path, "".join(f"{label}\n" for label in labels.tolist()).encode("ascii"))
