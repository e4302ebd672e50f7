"""A stroke log folded into the labels of a revision."""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Integer, UInt16

from partwise.errors import ConflictError
from partwise.labels.checks import checked_labels
from partwise.labels.encoding import labels_sha256
from partwise.labels.replay import replay
from partwise.labels.schema import PartSchema
from partwise.labels.strokes import StrokeLog
from partwise.mesh import TriMesh


@dataclass(frozen=True, slots=True, eq=False)
class FoldedLog:
    """Labels (m,) uint16 with their checksum, and what a revision of them must name."""

    labels: UInt16[np.ndarray, " m"]
    sha256: str
    mesh_hash: str
    parent_revision: int | None
    schema_version: int
    n_strokes: int


def fold(
    log: StrokeLog,
    mesh: TriMesh,
    base_labels: Integer[np.ndarray, " m"],
    schema: PartSchema,
    expected_sha256: str | None = None,
) -> FoldedLog:
    """The labels that the log leaves, replayed and checked for a revision under `schema`: see `checked_fold`.

    Raises
    ------
    LabelError : a log of another mesh or from other labels, a stroke that cannot be done, a part not in the schema.
    ConflictError : the labels are not the expected ones.
    """
    return checked_fold(log, replay(mesh, base_labels, log), schema, expected_sha256)


def checked_fold(
    log: StrokeLog, replayed: UInt16[np.ndarray, " m"], schema: PartSchema, expected_sha256: str | None = None
) -> FoldedLog:
    """Labels that replaying the log has left, checked for a revision under `schema`.

    `expected_sha256` is what the annotator saw: a client that painted otherwise is noticed before its work is
    committed. A part that strokes used but that no face has in the end may be missing from the schema.

    Raises
    ------
    LabelError : not one label for each face of the log, a part not in the schema.
    ConflictError : the labels are not the expected ones.
    """
    labels = checked_labels(replayed, log.n_faces, schema)
    sha256 = labels_sha256(labels)
    if expected_sha256 is not None and sha256 != expected_sha256:
        raise ConflictError(
            f"labels must be as the annotator saw them, checksum {expected_sha256[:12]}…, but replay gives "
            f"{sha256[:12]}…; reload the shape"
        )
    return FoldedLog(labels, sha256, log.mesh_hash, log.base_revision, schema.version, len(log.strokes))
