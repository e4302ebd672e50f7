"""`BlockKind`: what the blocks of a stage hold, declared once and checked on every write."""

from dataclasses import dataclass
from enum import StrEnum

import numpy as np

from partwise.errors import ParameterError


class Domain(StrEnum):
    """What the rows of a quantity are: one per face, one per vertex, or a single one for the shape.

    Levels are further meshes of the shape, one after the other; there may be none.
    """

    FACE = "face"
    VERTEX = "vertex"
    SHAPE = "shape"
    LEVEL_FACE = "level_face"
    LEVEL_VERTEX = "level_vertex"

    @property
    def may_be_empty(self) -> bool:
        """Whether a shape may have no rows."""
        return self in (Domain.LEVEL_FACE, Domain.LEVEL_VERTEX)


@dataclass(frozen=True, slots=True)
class Quantity:
    """One array of a block: for each shape (rows, *width) of `dtype`; a None in `width` is settled when written.

    For a shape-domain quantity each shape hands in and gets back its one row, of shape `width`.

    Raises
    ------
    ParameterError : a dtype numpy does not know, a width below 1.
    """

    name: str
    domain: Domain
    dtype: str
    width: tuple[int | None, ...] = ()

    def __post_init__(self) -> None:
        try:
            np.dtype(self.dtype)
        except TypeError as error:
            raise ParameterError(f"quantity {self.name!r} must have a numpy dtype but has {self.dtype!r}") from error
        if any(extent is not None and extent < 1 for extent in self.width):
            raise ParameterError(f"quantity {self.name!r} must have positive widths but has {self.width}")


@dataclass(frozen=True, slots=True)
class BlockKind:
    """What the blocks of a stage hold. Raises `ParameterError` for no quantities or a name twice."""

    name: str
    quantities: tuple[Quantity, ...]

    def __post_init__(self) -> None:
        names = [quantity.name for quantity in self.quantities]
        if not names or len(set(names)) != len(names):
            raise ParameterError(f"block kind {self.name!r} must have quantities of different names but has {names}")
