"""`CodedGrids`, the quantised histograms of faces, and `FacePool`, the labelled faces a training draws from.

Histograms stay uint8 until a batch is made of them, which keeps a pool at a quarter of its float32 size.
"""

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float32, Int64, UInt8, UInt16

from partwise.errors import LabelError, NotEnoughDataError, ParameterError
from partwise.unlabelled import NO_CLASS

GRID_SIZE = 16
GRID_BINS = GRID_SIZE * GRID_SIZE


@dataclass(frozen=True, slots=True, eq=False)
class CodedGrids:
    """One 16×16 histogram per face as codes of its square root: sqrt(h) ≈ codes · scale[:, None].

    codes : (n, 256) uint8, row-major 16×16.
    scale : (n,) float32, or one number for all faces of a shape, which is repeated. Positive or 0, finite.

    Raises
    ------
    ParameterError : wrong dtype or shape, or a scale that is negative or not finite.
    """

    codes: UInt8[np.ndarray, "n 256"]
    scale: Float32[np.ndarray, " n"]

    def __post_init__(self) -> None:
        if self.codes.dtype != np.uint8 or self.codes.ndim != 2 or self.codes.shape[1] != GRID_BINS:
            raise ParameterError(
                f"codes must be (n, {GRID_BINS}) uint8 but are {self.codes.shape} {self.codes.dtype}; "
                "quantise and flatten the histograms first"
            )
        scale = np.asarray(self.scale, dtype=np.float32)
        if scale.shape not in ((), (len(self.codes),)):
            raise ParameterError(
                f"scale must be one number or one per face ({len(self.codes)}) but has shape {scale.shape}; "
                "were faces dropped?"
            )
        if not np.isfinite(scale).all() or (scale < 0).any():
            raise ParameterError(
                f"scale must be finite and at least 0 but its least is {scale.min()}; describe it again"
            )
        object.__setattr__(self, "scale", np.ascontiguousarray(np.broadcast_to(scale, len(self.codes))))

    def __len__(self) -> int:
        return len(self.codes)

    def take(self, rows: np.ndarray) -> "CodedGrids":
        """The given faces, by index or mask."""
        return CodedGrids(self.codes[rows], self.scale[rows])


@dataclass(frozen=True, slots=True, eq=False)
class LabelledFaces:
    """Faces of one shape with their class.

    grids : branch name to histograms, all of n faces.
    classes : (n,) int64, index of the part in the pool's `part_ids`; −1 is unlabelled.

    Raises
    ------
    LabelError : the number of labels is not the number of faces.
    """

    grids: Mapping[str, CodedGrids]
    classes: Int64[np.ndarray, " n"]

    def __post_init__(self) -> None:
        for branch, grids in self.grids.items():
            if self.classes.shape != (len(grids),):
                raise LabelError(
                    f"there must be one label a face but {branch} has {len(grids)} faces and labels have shape "
                    f"{self.classes.shape}; do they belong to the same mesh?"
                )


@dataclass(frozen=True, slots=True, eq=False)
class FacePool:
    """Labelled faces, of any number of shapes, that batches are drawn from.

    grids : branch name to histograms, all of n faces.
    classes : (n,) int64 in 0 … len(part_ids) − 1.
    part_ids : the part that each class stands for.

    Raises
    ------
    LabelError : lengths disagree, a class has no part, or part ids repeat.
    NotEnoughDataError : there is no labelled face.
    """

    grids: Mapping[str, CodedGrids]
    classes: Int64[np.ndarray, " n"]
    part_ids: tuple[int, ...]

    def __post_init__(self) -> None:
        if len(set(self.part_ids)) != len(self.part_ids):
            raise LabelError(f"part ids must differ but are {self.part_ids}; is a part listed twice?")
        if self.classes.ndim != 1 or len(self.classes) == 0:
            raise NotEnoughDataError(
                "training needs at least one labelled face but there is none; confirm some shapes first"
            )
        if any(len(grids) != len(self.classes) for grids in self.grids.values()):
            raise LabelError(f"every branch must have {len(self.classes)} faces, one a label; were faces dropped?")
        _require_classes(self.classes, len(self.part_ids), lowest=0)

    def __len__(self) -> int:
        return len(self.classes)

    @classmethod
    def from_shapes(
        cls, shapes: Iterable[LabelledFaces], part_ids: tuple[int, ...], capacity: int, rng: np.random.Generator
    ) -> "FacePool":
        """At most `capacity` labelled faces, a uniform sample without replacement of those of all shapes.

        Shapes are read one after the other and memory is that of `capacity` faces and one shape (for the paper's
        recipe, T · batch = 2.56 million faces or 1.4 GB at most), however large the collection.

        With `capacity` = T · batch (`Recipe.n_draws`) training is the same as on all faces: it visits faces in passes
        over a random permutation, and the first k entries of a random permutation of n items are distributed as a
        random permutation of a uniform k-subset.

        Parameters
        ----------
        shapes : unlabelled faces (class −1) are left out.
        part_ids : the part that each class stands for.
        capacity : at least 1.
        rng : chooses the faces kept when there are more than `capacity`.

        Raises
        ------
        ParameterError : capacity is below 1.
        LabelError : a class has no part, or shapes have different branches.
        NotEnoughDataError : no face is labelled.
        """
        if capacity < 1:
            raise ParameterError(f"capacity must be at least 1 but is {capacity}; pass the recipe's n_draws")
        reservoir = _Reservoir(capacity)
        for shape in shapes:
            _require_classes(shape.classes, len(part_ids), lowest=NO_CLASS)
            reservoir.offer(_labelled_columns(shape), rng)
        columns = reservoir.columns()
        if not columns:
            raise NotEnoughDataError(
                "training needs at least one labelled face but there is none; confirm some shapes first"
            )
        classes = columns.pop("classes")
        branches = sorted({name.partition("/")[0] for name in columns})
        grids = {branch: CodedGrids(columns[f"{branch}/codes"], columns[f"{branch}/scale"]) for branch in branches}
        return cls(grids, classes, part_ids)


def classes_of(labels: UInt16[np.ndarray, " n"], part_ids: tuple[int, ...]) -> Int64[np.ndarray, " n"]:
    """Class of each label: the position of its part in `part_ids`; −1 for label 0, which is unlabelled.

    Raises
    ------
    LabelError : a label is not among the parts.
    """
    class_of_id = np.full(max([0, *part_ids, int(labels.max(initial=0))]) + 1, NO_CLASS, dtype=np.int64)
    class_of_id[list(part_ids)] = np.arange(len(part_ids))
    classes = class_of_id[labels]
    strangers = np.unique(labels[(classes == NO_CLASS) & (labels != 0)])
    if len(strangers):
        raise LabelError(
            f"labels must be 0 or one of {part_ids} but contain {strangers[0]}; is the part in the schema?"
        )
    return classes


def batch_rows(n_faces: int, batch_size: int, rng: np.random.Generator) -> Iterator[Int64[np.ndarray, " b"]]:
    """Endless batches of face indices: passes over ever new random permutations, so each face is as likely as any.

    A batch may span two passes; its size is always `batch_size`, also when there are fewer faces.
    """
    left = np.empty(0, dtype=np.int64)
    while True:
        while len(left) < batch_size:
            left = np.concatenate([left, rng.permutation(n_faces)])
        yield left[:batch_size]
        left = left[batch_size:]


class _Reservoir:
    """Uniform sample without replacement of a stream of rows (Vitter 1985, algorithm R, a block of rows at a time)."""

    def __init__(self, capacity: int) -> None:
        self._capacity = capacity
        self._n_seen = 0
        self._names: tuple[str, ...] = ()
        self._blocks: list[dict[str, np.ndarray]] = []
        self._kept: dict[str, np.ndarray] = {}

    def offer(self, rows: dict[str, np.ndarray], rng: np.random.Generator) -> None:
        """Takes a block of rows: a dictionary of columns of equal length."""
        names = tuple(sorted(rows))
        if self._names not in ((), names):
            raise LabelError(
                f"all shapes must have the same columns but {', '.join(names)} came after {', '.join(self._names)}; "
                "describe them alike"
            )
        self._names = names
        n_rows = len(rows["classes"])
        room = max(0, self._capacity - self._n_seen)
        if room:
            self._blocks.append({name: column[:room] for name, column in rows.items()})
        if n_rows > room:
            self._replace(rows, room, rng)
        self._n_seen += n_rows

    def columns(self) -> dict[str, np.ndarray]:
        """The rows kept, in no particular order; empty if none was offered."""
        self._consolidate()
        return dict(self._kept) if self._n_seen else {}

    def _replace(self, rows: dict[str, np.ndarray], room: int, rng: np.random.Generator) -> None:
        """Row number i (from 0) of the stream replaces a slot with probability capacity / (i + 1)."""
        self._consolidate()
        numbers = np.arange(self._n_seen + room, self._n_seen + len(rows["classes"]))
        slots = rng.integers(0, numbers + 1)
        enters = np.flatnonzero(slots < self._capacity)
        # Of two rows sent to one slot the later must win, as when rows come singly: keep each slot's last visitor.
        _, last = np.unique(slots[enters][::-1], return_index=True)
        winners = enters[::-1][last]
        for name, column in rows.items():
            self._kept[name][slots[winners]] = column[room:][winners]

    def _consolidate(self) -> None:
        if not self._blocks:
            return
        names = list(self._blocks[0])
        # Column by column, and from a list of its own, so that at most one column exists twice.
        self._kept = {name: np.concatenate([block.pop(name) for block in self._blocks]) for name in names}
        self._blocks = []


def _labelled_columns(shape: LabelledFaces) -> dict[str, np.ndarray]:
    labelled = np.flatnonzero(shape.classes != NO_CLASS)
    columns = {"classes": shape.classes[labelled]}
    for branch, grids in shape.grids.items():
        columns[f"{branch}/codes"] = grids.codes[labelled]
        columns[f"{branch}/scale"] = grids.scale[labelled]
    return columns


def _require_classes(classes: np.ndarray, n_parts: int, lowest: int) -> None:
    if classes.dtype != np.int64:
        raise LabelError(f"classes must be int64 but are {classes.dtype}; convert them")
    if len(classes) and (classes.min() < lowest or classes.max() >= n_parts):
        bad = int(classes.min()) if classes.min() < lowest else int(classes.max())
        raise LabelError(f"classes must be in {lowest} … {n_parts - 1} but contain {bad}; is the part in the schema?")
