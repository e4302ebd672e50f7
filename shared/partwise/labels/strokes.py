"""`Stroke`: one operation with who did it, when, and on what. `StrokeLog`: the strokes on one shape from one start.

A log is append-only. A stroke names its place in the log, so a stroke made on an older state is refused, and has an id
made by the client, so that sending it twice adds it once.
"""

from dataclasses import dataclass, replace
from datetime import datetime, timedelta
from uuid import UUID

import numpy as np
from jaxtyping import UInt16

from partwise.errors import ConflictError, LabelError, ParameterError
from partwise.labels.encoding import labels_sha256
from partwise.labels.operations import Operation

MAX_ROW_ID = 2**31 - 1
"""Of what a catalog numbers: strokes of a draft, revisions, people."""


@dataclass(frozen=True, slots=True)
class Stroke:
    """One operation as an event.

    id : made by the client once per stroke; the same id is the same stroke.
    sequence : how many strokes of the log come before it.
    base_revision : id of the label revision that the log starts from, None for a blank shape.
    author_id : the person.
    at : aware UTC.

    Raises
    ------
    ParameterError : a negative sequence, an author or revision below 1, a number larger than a catalog can hold, a time
        without zone or not in UTC.
    """

    id: UUID
    sequence: int
    base_revision: int | None
    author_id: int
    at: datetime
    operation: Operation

    def __post_init__(self) -> None:
        if not 0 <= self.sequence < MAX_ROW_ID:  # the number of strokes must fit, too
            raise ParameterError(
                f"a stroke's sequence must be 0 to {MAX_ROW_ID - 1} but is {self.sequence}; count from 0"
            )
        if not 1 <= self.author_id <= MAX_ROW_ID:
            raise ParameterError(f"a stroke's author must be a person's id, 1 to {MAX_ROW_ID}, but is {self.author_id}")
        if self.base_revision is not None and not 1 <= self.base_revision <= MAX_ROW_ID:
            raise ParameterError(f"a base revision must be 1 to {MAX_ROW_ID}, or nothing, but is {self.base_revision}")
        if self.at.utcoffset() != timedelta(0):
            raise ParameterError(
                f"a stroke's time must be in UTC with its zone but is {self.at.isoformat()}; convert it"
            )


@dataclass(frozen=True, slots=True)
class StrokeLog:
    """Strokes on one mesh, in order, from one start.

    mesh_hash : `TriMesh.content_hash` of the mesh.
    base_revision : id of the label revision that it starts from, None for a blank shape.
    base_sha256 : checksum of the labels that it starts from (`labels_sha256`).

    Raises
    ------
    LabelError : fewer than one face.
    ConflictError : strokes out of order, an id twice, a stroke from another base revision.
    """

    mesh_hash: str
    n_faces: int
    base_revision: int | None
    base_sha256: str
    strokes: tuple[Stroke, ...] = ()

    def __post_init__(self) -> None:
        if self.n_faces < 1:
            raise LabelError(f"a stroke log must be of a mesh with faces but has {self.n_faces}; whose log is it?")
        for place, stroke in enumerate(self.strokes):
            self._check_place(stroke, place)
        if len({stroke.id for stroke in self.strokes}) < len(self.strokes):
            raise ConflictError("each stroke of a log must have an id of its own but one occurs twice; drop the second")

    @classmethod
    def starting_from(
        cls, mesh_hash: str, base_labels: UInt16[np.ndarray, " m"], base_revision: int | None = None
    ) -> "StrokeLog":
        """An empty log over these labels."""
        return cls(mesh_hash, len(base_labels), base_revision, labels_sha256(base_labels))

    def with_stroke(self, stroke: Stroke) -> "StrokeLog":
        """This log and one more stroke; this log itself when it already has the very same stroke.

        Raises
        ------
        ConflictError : another stroke under the same id, a stroke for an earlier or later state of the log, or for
            another base revision.
        """
        for known in self.strokes:
            if known.id == stroke.id:
                if known != stroke:
                    raise ConflictError(
                        f"stroke {stroke.id} is in the log with other content; give each stroke its own id"
                    )
                return self
        self._check_place(stroke, len(self.strokes))
        return replace(self, strokes=(*self.strokes, stroke))

    def prefix(self, n_strokes: int) -> "StrokeLog":
        """The log as it was after its first strokes."""
        return replace(self, strokes=self.strokes[:n_strokes])

    def _check_place(self, stroke: Stroke, place: int) -> None:
        if stroke.sequence != place:
            raise ConflictError(
                f"the next stroke must have sequence {place} but has {stroke.sequence}; the shape was edited "
                "elsewhere: fetch the log and redo the stroke on it"
            )
        if stroke.base_revision != self.base_revision:
            raise ConflictError(
                f"a stroke must be based on revision {self.base_revision} but is on {stroke.base_revision}; "
                "the shape was confirmed meanwhile: start from its newest labels"
            )
