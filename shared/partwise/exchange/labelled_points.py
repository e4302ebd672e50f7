"""Points with a label each, as ShapeNetPart has them, read, written, and sampled from labelled meshes.

Two layouts: a `.txt` of seven columns, `x y z nx ny nz label` ("…_v0_normal"), and a pair of `points/<id>.pts` with `x
y z` and `points_label/<id>.seg` with one label a line ("…_v0"). Labels are numbers without names: 0 to 49 over all
categories in the first, 1 to 6 within a category in the second. Here they are part ids, and −1 is unlabelled, which
ShapeNetPart does not know.

Source: Yi et al. 2016; columns as `ShapeNetDataLoader.py` of yanx27/Pointnet_Pointnet2_pytorch and
`pointnet/dataset.py` of fxia22/pointnet.pytorch read them. Differs: −1.
"""

from dataclasses import dataclass
from pathlib import Path

import numpy as np
from jaxtyping import Float, Int

from partwise.errors import DegenerateMeshError, FileFormatError, LabelError, ParameterError
from partwise.exchange.label_files import read_label_bytes
from partwise.exchange.labelled_mesh import LabelledMesh
from partwise.geometry.faces import face_areas, face_normals
from partwise.io.atomic import write_atomically
from partwise.io.text import parse_integers
from partwise.unlabelled import NO_CLASS

MAX_POINTS = 5_000_000
_N_COLUMNS = 7
_LARGEST_LABEL = 2**31 - 1


@dataclass(frozen=True, slots=True, eq=False)
class LabelledPoints:
    """Points on a surface, a label each.

    points : (s, 3) float64, model units. normals : (s, 3) float64, or None where the source has none.
    labels : (s,) int64 ≥ −1; −1 = unlabelled.

    Raises
    ------
    LabelError : lengths that disagree, no points or too many, NaN, or a label below −1.
    """

    points: Float[np.ndarray, "s 3"]
    normals: Float[np.ndarray, "s 3"] | None
    labels: Int[np.ndarray, " s"]

    def __post_init__(self) -> None:
        n = len(self.points)
        if not 1 <= n <= MAX_POINTS:
            raise LabelError(f"there must be 1 to {MAX_POINTS} points but there are {n}; sample fewer")
        columns = [self.points] if self.normals is None else [self.points, self.normals]
        if self.labels.shape != (n,) or any(column.shape != (n, 3) for column in columns):
            raise LabelError(
                f"{n} points must have a label and three coordinates each but labels are {self.labels.shape} and "
                f"coordinates {[column.shape for column in columns]}; are they of another shape?"
            )
        if not all(np.isfinite(column).all() for column in columns):
            raise LabelError("points and normals must be finite but some are not; drop them")
        if int(self.labels.min()) < NO_CLASS:
            raise LabelError(f"labels must be −1 or more but one is {int(self.labels.min())}; −1 means unlabelled")

    def renumbered(self, part_ids: dict[int, int]) -> "LabelledPoints":
        """The same points with other labels, for files that count otherwise than a schema; −1 stays.

        Raises
        ------
        LabelError : a label has no entry in `part_ids`.
        """
        table = {**part_ids, NO_CLASS: NO_CLASS}
        distinct, position = np.unique(self.labels, return_inverse=True)
        strangers = [label for label in distinct.tolist() if label not in table]
        if strangers:
            raise LabelError(
                f"every label must have a part id but {strangers} have none; they are for {sorted(part_ids)}"
            )
        new = np.array([table[label] for label in distinct.tolist()], dtype=np.int64)
        return LabelledPoints(self.points, self.normals, new[position.ravel()])


def sample_labelled_points(
    labelled: LabelledMesh, n_points: int, rng: np.random.Generator, *, omit_unlabelled: bool = False
) -> LabelledPoints:
    """Points drawn uniformly over the area, each with its face's normal and label.

    Parameters
    ----------
    n_points : 1 to 5,000,000.
    omit_unlabelled : draw on labelled faces only, for programs that would take −1 for an index.

    Raises
    ------
    ParameterError : n_points out of range.
    DegenerateMeshError : the faces to draw on have no area.
    """
    if not 1 <= n_points <= MAX_POINTS:
        raise ParameterError(f"n_points must be 1 to {MAX_POINTS} but is {n_points}; choose between")
    areas = face_areas(labelled.mesh)
    if omit_unlabelled:
        areas = np.where(labelled.labels == NO_CLASS, 0.0, areas)
    total = float(areas.sum())
    if not total > 0:
        raise DegenerateMeshError("points are drawn by area but the faces to draw on have none; label or repair some")
    faces = rng.choice(len(areas), size=n_points, p=areas / total)
    u, v = rng.random((2, n_points))
    beyond = u + v > 1.0
    u, v = np.where(beyond, 1.0 - u, u), np.where(beyond, 1.0 - v, v)
    a, b, c = (labelled.mesh.vertices[labelled.mesh.faces[faces, k]] for k in range(3))
    points = a + u[:, None] * (b - a) + v[:, None] * (c - a)
    return LabelledPoints(points, face_normals(labelled.mesh)[faces], labelled.labels[faces])


def read_points(path: Path | str, data: bytes | None = None) -> LabelledPoints:
    """Points of a `.txt` with seven columns. The dataset writes labels as 12.000000; only whole ones are taken.

    Raises
    ------
    FileFormatError : missing, empty, or not seven numbers a line.
    LabelError : a label that is no whole number ≥ −1, NaN, or too many points.
    """
    table = _number_table(path, read_label_bytes(path, data), _N_COLUMNS, "x y z nx ny nz label")
    labels = table[:, 6]
    is_bad = ~((labels == np.floor(labels)) & (np.abs(labels) <= _LARGEST_LABEL))
    if is_bad.any():
        line = int(np.argmax(is_bad))
        raise LabelError(f"{path}: labels must be whole numbers but point {line + 1} has {labels[line]:g}; round it")
    return _points(path, table[:, :3], table[:, 3:6], labels.astype(np.int64))


def read_point_pair(
    points_path: Path | str,
    labels_path: Path | str,
    points_data: bytes | None = None,
    labels_data: bytes | None = None,
) -> LabelledPoints:
    """Points of a `.pts` file and their labels of a `.seg` file, without normals.

    Raises
    ------
    FileFormatError : a file is missing, empty or no numbers.
    LabelError : not a label for each point, a label below −1, NaN, or too many points.
    """
    points = _number_table(points_path, read_label_bytes(points_path, points_data), 3, "x y z")
    try:
        labels = parse_integers(read_label_bytes(labels_path, labels_data).split(), "labels")
    except FileFormatError as error:
        named = str(error) if str(labels_path) in str(error) else f"{labels_path}: {error}"
        raise FileFormatError(named) from error
    return _points(labels_path, points, None, labels)


def write_points(path: Path | str, points: LabelledPoints) -> None:
    """Writes `x y z nx ny nz label` a line, float32 exact.

    Raises
    ------
    LabelError : the points have no normals.
    StoreError : the file cannot be written.
    """
    if points.normals is None:
        raise LabelError(f"{path}: points must have normals for seven columns but have none; sample them from a mesh")
    numbers = np.hstack([points.points, points.normals]).astype(np.float32)
    rows = zip(numbers.tolist(), points.labels.tolist(), strict=True)
    lines = (f"{x:.9g} {y:.9g} {z:.9g} {nx:.9g} {ny:.9g} {nz:.9g} {label}\n" for (x, y, z, nx, ny, nz), label in rows)
    write_atomically(path, "".join(lines).encode("ascii"))


def _number_table(path: Path | str, data: bytes, n_columns: int, columns: str) -> Float[np.ndarray, "s c"]:
    lines = data.splitlines()
    if len(lines) > 2 * MAX_POINTS:  # blank lines and all, before they become numbers
        raise FileFormatError(
            f"{path}: there may be {MAX_POINTS} points but there are {len(lines)} lines; sample fewer"
        )
    try:
        table = np.loadtxt(lines, dtype=np.float64, comments=None, ndmin=2)
    except ValueError as error:
        reason = " ".join(str(error).split())[:200]
        raise FileFormatError(f"{path}: lines must be {columns} but {reason}; is the file truncated?") from error
    if table.shape[1] != n_columns:
        raise FileFormatError(
            f"{path}: lines must be {columns} but have {table.shape[1]} columns; is it another kind of file?"
        )
    return table


def _points(
    path: Path | str,
    points: Float[np.ndarray, "s 3"],
    normals: Float[np.ndarray, "s 3"] | None,
    labels: Int[np.ndarray, " s"],
) -> LabelledPoints:
    try:
        return LabelledPoints(points, normals, labels)
    except LabelError as error:
        raise LabelError(f"{path}: {error}") from error
