"""Replay: operations applied to labels, one by one, with undo. Live editing and replaying a log are the same code.

An edit that changes no face is no step: it can be recorded, but undo passes it over and redo stays as it was. At most
`UNDO_LIMIT` steps can be taken back; undo and redo without a step change nothing. That is part of what a log means, so
every program must hold the same.
"""

from collections import deque
from collections.abc import Collection
from dataclasses import dataclass

import numpy as np
from jaxtyping import Int, Integer, UInt16

from partwise.errors import LabelError, PartwiseError
from partwise.labels.encoding import labels_sha256
from partwise.labels.operations import Assign, Clear, Delta, Edit, Operation, Paint, Redo, SegmentWide, Undo
from partwise.labels.schema import MAX_PART_ID
from partwise.labels.strokes import StrokeLog
from partwise.mesh import TriMesh
from partwise.segmentation.face_graph import check_face
from partwise.segmentation.paint import PaintSurface, painted_faces
from partwise.segmentation.region import region_of
from partwise.unlabelled import NO_PART_ID

UNDO_LIMIT = 200


@dataclass(frozen=True, slots=True, eq=False)
class Change:
    """Faces (r,) int64, ascending, whose label changed, with their labels before and after, (r,) uint16. Read-only."""

    faces: Int[np.ndarray, " r"]
    before: UInt16[np.ndarray, " r"]
    after: UInt16[np.ndarray, " r"]

    def __post_init__(self) -> None:
        for array in (self.faces, self.before, self.after):
            array.flags.writeable = False  # undo holds these very arrays

    @property
    def is_empty(self) -> bool:
        return len(self.faces) == 0

    def reversed(self) -> "Change":
        return Change(self.faces, self.after, self.before)


class Replay:
    """Labels of one shape under edit. What is refused leaves them, and undo, as they were.

    surface : of the mesh.
    base_labels : (m,) part ids, 0 = unlabelled; copied.
    part_ids : the parts that edits may give, 0 always among them; None for any.

    Raises
    ------
    LabelError : not one whole number per face, or labels that are no part ids.
    """

    def __init__(
        self,
        surface: PaintSurface,
        base_labels: Integer[np.ndarray, " m"],
        part_ids: Collection[int] | None = None,
    ) -> None:
        if base_labels.shape != (surface.n_faces,):
            raise LabelError(
                f"there must be one label per face but there are {base_labels.shape} labels for {surface.n_faces} "
                "faces; do they belong to another mesh?"
            )
        if not np.issubdtype(base_labels.dtype, np.integer):
            raise LabelError(f"labels must be whole numbers but are {base_labels.dtype}; give part ids")
        if base_labels.min() < NO_PART_ID or base_labels.max() > MAX_PART_ID:
            raise LabelError(
                f"labels must be 0 to {MAX_PART_ID} but span {base_labels.min()} to {base_labels.max()}; map them first"
            )
        self._surface = surface
        self._labels = base_labels.astype(np.uint16)
        self._part_ids: frozenset[int] | None = None
        if part_ids is not None:
            self.restrict_to(part_ids)
        self._done: deque[Change] = deque(maxlen=UNDO_LIMIT)
        self._undone: list[Change] = []

    @property
    def labels(self) -> UInt16[np.ndarray, " m"]:
        """The labels now, (m,) uint16: a read-only view that follows later operations; copy it to keep it."""
        view = self._labels.view()
        view.flags.writeable = False
        return view

    @property
    def can_undo(self) -> bool:
        return bool(self._done)

    @property
    def can_redo(self) -> bool:
        return bool(self._undone)

    def restrict_to(self, part_ids: Collection[int]) -> None:
        """From now on, edits may only give these parts, and 0. Undo and redo still bring back what was there."""
        self._part_ids = frozenset(part_ids) | {NO_PART_ID}

    def apply(self, operation: Operation) -> Change:
        """Does one operation and says what changed. Undo and redo cost what they change.

        Raises
        ------
        ParameterError : a face outside the mesh.
        LabelError : a part that may not be given, a delta that does not fit.
        """
        match operation:
            case Undo():
                return self._step_back()
            case Redo():
                return self._step_forward()
        change = self._change(operation)
        if not change.is_empty:
            self._labels[change.faces] = change.after
            self._done.append(change)
            self._undone.clear()
        return change

    def _step_back(self) -> Change:
        if not self._done:
            return self._nothing()
        change = self._done.pop()
        self._undone.append(change)
        self._labels[change.faces] = change.before
        return change.reversed()

    def _step_forward(self) -> Change:
        if not self._undone:
            return self._nothing()
        change = self._undone.pop()
        self._done.append(change)
        self._labels[change.faces] = change.after
        return change

    def _nothing(self) -> Change:
        none = self._labels[:0].copy()
        return Change(np.empty(0, dtype=np.int64), none, none)

    def _change(self, edit: Edit) -> Change:
        """What the edit would change; nothing is changed yet."""
        match edit:
            case Paint():
                self._check_part(edit.label)
                is_open = None if edit.only_over is None else self._labels == edit.only_over
                return self._relabelled(painted_faces(self._surface, edit.seeds, edit.brush, is_open), edit.label)
            case Assign():
                self._check_part(edit.label)
                check_face(edit.end - 1, self._surface.n_faces)
                return self._relabelled(edit.faces(), edit.label)
            case SegmentWide():
                self._check_part(edit.label)
                return self._relabelled(region_of(self._surface.graph, self._labels, edit.seed), edit.label)
            case Clear():
                return self._relabelled(np.arange(self._surface.n_faces), NO_PART_ID)
            case Delta():
                after = edit.delta.applied_to(self._labels)
                faces = np.flatnonzero(after != self._labels)
                for label in np.unique(after[faces]).tolist():
                    self._check_part(label)
                return Change(faces, self._labels[faces], after[faces])

    def _relabelled(self, faces: Int[np.ndarray, " r"], label: int) -> Change:
        faces = faces[self._labels[faces] != label]
        return Change(faces, self._labels[faces], np.full(len(faces), label, dtype=np.uint16))

    def _check_part(self, label: int) -> None:
        if self._part_ids is not None and label not in self._part_ids:
            known = ", ".join(map(str, sorted(self._part_ids - {NO_PART_ID}))) or "none"
            raise LabelError(
                f"a label must be a part of the schema but is {label}; its parts are {known} (0: unlabelled)"
            )


def replay(mesh: TriMesh, base_labels: Integer[np.ndarray, " m"], log: StrokeLog) -> UInt16[np.ndarray, " m"]:
    """The labels (m,) uint16 after all strokes of the log: the same on every machine. Raises as `replayed` does."""
    return replayed(PaintSurface.build(mesh), mesh, base_labels, log).labels.copy()


def replayed(surface: PaintSurface, mesh: TriMesh, base_labels: Integer[np.ndarray, " m"], log: StrokeLog) -> Replay:
    """The state after all strokes of the log, ready for more; `surface` is the mesh's.

    Raises
    ------
    LabelError : a log of another mesh or from other labels, or a stroke that cannot be done; the message says which.
    """
    if mesh.content_hash() != log.mesh_hash or mesh.n_faces != log.n_faces:
        raise LabelError(
            f"a stroke log must be replayed on its own mesh, {log.mesh_hash[:12]}… with {log.n_faces} faces, but this "
            f"is {mesh.content_hash()[:12]}… with {mesh.n_faces}; move the labels by map-back instead"
        )
    state = Replay(surface, base_labels)
    if labels_sha256(state.labels) != log.base_sha256:
        raise LabelError(
            f"a stroke log must start from labels with checksum {log.base_sha256[:12]}… but these have "
            f"{labels_sha256(state.labels)[:12]}…; fetch revision {log.base_revision}"
        )
    for stroke in log.strokes:
        try:
            state.apply(stroke.operation)
        except PartwiseError as error:
            raise LabelError(f"stroke {stroke.sequence} of the log cannot be replayed: {error}") from error
    return state
