"""What labelling a shape cost a person, from its stroke log: the paper's measures, strokes and time."""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from datetime import datetime
from itertools import pairwise

from partwise.errors import ParameterError
from partwise.labels.operations import Assign, Paint, Redo, SegmentWide, Undo
from partwise.labels.strokes import Stroke

IDLE_AFTER_S = 30.0


@dataclass(frozen=True, slots=True)
class AnnotationCost:
    """Effort on one shape. Work that was taken back again counts: it was done.

    strokes : gestures on the surface: paint (a drag is one), assign, segment-wide.
    commands : presses of a button that relabel: refinements, "start from", clear.
    undos, redos : steps back and forth.
    active_s : seconds between successive strokes, without the gaps longer than the idle threshold.
    n_idle_gaps : how many gaps were left out. With the threshold t, active_s + t·n_idle_gaps is the other usual
        reading, in which a person works on for t before leaving.
    """

    strokes: int
    commands: int
    undos: int
    redos: int
    active_s: float
    n_idle_gaps: int

    @property
    def clicks(self) -> int:
        """Every press: strokes, commands, undos and redos."""
        return self.strokes + self.commands + self.undos + self.redos

    @property
    def undo_share(self) -> float:
        """Undos per edit: above 1 only when steps were undone and redone repeatedly; 0 when nothing was done."""
        edits = self.strokes + self.commands
        return self.undos / edits if edits else 0.0

    def __add__(self, other: "AnnotationCost") -> "AnnotationCost":
        """Cost of both: of a shape's sessions, or of a collection."""
        return AnnotationCost(
            self.strokes + other.strokes,
            self.commands + other.commands,
            self.undos + other.undos,
            self.redos + other.redos,
            self.active_s + other.active_s,
            self.n_idle_gaps + other.n_idle_gaps,
        )


def annotation_cost(
    strokes: Sequence[Stroke], opened_at: datetime | None = None, idle_after_s: float = IDLE_AFTER_S
) -> AnnotationCost:
    """Cost of the strokes of one shape, in any order.

    `opened_at`, aware, is when the shape was shown: the look before the first stroke counts too unless it is idle. A
    gap of exactly the threshold counts. Where several people worked on the shape, each one's gaps are counted by
    themselves, and the shape's opening belongs to whoever came first.

    Raises
    ------
    ParameterError : a threshold that is not above 0 (infinity counts every gap), a time without zone.
    """
    if not idle_after_s > 0:
        raise ParameterError(f"idle_after_s must be above 0 seconds but is {idle_after_s}; use about 30")
    if opened_at is not None and opened_at.tzinfo is None:
        raise ParameterError(f"opened_at must have a zone but is {opened_at.isoformat()}; use UTC")
    gaps = _gaps_s(strokes, opened_at)
    kinds = [type(stroke.operation) for stroke in strokes]
    n_strokes = sum(kind in (Paint, Assign, SegmentWide) for kind in kinds)
    undos, redos = kinds.count(Undo), kinds.count(Redo)
    return AnnotationCost(
        strokes=n_strokes,
        commands=len(kinds) - n_strokes - undos - redos,
        undos=undos,
        redos=redos,
        active_s=math.fsum(gap for gap in gaps if gap <= idle_after_s),
        n_idle_gaps=sum(gap > idle_after_s for gap in gaps),
    )


def _gaps_s(strokes: Sequence[Stroke], opened_at: datetime | None) -> list[float]:
    """Seconds between each person's successive strokes, and from the opening to the first; never negative."""
    by_person: dict[int, list[datetime]] = {}
    for stroke in sorted(strokes, key=lambda stroke: stroke.at):
        by_person.setdefault(stroke.author_id, []).append(stroke.at)
    if opened_at is not None and by_person:
        first = next(iter(by_person.values()))
        first.insert(0, min(opened_at, first[0]))
    return [(later - earlier).total_seconds() for times in by_person.values() for earlier, later in pairwise(times)]
