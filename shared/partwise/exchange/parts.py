"""`PartTable`: the part schema as files carry it, so that labels mean something without their workspace."""

import re
from dataclasses import dataclass

import numpy as np
from jaxtyping import Int

from partwise.errors import LabelError, ParameterError
from partwise.labels.palette import rgb
from partwise.unlabelled import NO_CLASS

Rgb = tuple[int, int, int]
_COLOUR = re.compile(r"#[0-9a-f]{6}")


@dataclass(frozen=True, slots=True)
class PartEntry:
    """A part of the schema; colour as #rrggbb in lower case. Id −1 is no part: it marks unlabelled faces.

    gloss : what annotators are told about it. parent_id : the part that it is a part of; None at the top.
    """

    id: int
    name: str
    colour: str
    gloss: str = ""
    parent_id: int | None = None

    def __post_init__(self) -> None:
        if self.id < 0 or not self.name:
            raise ParameterError(f"a part must have an id ≥ 0 and a name but has {self.id} and {self.name!r}; fix both")
        if not _COLOUR.fullmatch(self.colour):
            raise ParameterError(
                f"a colour must be like #1f77b4 but part {self.name!r} has {self.colour!r}; rewrite it"
            )

    @property
    def rgb(self) -> Rgb:
        """Red, green and blue, 0 to 255."""
        return rgb(self.colour)


@dataclass(frozen=True, slots=True)
class PartTable:
    """The parts of one version of a schema, in the order people see them. May be empty.

    Raises
    ------
    ParameterError : a negative version, an id or a name twice, a parent that is missing or above itself.
    """

    version: int
    parts: tuple[PartEntry, ...]

    def __post_init__(self) -> None:
        if self.version < 0:
            raise ParameterError(f"a schema version must not be negative but is {self.version}; count from 1")
        ids = [part.id for part in self.parts]
        if len(set(ids)) < len(ids):
            raise ParameterError(f"part ids must be distinct but are {ids}; never reuse ids")
        names = [part.name for part in self.parts]
        if len(set(names)) < len(names):
            raise ParameterError(f"part names must be distinct but are {names}; rename parts")
        parent_of = {part.id: part.parent_id for part in self.parts}
        for part in self.parts:
            if part.parent_id is not None and part.parent_id not in parent_of:
                raise ParameterError(
                    f"the parent of {part.name!r} must be a part but {part.parent_id} is none of {ids}; add or drop it"
                )
            _check_ancestors(part, parent_of)

    @property
    def ids(self) -> tuple[int, ...]:
        return tuple(part.id for part in self.parts)

    @property
    def names(self) -> tuple[str, ...]:
        return tuple(part.name for part in self.parts)

    def colours(self) -> dict[int, Rgb]:
        """Id → RGB, 0 to 255."""
        return {part.id: part.rgb for part in self.parts}

    def check_labels(self, labels: Int[np.ndarray, " m"]) -> None:
        """Raises LabelError where a label is neither a part's id nor −1."""
        strangers = np.setdiff1d(labels, [NO_CLASS, *self.ids])
        if len(strangers):
            face = int(np.argmax(labels == strangers[0]))
            raise LabelError(
                f"labels must be −1 or a part's id but face {face} has {strangers[0]}; the ids are {list(self.ids)}"
            )


def _check_ancestors(part: PartEntry, parent_of: dict[int, int | None]) -> None:
    above, n_steps = part.parent_id, 0
    while above is not None:
        n_steps += 1
        if above == part.id or n_steps > len(parent_of):
            raise ParameterError(f"parts must form a tree but {part.name!r} is above itself; cut the circle")
        above = parent_of.get(above)
