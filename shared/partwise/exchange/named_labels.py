"""Labels under the names a file gives them, and their way to the part ids of a schema."""

import difflib
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from jaxtyping import Int

from partwise.errors import LabelError
from partwise.unlabelled import NO_CLASS


@dataclass(frozen=True, slots=True, eq=False)
class NamedLabels:
    """A part name for each face.

    part_names : distinct names in the file's order; a name may have no faces.
    indices : (m,) int64 into `part_names`; −1 = unlabelled. Copied and made read-only.

    Raises
    ------
    LabelError : a name is empty or comes up twice, indices are not (m,) whole numbers, or one is out of range.
    """

    part_names: tuple[str, ...]
    indices: Int[np.ndarray, " m"]

    def __post_init__(self) -> None:
        if any(not name.strip() for name in self.part_names):
            raise LabelError(f"part names must not be empty but are {self.part_names}; name every part")
        if len(set(self.part_names)) < len(self.part_names):
            raise LabelError(f"part names must be distinct but are {self.part_names}; merge or rename parts")
        if self.indices.ndim != 1 or self.indices.dtype.kind not in "iu":
            raise LabelError(
                f"labels must be (m,) whole numbers but are {self.indices.shape} {self.indices.dtype}; one a face"
            )
        indices = self.indices.astype(np.int64)
        if len(indices) and (int(indices.min()) < NO_CLASS or int(indices.max()) >= len(self.part_names)):
            bad = int(indices.min()) if int(indices.min()) < NO_CLASS else int(indices.max())
            raise LabelError(f"labels must be −1 or name one of {len(self.part_names)} parts but one is {bad}")
        indices.flags.writeable = False
        object.__setattr__(self, "indices", indices)


def to_part_ids(labels: NamedLabels, part_ids: Mapping[str, int], source: str) -> Int[np.ndarray, " m"]:
    """The schema's part id of each face, (m,) int64; −1 stays −1.

    Parameters
    ----------
    part_ids : name → id of the schema; names must match exactly.
    source : what the labels were read from, for the error.

    Raises
    ------
    LabelError : a part name is not in the schema; says which, where, and what it may have meant.
    """
    for name in labels.part_names:
        if name not in part_ids:
            raise LabelError(
                f"{source}: part {name!r} must be in the schema {sorted(part_ids)}; {_advice(name, part_ids)}"
            )
    id_of_index = np.array([*(part_ids[name] for name in labels.part_names), NO_CLASS], dtype=np.int64)
    return id_of_index[labels.indices]  # −1 picks the last, which is −1


def _advice(name: str, part_ids: Mapping[str, int]) -> str:
    by_folded = {known.casefold(): known for known in part_ids}
    near = [by_folded[folded] for folded in difflib.get_close_matches(name.casefold(), by_folded, n=3, cutoff=0.6)]
    if near:
        return f"did you mean {' or '.join(map(repr, near))}?"
    return "add the part or rename it in the file"
