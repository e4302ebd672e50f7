"""`Editor`: live editing of one shape, which keeps the log of what it does."""

from datetime import datetime
from uuid import UUID

import numpy as np
from jaxtyping import Integer, UInt16

from partwise.errors import ConflictError
from partwise.labels.operations import Operation
from partwise.labels.replay import Change, Replay, replayed
from partwise.labels.schema import PartSchema
from partwise.labels.strokes import Stroke, StrokeLog
from partwise.mesh import TriMesh
from partwise.segmentation.paint import PaintSurface


class Editor:
    """Labels under edit and the strokes so far. What is refused leaves both as they were.

    Raises
    ------
    LabelError : labels that do not fit the mesh.
    """

    def __init__(
        self,
        mesh: TriMesh,
        base_labels: Integer[np.ndarray, " m"],
        schema: PartSchema,
        base_revision: int | None = None,
    ) -> None:
        self.surface = PaintSurface.build(mesh)
        self._replay = Replay(self.surface, base_labels, schema.ids)
        self._empty_log = StrokeLog.starting_from(mesh.content_hash(), self._replay.labels, base_revision)
        self._strokes: list[Stroke] = []

    @classmethod
    def resumed(
        cls, mesh: TriMesh, base_labels: Integer[np.ndarray, " m"], schema: PartSchema, log: StrokeLog
    ) -> "Editor":
        """An editor as it was after the log's last stroke, undo and all; `base_labels` are those the log starts from.

        Past strokes may have used parts that the schema has lost; new ones may not.

        Raises
        ------
        LabelError : a log of another mesh or from other labels, or a stroke that cannot be done.
        """
        editor = cls(mesh, base_labels, schema, log.base_revision)
        editor._replay = replayed(editor.surface, mesh, base_labels, log)
        editor._replay.restrict_to(schema.ids)
        editor._strokes = list(log.strokes)
        return editor

    @property
    def labels(self) -> UInt16[np.ndarray, " m"]:
        """The labels now, (m,) uint16, a read-only view that follows later operations."""
        return self._replay.labels

    @property
    def can_undo(self) -> bool:
        return self._replay.can_undo

    @property
    def can_redo(self) -> bool:
        return self._replay.can_redo

    def perform(self, operation: Operation, *, stroke_id: UUID, author_id: int, at: datetime) -> Change:
        """Does the operation and, when it changes a face, records it: a stroke without effect is not kept.

        Raises
        ------
        ParameterError : a face outside the mesh, an author or time that is none.
        LabelError : a part that is not in the schema, a delta that does not fit.
        ConflictError : a stroke id that was used before.
        """
        if any(stroke.id == stroke_id for stroke in self._strokes):
            raise ConflictError(f"stroke {stroke_id} was already performed; give each stroke an id of its own")
        stroke = Stroke(
            stroke_id, len(self._strokes), self._empty_log.base_revision, author_id, at, operation
        )  # first: what it refuses must not have changed the labels
        change = self._replay.apply(operation)
        if not change.is_empty:
            self._strokes.append(stroke)
        return change

    def log(self) -> StrokeLog:
        """The log so far."""
        empty = self._empty_log
        return StrokeLog(empty.mesh_hash, empty.n_faces, empty.base_revision, empty.base_sha256, tuple(self._strokes))
