"""Per-face label arrays as compressed bytes, with a checksum of the labels themselves.

The checksum is over the raw little-endian uint16 values, so it stays the same whatever the compressor does.
"""

import hashlib
from dataclasses import dataclass

import numpy as np
from jaxtyping import UInt16
from numcodecs import Zstd  # type: ignore[import-untyped]  # ships no types

from partwise.errors import LabelError

_ZSTD_LEVEL = 3


@dataclass(frozen=True, slots=True)
class EncodedLabels:
    """A zstd frame of little-endian uint16, how many faces it covers, and the SHA-256 (hex) of the raw values."""

    blob: bytes
    n_faces: int
    sha256: str


def labels_sha256(labels: UInt16[np.ndarray, " m"]) -> str:
    """SHA-256 (hex) of the labels as little-endian uint16: equal for equal labels, whatever stored them."""
    return hashlib.sha256(labels.astype("<u2").tobytes()).hexdigest()


def encode_labels(labels: UInt16[np.ndarray, " m"]) -> EncodedLabels:
    """Compress a label array (m,) uint16, 0 = unlabelled."""
    blob = Zstd(level=_ZSTD_LEVEL).encode(np.ascontiguousarray(labels, dtype="<u2"))
    return EncodedLabels(bytes(blob), len(labels), labels_sha256(labels))


def decode_labels(encoded: EncodedLabels) -> UInt16[np.ndarray, " m"]:
    """The label array (m,) uint16 that was encoded, writable.

    Raises
    ------
    LabelError : the bytes are damaged, or disagree with the face count or the checksum.
    """
    try:
        raw = bytes(Zstd().decode(encoded.blob)) if encoded.n_faces else b""  # the codec refuses an empty frame
    except RuntimeError as error:
        raise LabelError(f"a label blob must be one zstd frame but: {error}; restore it from a backup") from error
    if len(raw) != 2 * encoded.n_faces:
        raise LabelError(f"a label blob must hold {encoded.n_faces} labels but holds {len(raw) / 2:g}; restore it")
    labels = np.frombuffer(raw, dtype="<u2").astype(np.uint16)
    if labels_sha256(labels) != encoded.sha256:
        raise LabelError(f"labels must have checksum {encoded.sha256[:12]}… but do not; restore them from a backup")
    return labels
