"""`Part` and `PartSchema`: which parts the faces of a collection may be labelled with.

Part ids are never reused: 0 means unlabelled, and a part that was removed keeps its id for ever. A schema has a
version; adding or removing a part makes the next version, renaming and recolouring do not.
"""

import re
from dataclasses import dataclass
from difflib import get_close_matches

from partwise.errors import LabelError

MAX_PART_ID = 65_535  # labels are uint16
_MAX_NAME = 64
_COLOUR = re.compile(r"#[0-9A-Fa-f]{6}")


@dataclass(frozen=True, slots=True)
class Part:
    """One part: id in 1 … 65,535, name (1–64 printable characters), colour `#RRGGBB`, and a gloss for annotators.

    parent_id : the part that it is a part of, None at the top.

    Raises
    ------
    LabelError : an id out of range, a name that is empty, too long or padded, a malformed colour.
    """

    id: int
    name: str
    colour: str
    gloss: str = ""
    parent_id: int | None = None

    def __post_init__(self) -> None:
        if not 1 <= self.id <= MAX_PART_ID:
            raise LabelError(f"a part id must be 1 to {MAX_PART_ID} (0 means unlabelled) but is {self.id}")
        check_part_name(self.name)
        if not _COLOUR.fullmatch(self.colour):
            raise LabelError(f"a part's colour must look like #E69F00 but part {self.name!r} has {self.colour!r}")


def check_part_name(name: str) -> None:
    """Refuse a part name that could not be told apart, typed or written to a file.

    Raises
    ------
    LabelError : empty, padded, longer than 64 characters, unprintable, or holding a comma.
    """
    if not name or name != name.strip():
        raise LabelError(f"a part name must be non-empty without spaces around it but is {name!r}")
    if len(name) > _MAX_NAME or not name.isprintable() or "," in name:
        raise LabelError(f"a part name must be at most {_MAX_NAME} printable characters without commas but is {name!r}")


@dataclass(frozen=True, slots=True)
class PartSchema:
    """The parts of a collection under one version, in the order annotators see them. Version ≥ 1.

    Raises
    ------
    LabelError : version below 1, an id or a name twice, a parent that is not in it, a part that is its own ancestor.
    """

    version: int
    parts: tuple[Part, ...]

    def __post_init__(self) -> None:
        if self.version < 1:
            raise LabelError(f"a schema version must be at least 1 but is {self.version}")
        for what, values in (("name", list(self.names)), ("id", [str(part_id) for part_id in self.ids])):
            twice = sorted({value for value in values if values.count(value) > 1})
            if twice:
                raise LabelError(f"each part {what} must occur once but these occur twice: {', '.join(twice)}")
        for part in self.parts:
            self.ancestors(part.id)

    @property
    def ids(self) -> tuple[int, ...]:
        return tuple(part.id for part in self.parts)

    @property
    def names(self) -> tuple[str, ...]:
        return tuple(part.name for part in self.parts)

    def part(self, part_id: int) -> Part:
        """The part of this id.

        Raises
        ------
        LabelError : no part of this version has the id.
        """
        for part in self.parts:
            if part.id == part_id:
                return part
        known = ", ".join(f"{part.id} ({part.name})" for part in self.parts)
        raise LabelError(f"part id {part_id} is not in schema version {self.version}; it has {known or 'no parts'}")

    def ancestors(self, part_id: int) -> tuple[int, ...]:
        """Ids of the part's parent, its parent's parent and so on up to the top; empty for a part at the top.

        Raises
        ------
        LabelError : no part of this version has the id, or, when the schema is made, the parents go round in a circle.
        """
        above: list[int] = []
        parent_id = self.part(part_id).parent_id
        while parent_id is not None:
            if parent_id == part_id or parent_id in above:
                names = " → ".join(self.part(each).name for each in (part_id, *above, parent_id))
                raise LabelError(f"a part must not be its own ancestor but parents go {names}; take one of them off")
            above.append(parent_id)
            parent_id = self.part(parent_id).parent_id
        return tuple(above)

    def id_of(self, name: str) -> int:
        """The id of the part called `name`, exactly.

        Raises
        ------
        LabelError : no such part; the message names the nearest ones.
        """
        for part in self.parts:
            if part.name == name:
                return part.id
        by_lower = {known.lower(): known for known in self.names}
        near = [by_lower[match] for match in get_close_matches(name.lower(), by_lower, n=3)]
        remedy = f"did you mean {' or '.join(near)}?" if near else f"the parts are: {', '.join(self.names) or 'none'}"
        raise LabelError(f"part {name!r} is not in schema version {self.version}; {remedy}")
