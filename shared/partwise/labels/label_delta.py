"""`LabelDelta`: what a solver changed, kept because another machine's solver may answer otherwise.

Only changed faces are kept, as runs of consecutive faces with one new label, with a checksum of the whole result. So a
damaged delta, or one applied to labels it was not made for, is noticed.
"""

import base64
import binascii
import re
import zlib
from dataclasses import dataclass

import numpy as np
from jaxtyping import UInt16

from partwise.errors import LabelError
from partwise.labels.encoding import labels_sha256
from partwise.labels.face_runs import runs_of

_SHA256 = re.compile(r"[0-9a-f]{64}")
_RUN_BYTES = 10  # u32 first face, u32 count, u16 label
_REMEDY = "fetch it again or restore it from a backup"


@dataclass(frozen=True, slots=True)
class LabelDelta:
    """Changed faces of a mesh of `n_faces` faces, and the SHA-256 (hex) of all labels afterwards.

    payload : base64 of a zlib stream of `n_runs` first faces (little-endian u32), then as many counts (u32), then as
        many labels (u16); runs ascend and do not overlap.

    Raises
    ------
    LabelError : counts out of range, a checksum that is none.
    """

    n_faces: int
    n_runs: int
    payload: str
    sha256: str

    def __post_init__(self) -> None:
        if not 1 <= self.n_faces < 2**32 or not 0 <= self.n_runs <= self.n_faces:
            raise LabelError(
                f"a label delta must have 0 to n_faces runs but has {self.n_runs} for {self.n_faces} faces; {_REMEDY}"
            )
        if not _SHA256.fullmatch(self.sha256):
            raise LabelError(f"a label delta's checksum must be 64 hex digits but is {self.sha256!r}; {_REMEDY}")

    @classmethod
    def between(cls, before: UInt16[np.ndarray, " m"], after: UInt16[np.ndarray, " m"]) -> "LabelDelta":
        """The delta that turns `before` into `after`.

        Raises
        ------
        LabelError : the two differ in length.
        """
        if before.shape != after.shape:
            raise LabelError(f"labels must be of one mesh but have shapes {before.shape} and {after.shape}")
        faces = np.flatnonzero(before != after)
        first, count = runs_of(faces, after[faces])
        raw = first.astype("<u4").tobytes() + count.astype("<u4").tobytes() + after[first].astype("<u2").tobytes()
        payload = base64.b64encode(zlib.compress(raw, 9)).decode("ascii")
        return cls(len(after), len(first), payload, labels_sha256(after))

    def applied_to(self, labels: UInt16[np.ndarray, " m"]) -> UInt16[np.ndarray, " m"]:
        """The labels (m,) uint16 afterwards, a new array.

        Raises
        ------
        LabelError : labels of another mesh, a damaged payload, or a result that is not what was recorded.
        """
        self._check_size(len(labels))
        first, count, label = self._runs()
        faces = np.repeat(first - np.cumsum(count) + count, count) + np.arange(count.sum())
        after = labels.copy()
        after[faces] = np.repeat(label, count)
        found = labels_sha256(after)
        if found != self.sha256:
            raise LabelError(
                f"labels after a delta must have checksum {self.sha256[:12]}… but have {found[:12]}…; "
                "it is damaged, or was made for other labels"
            )
        return after

    def check_on_mesh(self, n_faces: int) -> None:
        """Raises LabelError for another number of faces or a damaged payload. Labels that it fits are not asked for."""
        self._check_size(n_faces)
        self._runs()

    def _check_size(self, n_faces: int) -> None:
        if n_faces != self.n_faces:
            raise LabelError(f"a label delta for {self.n_faces} faces must not be applied to {n_faces}; another mesh?")

    def _runs(self) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        n_bytes = _RUN_BYTES * self.n_runs
        decoder = zlib.decompressobj()
        try:
            raw = decoder.decompress(base64.b64decode(self.payload, validate=True), n_bytes + 1)
        except (ValueError, binascii.Error, zlib.error) as error:
            raise LabelError(f"a label delta must be base64 of zlib but: {error}; {_REMEDY}") from error
        if len(raw) != n_bytes or not (decoder.eof or n_bytes == 0):
            raise LabelError(f"a label delta must hold {self.n_runs} runs but does not; {_REMEDY}")
        first = np.frombuffer(raw, "<u4", self.n_runs).astype(np.int64)
        count = np.frombuffer(raw, "<u4", self.n_runs, 4 * self.n_runs).astype(np.int64)
        label = np.frombuffer(raw, "<u2", self.n_runs, 8 * self.n_runs).astype(np.uint16)
        ends = first + count
        if (count < 1).any() or (first[1:] < ends[:-1]).any() or ends.max(initial=0) > self.n_faces:
            raise LabelError(f"a label delta's runs must ascend within {self.n_faces} faces but do not; {_REMEDY}")
        return first, count, label
