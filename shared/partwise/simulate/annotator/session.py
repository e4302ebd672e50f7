"""`annotate`: one simulated person labels one shape until enough of it is right.

The person weighs up what could be done next, takes what promises most area a second (not quite exactly), looks at the
result, and takes it back where it made things worse.
"""

from collections.abc import Callable, Collection, Sequence
from dataclasses import dataclass, field, replace
from datetime import UTC, datetime, timedelta
from uuid import UUID

import numpy as np
from jaxtyping import Int, Integer, UInt16

from partwise.errors import LabelError, ParameterError
from partwise.labels.annotation_cost import IDLE_AFTER_S, AnnotationCost, annotation_cost
from partwise.labels.editor import Editor
from partwise.labels.label_delta import LabelDelta
from partwise.labels.operations import Assign, Delta, DeltaSource, Edit, Operation, Paint, SegmentWide, Undo
from partwise.labels.schema import PartSchema
from partwise.labels.strokes import StrokeLog
from partwise.mesh import TriMesh
from partwise.simulate.annotator.motor import Gesture, Hand, MotorModel, Tool, command_s, undo_s
from partwise.simulate.annotator.moves import Move, Outlook, paint_moves, patch_moves, segment_moves
from partwise.simulate.annotator.sight import Sight
from partwise.unlabelled import NO_CLASS, NO_PART_ID

OPENED_AT = datetime(2026, 1, 1, 9, tzinfo=UTC)
AUTHOR_ID = 1
REFINE_BELOW = 0.02
"""While a stroke can gain more than this share of the area, a person goes on with strokes rather than refine."""
STROKES_BEFORE_REFINING = 2
"""At first; doubled whenever refinement made things worse."""
Refine = Callable[[Int[np.ndarray, " m"]], Int[np.ndarray, " m"]]
"""Boundary refinement as `BoundaryRefiner.refine` does it: −1 where unlabelled."""


@dataclass(frozen=True, slots=True, eq=False)
class Equipment:
    """What the annotator works with.

    tools : which may be used; boundary refinement when `refine` is there. patches : of each position of the slider,
    fewest first, (m,) int64. target : share of the area to be right, in (0, 1]. max_strokes : then the person gives up.
    choice_spread : ≥ 0, of the logarithm of how a move's worth is judged.

    Raises
    ------
    ParameterError : no tool that makes strokes, patches without their tool or the other way round, or a value out of
        its range.
    """

    tools: Collection[Tool]
    patches: Sequence[Int[np.ndarray, " m"]] = ()
    refine: Refine | None = None
    target: float = 0.97
    max_strokes: int = 400
    motor: MotorModel = field(default_factory=MotorModel)
    choice_spread: float = 0.2

    def __post_init__(self) -> None:
        if not set(self.tools) - {Tool.BOUNDARY_REFINEMENT}:
            raise ParameterError("an annotator needs a tool that makes strokes but has none; give paint")
        for tool, is_there in ((Tool.PATCHES, self.patches), (Tool.BOUNDARY_REFINEMENT, self.refine)):
            if (tool in self.tools) != bool(is_there):
                raise ParameterError(
                    f"{tool.value} must come with what makes them but only one of the two is there; give both or none"
                )
        if not 0 < self.target <= 1:
            raise ParameterError(f"target must be in (0, 1] but is {self.target}; 0.95 is usual")
        if self.max_strokes < 1 or not 0 <= self.choice_spread < np.inf:
            raise ParameterError(
                f"max_strokes must be 1 or more and choice_spread ≥ 0 but are {self.max_strokes} and "
                f"{self.choice_spread}; leave them out"
            )


@dataclass(frozen=True, slots=True, eq=False)
class Annotation:
    """What a simulated person left.

    log : the strokes. labels : (m,) uint16 after them. right : share of the area that is right after each stroke.
    begun_with : that share of the labels begun with. opened_at : when the shape was shown.
    """

    log: StrokeLog
    labels: UInt16[np.ndarray, " m"]
    right: tuple[float, ...]
    begun_with: float
    opened_at: datetime = OPENED_AT

    def n_strokes_to(self, target: float) -> int | None:
        """How many events of the log it took to get so much right; None if it was not reached."""
        reached = (n for n, right in enumerate((0.0, *self.right)) if right >= target)
        return next(reached, None)

    def cost(self, target: float | None = None) -> AnnotationCost:
        """Of the whole log, or of it up to where so much was right; of all of it where that was not reached."""
        n = len(self.log.strokes) if target is None else self.n_strokes_to(target)
        strokes = self.log.strokes if n is None else self.log.strokes[:n]
        return annotation_cost(strokes, opened_at=self.opened_at)


def annotate(
    mesh: TriMesh,
    sight: Sight,
    schema: PartSchema,
    equipment: Equipment,
    rng: np.random.Generator,
    start: Integer[np.ndarray, " m"] | None = None,
) -> Annotation:
    """The log of a simulated person who labels a shape from blank, or from given labels.

    Parameters
    ----------
    sight : of this mesh; what belongs on it must be parts of the schema.
    start : (m,) part ids, 0 = unlabelled: what "start from" gives at the first press; blank without.
    rng : the same state gives the same log.

    Raises
    ------
    LabelError : sight or start of another mesh, or parts that are not in the schema.
    """
    if sight.n_faces != mesh.n_faces:
        raise LabelError(f"sight must be of the mesh's {mesh.n_faces} faces but is of {sight.n_faces}; another mesh's?")
    session = _Session(mesh, sight, schema, equipment, rng)
    if start is not None:
        session.start_from(start)
    session.work()
    return Annotation(session.editor.log(), session.editor.labels.copy(), tuple(session.right), session.begun_with)


class _Session:
    """One person at one shape: the editor, the clock, the hand, and how refinement fared so far."""

    def __init__(
        self, mesh: TriMesh, sight: Sight, schema: PartSchema, equipment: Equipment, rng: np.random.Generator
    ) -> None:
        self.editor = Editor(mesh, np.zeros(mesh.n_faces, dtype=np.uint16), schema)
        self.right: list[float] = []
        self.begun_with = sight.right_share(self.editor.labels)
        self._sight, self._equipment, self._rng = sight, equipment, rng
        self._now = OPENED_AT + timedelta(seconds=equipment.motor.orient_s)
        self._hand = Hand(pointer=np.zeros(3), view=np.array([0.0, 0.0, 1.0]))
        self._level = min(1, len(equipment.patches) - 1)
        self._since_refining, self._patience = 0, STROKES_BEFORE_REFINING
        self._n_tried = 0

    @property
    def _right_now(self) -> float:
        return self.right[-1] if self.right else self.begun_with

    def start_from(self, labels: Integer[np.ndarray, " m"]) -> None:
        """Presses "start from": a command, and the labels are there."""
        self._since_refining = STROKES_BEFORE_REFINING  # ragged boundaries are seen at once
        after = np.asarray(labels).astype(np.uint16)
        delta = LabelDelta.between(self.editor.labels, after)
        self.begun_with = self._sight.right_share(after)
        self._perform(Delta.of(DeltaSource.START_FROM, delta), command_s(self._equipment.motor))

    def work(self) -> None:
        """Until the target is reached, nothing promises anything, or patience ends."""
        while self._right_now < self._equipment.target and self._n_tried < self._equipment.max_strokes:
            moves = self._moves()
            if self._equipment.refine is not None and self._wants_to_refine(moves):
                self._refine(self._equipment.refine)
            elif moves:
                self._stroke(self._chosen(moves))
            else:
                return

    def _moves(self) -> list[Move]:
        equipment = self._equipment
        outlook = Outlook(self._sight, self.editor.labels, self._hand, equipment.motor, equipment.patches, self._level)
        moves: list[Move] = []
        for tool, thought_of in (
            (Tool.SEGMENT_WIDE, segment_moves),
            (Tool.PATCHES, patch_moves),
            (Tool.PAINT, paint_moves),
        ):
            if tool in equipment.tools:
                moves += thought_of(outlook)
        return [move for move in moves if move.gain > 0]

    def _chosen(self, moves: list[Move]) -> Move:
        worth = [move.gain / self._hand.seconds(move.gesture, self._equipment.motor) for move in moves]
        judged = np.log(worth) + self._equipment.choice_spread * self._rng.standard_normal(len(moves))
        return moves[int(np.argmax(judged))]

    def _stroke(self, move: Move) -> None:
        before = self._right_now
        operation = self._as_it_lands(move)
        self._n_tried += 1
        self._since_refining += 1
        self._perform(operation, self._hand.seconds(move.gesture, self._equipment.motor))
        self._hand, self._level = self._hand.after(move.gesture), move.level
        if self._right_now < before:
            self._perform(Undo(), undo_s(self._equipment.motor))

    def _as_it_lands(self, move: Move) -> Edit:
        """The operation where the hand truly comes down: near what it aims at."""
        operation, gesture = move.operation, move.gesture
        if isinstance(operation, Paint):
            seeds = tuple(self._landing(self._sight.points[seed], gesture) for seed in operation.seeds)
            return replace(operation, seeds=seeds)
        landed = self._landing(gesture.place, gesture)
        if isinstance(operation, SegmentWide):
            return SegmentWide(landed, operation.label)
        patches = self._equipment.patches[move.level]
        if np.isin(landed, operation.faces()):
            return operation
        return Assign.to_faces(np.flatnonzero(patches == patches[landed]), operation.label)

    def _landing(self, point: np.ndarray, gesture: Gesture) -> int:
        miss = self._equipment.motor.aim * gesture.width * self._rng.standard_normal(3)
        return self._sight.face_at(point + miss, self._hand.turned_to(gesture.normal).view)

    def _wants_to_refine(self, moves: Sequence[Move]) -> bool:
        labels = self.editor.labels
        if self._since_refining < self._patience or not labels.any():
            return False
        return self._sight.is_ready_to_fill(labels) or max((move.gain for move in moves), default=0.0) < REFINE_BELOW

    def _refine(self, refine: Refine) -> None:
        """Presses the button, looks, and takes it back unless more is right."""
        self._since_refining = 0
        labels, before = self.editor.labels.copy(), self._right_now
        classes = np.where(labels == NO_PART_ID, NO_CLASS, labels.astype(np.int64))
        refined = refine(classes).astype(np.uint16)
        self._perform(
            Delta.of(DeltaSource.BOUNDARY_REFINEMENT, LabelDelta.between(labels, refined)),
            command_s(self._equipment.motor),
        )
        if self._right_now > before:
            self._patience = STROKES_BEFORE_REFINING
            return
        self._patience *= 2
        if self._right_now < before:
            self._perform(Undo(), undo_s(self._equipment.motor))

    def _perform(self, operation: Operation, seconds: float) -> None:
        spread = self._equipment.motor.spread
        taken = seconds * np.exp(spread * self._rng.standard_normal() - spread**2 / 2)
        self._now += timedelta(seconds=float(min(taken, IDLE_AFTER_S)))
        stroke_id = UUID(bytes=self._rng.bytes(16), version=4)
        change = self.editor.perform(operation, stroke_id=stroke_id, author_id=AUTHOR_ID, at=self._now)
        if not change.is_empty:  # what changes nothing is not in the log
            self.right.append(self._sight.right_share(self.editor.labels))
