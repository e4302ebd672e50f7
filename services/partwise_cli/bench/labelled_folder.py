"""Labelled meshes in the layout of the Princeton benchmark: `[<Category>/]<id>.off` beside `<id>_labels.txt`."""

from collections.abc import Callable, Iterator, Sequence
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from jaxtyping import Int

from partwise.errors import FileFormatError, LabelError, MeshError, NotEnoughDataError, NotFoundError
from partwise.exchange.labels_psb import read_psb_labels
from partwise.exchange.named_labels import to_part_ids
from partwise.exchange.seg import read_seg
from partwise.io.read import read_mesh
from partwise.unlabelled import NO_CLASS
from partwise.workspace.ingest import mesh_files
from partwise.workspace.labelling import PSB_ENDING
from partwise_cli.bench.annotating import TaskShape
from partwise_cli.bench.leave_one_out import evenly_spaced
from partwise_cli.bench.patches import TrueShape

DAMAGE = (FileFormatError, LabelError, MeshError)
"""What is wrong with one shape's files, and costs only that shape."""


@dataclass(frozen=True, slots=True)
class ShapeFile:
    """A mesh with labels, not read yet. category : name of its folder, "" where the folder has no others."""

    category: str
    mesh: Path
    part_names: tuple[str, ...]

    @property
    def name(self) -> str:
        return f"{self.category}/{self.mesh.stem}" if self.category else self.mesh.stem

    def read(self) -> TrueShape:
        """The mesh and its true parts, indices into the part names of its category, −1 where unlabelled.

        Raises
        ------
        FileFormatError, LabelError : a file is damaged, or the labels are another mesh's.
        """
        mesh = read_mesh(self.mesh)
        labels = read_psb_labels(self.mesh.with_name(self.mesh.stem + PSB_ENDING), mesh.n_faces)
        index_of = {name: index for index, name in enumerate(self.part_names)}
        return TrueShape(self.name, mesh, to_part_ids(labels, index_of, str(self.mesh)))


def labelled_files(folder: Path, on_category: Callable[[int, int], None] | None = None) -> list[ShapeFile]:
    """All meshes with labels in the folder, or in the folders in it, each of which is a category with parts of its own.

    Raises
    ------
    NotFoundError : there is no such folder.
    NotEnoughDataError : nothing in it has labels.
    """
    if not folder.is_dir():
        raise NotFoundError(f"the toolbox is measured on a folder of meshes and labels but {folder} is none; check it")
    categories = [folder, *sorted(path for path in folder.iterdir() if path.is_dir())]
    found: list[ShapeFile] = []
    for n_done, path in enumerate(categories, start=1):
        meshes = [mesh for mesh in mesh_files(path) if mesh.parent == path]
        labelled = [mesh for mesh in sorted(meshes) if mesh.with_name(mesh.stem + PSB_ENDING).is_file()]
        names = _part_names(labelled)
        found += [ShapeFile("" if path == folder else path.name, mesh, names) for mesh in labelled]
        if on_category is not None:
            on_category(n_done, len(categories))
    if not found:
        raise NotEnoughDataError(f"the toolbox is measured on <id>{PSB_ENDING} files but {folder} has none; add some")
    return found


def _part_names(labelled: Sequence[Path]) -> tuple[str, ...]:
    """Every part name that the label files use, sorted. A damaged file is named when its shape is read."""
    names: set[str] = set()
    for mesh in labelled:
        with suppress(*DAMAGE):
            names.update(read_psb_labels(mesh.with_name(mesh.stem + PSB_ENDING), read_mesh(mesh).n_faces).part_names)
    return tuple(sorted(names))


def sampled(files: Sequence[ShapeFile], limit: int | None) -> list[ShapeFile]:
    """`limit` of each category, evenly spaced; all without a limit."""
    chosen: list[ShapeFile] = []
    for category in dict.fromkeys(file.category for file in files):
        members = [file for file in files if file.category == category]
        chosen += [members[index] for index in evenly_spaced(len(members), limit)]
    return chosen


def fully_labelled(files: Sequence[ShapeFile], refused: list[str]) -> Iterator[tuple[ShapeFile, TrueShape]]:
    """Shapes whose every face has a true part, one at a time; why the others are left out goes to `refused`."""
    for file in files:
        try:
            shape = file.read()
        except DAMAGE as error:
            refused.append(str(error) if str(file.mesh.parent) in str(error) else f"{file.mesh}: {error}")
            continue
        n_unlabelled = int((shape.truth == NO_CLASS).sum())
        if n_unlabelled:
            refused.append(
                f"{file.mesh}: {n_unlabelled:,} faces have no true part; label them to measure on this shape"
            )
        else:
            yield file, shape


def tasks(files: Sequence[ShapeFile], predictions: Path | None, refused: list[str]) -> Iterator[TaskShape]:
    """Shapes to annotate, one at a time, with the predictions that a folder has for them.

    predictions : has `predicted/` and `refined/`, or one of them, with `[<Category>/]<id>.seg` of part ids: parts by
    name, the first is 1; −1 is unlabelled. None to simulate. refused : as `fully_labelled` has it.

    Raises
    ------
    NotFoundError : a shape has neither.
    LabelError : labels of another mesh, or part ids that the category does not have.
    """
    for file, shape in fully_labelled(files, refused):
        if predictions is None:
            yield TaskShape(shape, file.part_names)
            continue
        predicted, refined = (_read_prediction(predictions / kind, file, shape) for kind in ("predicted", "refined"))
        if predicted is None and refined is None:
            raise NotFoundError(
                f"{predictions} must have predicted/{file.name}.seg or refined/{file.name}.seg but has neither; "
                "export them, or leave --predictions out"
            )
        yield TaskShape(shape, file.part_names, predicted, refined)


def _read_prediction(folder: Path, file: ShapeFile, shape: TrueShape) -> Int[np.ndarray, " m"] | None:
    path = folder / f"{file.name}.seg"
    if not path.is_file():
        return None
    part_ids = read_seg(path, shape.mesh.n_faces)
    if (part_ids == 0).any() or int(part_ids.max()) > len(file.part_names):
        raise LabelError(
            f"{path}: part ids must be 1 to {len(file.part_names)} ({', '.join(file.part_names)}), or −1, but run from "
            f"{int(part_ids.min())} to {int(part_ids.max())}; export with the parts of this folder, sorted by name"
        )
    return np.where(part_ids == NO_CLASS, NO_CLASS, part_ids - 1)
