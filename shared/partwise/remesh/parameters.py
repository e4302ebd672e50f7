"""Parameters of remeshing. They load nothing heavy, so that a configuration can be read anywhere."""

import math
from dataclasses import dataclass
from typing import TypeAlias

from partwise.errors import ParameterError

# Chosen by the experiment in docs/remeshing.md; `partwise.remesh.calibration` repeats it.
CALIBRATED_DISTANCE = 0.25


@dataclass(frozen=True, slots=True)
class AlphaWrap:
    """One attempt at shrink-wrapping the shape; both in per cent of the bounding box's diagonal.

    alpha_percent : the finest gap or hole that the wrap enters; a coarser one is used where the levels need no more.
    offset_percent : how far the wrap stays off the shape; a sheet becomes twice as thick as this.

    Raises
    ------
    ParameterError : a percentage outside (0, 50].
    """

    alpha_percent: float
    offset_percent: float

    def __post_init__(self) -> None:
        for name in ("alpha_percent", "offset_percent"):
            if not 0 < getattr(self, name) <= 50:
                raise ParameterError(
                    f"{name} must be in (0, 50] but is {getattr(self, name)}; between 0.1 and 2 is usual"
                )


@dataclass(frozen=True, slots=True)
class ImplicitContour:
    """One attempt at contouring the distance to the shape on a grid.

    n_cells : cells along the longest side of the bounding box.
    offset_cells : distance of the contour from the shape, in cells.

    Raises
    ------
    ParameterError : n_cells outside 16 to 512, or offset_cells outside [0.5, 4].
    """

    n_cells: int
    offset_cells: float = 1.0

    def __post_init__(self) -> None:
        if not 16 <= self.n_cells <= 512:
            raise ParameterError(f"n_cells must be 16 to 512 but is {self.n_cells}; 128 is usual")
        # Below half a cell a sheet may pass between grid points and tear.
        if not 0.5 <= self.offset_cells <= 4:
            raise ParameterError(f"offset_cells must be in [0.5, 4] but is {self.offset_cells}; 1 is usual")


AttemptParameters: TypeAlias = AlphaWrap | ImplicitContour


@dataclass(frozen=True, slots=True)
class RemeshParameters:
    """The ladder: what is tried in order, what is accepted, and the face counts that are made of it.

    wraps, contours : attempts; all wraps come before all contours.
    levels : face counts, descending.
    level_tolerance : how far a level may be off its face count, as a share.
    max_faces_as_is : a clean mesh with at most this many faces is used as it is.
    faces_over_finest : a wrap aims at this many times the finest level's faces,
    min_wrap_faces : and at no fewer than this, because detail survives decimation better than coarse wrapping.
    max_distance : greatest light-field distance to the original that is accepted, see docs/remeshing.md.
    max_dropped_area : greatest share of the outer surface that may be lost with loose pieces.

    Raises
    ------
    ParameterError : no attempts, levels that do not descend or below 100, or a number out of range.
    """

    wraps: tuple[AlphaWrap, ...] = (
        AlphaWrap(0.15, 0.1),
        AlphaWrap(0.15, 0.4),  # a thicker skin joins pieces that do not quite touch, at full detail
        AlphaWrap(1.6, 0.5),  # wider gaps, closed by alpha: truer than a thicker skin, though of fewer faces
        AlphaWrap(0.15, 1.0),
    )
    contours: tuple[ImplicitContour, ...] = (ImplicitContour(128), ImplicitContour(64))
    levels: tuple[int, ...] = (50_000, 20_000, 10_000, 5_000)
    level_tolerance: float = 0.05
    max_faces_as_is: int = 50_000
    faces_over_finest: float = 1.25
    min_wrap_faces: int = 15_000
    max_distance: float = CALIBRATED_DISTANCE
    max_dropped_area: float = 0.01

    def __post_init__(self) -> None:
        if not self.attempts:
            raise ParameterError("a ladder needs an attempt but wraps and contours are both empty; add one")
        if not self.levels or min(self.levels) < 100:
            raise ParameterError(f"levels must be face counts of 100 or more but are {self.levels}; 10000 is usual")
        if any(coarse >= fine for fine, coarse in zip(self.levels, self.levels[1:], strict=False)):
            raise ParameterError(f"levels must descend but are {self.levels}; sort them and drop repetitions")
        for name, low, high in (
            ("level_tolerance", 0.0, 0.5),
            ("max_faces_as_is", 4, math.inf),
            ("faces_over_finest", 1.0, 10.0),
            ("min_wrap_faces", 100, math.inf),
            ("max_distance", 0.0, math.sqrt(2.0)),
            ("max_dropped_area", 0.0, 1.0),
        ):
            if not low <= getattr(self, name) <= high:
                raise ParameterError(f"{name} must be in [{low:g}, {high:g}] but is {getattr(self, name)}; correct it")

    @property
    def attempts(self) -> tuple[AttemptParameters, ...]:
        """What is tried, in order."""
        return (*self.wraps, *self.contours)

    @property
    def n_wrap_faces(self) -> int:
        """How many faces a wrap should have so that the finest level can be made of it."""
        return max(int(self.levels[0] * self.faces_over_finest), self.min_wrap_faces)
