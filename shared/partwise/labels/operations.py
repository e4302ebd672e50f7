"""What an annotator can do to a shape's labels: one frozen dataclass per kind, and their union `Operation`.

Paint, assign, segment-wide and clear are recomputed wherever they are replayed. What a solver made is kept as a delta.
Undo and redo are operations too. Faces and part ids are checked here for what can be known without the mesh and the
schema, and by `check_on_mesh` for what the number of faces tells; `partwise.labels.replay` checks the rest.
"""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from enum import StrEnum

import numpy as np
from jaxtyping import Int

from partwise.errors import LabelError, ParameterError
from partwise.labels.face_runs import runs_of
from partwise.labels.label_delta import LabelDelta
from partwise.labels.schema import MAX_PART_ID
from partwise.segmentation.face_graph import check_face
from partwise.segmentation.paint import Brush

Scalar = str | int | float | bool | None


class DeltaSource(StrEnum):
    """Which solver made a delta."""

    PATCHES = "patches"
    BOUNDARY_REFINEMENT = "boundary_refinement"
    MODEL_REFINEMENT = "model_refinement"
    START_FROM = "start_from"


@dataclass(frozen=True, slots=True)
class Paint:
    """A click or a drag with the brush: the faces it takes get `label` (a part id, 0 = unlabelled).

    seeds : the faces under the pointer, in order; one for a click.
    only_over : the part id of the only faces that may be taken or crossed, 0 for the unlabelled; None for all.

    Raises
    ------
    ParameterError : no seeds, or a negative one.
    LabelError : a part id outside 0 … 65,535.
    """

    seeds: tuple[int, ...]
    brush: Brush
    label: int
    only_over: int | None = None

    def __post_init__(self) -> None:
        if not self.seeds:
            raise ParameterError("paint must have at least one seed face but has none; click a face of the mesh")
        _check_faces(min(self.seeds))
        _check_label(self.label)
        if self.only_over is not None:
            _check_label(self.only_over)


@dataclass(frozen=True, slots=True)
class Assign:
    """Given faces get `label`: a patch, or a selection.

    runs : (first face, count) of each run of consecutive faces, ascending, not overlapping.

    Raises
    ------
    ParameterError : no runs, a negative face, an empty run, runs that overlap or descend.
    LabelError : a part id outside 0 … 65,535.
    """

    runs: tuple[tuple[int, int], ...]
    label: int

    def __post_init__(self) -> None:
        if not self.runs:
            raise ParameterError("assign must name at least one face but names none; choose a patch")
        _check_faces(self.runs[0][0])
        end = 0
        for first, count in self.runs:
            if count < 1 or first < end:
                raise ParameterError(
                    f"runs of faces must ascend and hold at least one face but one is ({first}, {count}) after face "
                    f"{end - 1}; sort and merge them"
                )
            end = first + count
        _check_label(self.label)

    @classmethod
    def to_faces(cls, faces: Sequence[int] | Int[np.ndarray, " k"], label: int) -> "Assign":
        """From face ids in any order, repeats allowed. Raises as the class does."""
        first, count = runs_of(np.unique(np.asarray(faces, dtype=np.int64)))
        return cls(tuple(zip(first.tolist(), count.tolist(), strict=True)), label)

    @property
    def n_faces(self) -> int:
        """How many faces are named."""
        return sum(count for _, count in self.runs)

    @property
    def end(self) -> int:
        """One more than the largest face named."""
        first, count = self.runs[-1]
        return first + count

    def faces(self) -> Int[np.ndarray, " k"]:
        """The faces, ascending, (k,) int64. As large as the runs say: compare `end` with the mesh first."""
        return np.concatenate([np.arange(first, first + count) for first, count in self.runs])


@dataclass(frozen=True, slots=True)
class SegmentWide:
    """The connected region of equal label around `seed` gets `label`.

    Raises
    ------
    ParameterError : a negative seed.
    LabelError : a part id outside 0 … 65,535.
    """

    seed: int
    label: int

    def __post_init__(self) -> None:
        _check_faces(self.seed)
        _check_label(self.label)


@dataclass(frozen=True, slots=True)
class Delta:
    """What a solver made of the labels, as a difference; `parameters` say how, for people to read, sorted by name.

    Raises
    ------
    ParameterError : a name twice or out of order, or a value that JSON cannot hold.
    """

    source: DeltaSource
    delta: LabelDelta
    parameters: tuple[tuple[str, Scalar], ...] = ()

    def __post_init__(self) -> None:
        names = [name for name, _ in self.parameters]
        if names != sorted(set(names)):
            raise ParameterError(f"parameters must be sorted by name, each once, but are {names}; use Delta.of")
        for name, value in self.parameters:
            is_finite = not isinstance(value, float) or math.isfinite(value)
            if not (value is None or isinstance(value, str | int | float)) or not is_finite:
                raise ParameterError(
                    f"parameter {name} must be text, a finite number, a truth value or nothing but is {value!r}"
                )

    @classmethod
    def of(cls, source: DeltaSource, delta: LabelDelta, parameters: Mapping[str, Scalar] | None = None) -> "Delta":
        """From a mapping of parameters. Raises as the class does."""
        return cls(source, delta, tuple(sorted((parameters or {}).items())))


@dataclass(frozen=True, slots=True)
class Clear:
    """Every face becomes unlabelled."""


@dataclass(frozen=True, slots=True)
class Undo:
    """Takes back the last step that is not taken back, if there is one."""


@dataclass(frozen=True, slots=True)
class Redo:
    """Does again the step that was taken back last, if no step was done since."""


Edit = Paint | Assign | SegmentWide | Delta | Clear
"""What may change labels and then is one step for undo."""

Operation = Edit | Undo | Redo


def check_on_mesh(operation: Operation, n_faces: int) -> None:
    """What a log must not hold, as it could never be replayed: it is noticed without the mesh, by its number of faces.

    Raises
    ------
    ParameterError : a face outside the mesh.
    LabelError : a delta of another mesh, or a damaged one.
    """
    match operation:
        case Paint(seeds=seeds):
            check_face(max(seeds), n_faces)
        case Assign():
            check_face(operation.end - 1, n_faces)
        case SegmentWide(seed=seed):
            check_face(seed, n_faces)
        case Delta(delta=delta):
            delta.check_on_mesh(n_faces)


def _check_faces(least: int) -> None:
    if least < 0:
        raise ParameterError(f"a face must be 0 or more but is {least}; did the pointer miss the mesh?")


def _check_label(label: int) -> None:
    if not 0 <= label <= MAX_PART_ID:
        raise LabelError(f"a label must be a part id, 1 to {MAX_PART_ID}, or 0 for unlabelled but is {label}")
