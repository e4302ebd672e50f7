"""The annotator's toolbox on the files of one mesh: patches, boundary refinement, replay of a stroke log.

Labels come and go as `.seg` or `_labels.txt`, and go as `.ply` too. As on import, 0 and −1 are unlabelled in `.seg`.
"""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from jaxtyping import Int

from partwise.config import read_config
from partwise.errors import ParameterError, PartwiseError
from partwise.exchange.label_files import read_label_text
from partwise.exchange.labelled_mesh import LabelledMesh
from partwise.exchange.labels_psb import read_psb_labels, write_psb_labels
from partwise.exchange.named_labels import NamedLabels
from partwise.exchange.parts import PartEntry
from partwise.exchange.ply_labels import write_ply_labels
from partwise.exchange.seg import read_seg, write_seg
from partwise.io.read import read_mesh
from partwise.labels.annotation_cost import AnnotationCost, annotation_cost
from partwise.labels.encoding import labels_sha256
from partwise.labels.palette import default_colour
from partwise.labels.replay import replay
from partwise.labels.stroke_json import log_from_json
from partwise.labels.strokes import StrokeLog
from partwise.mesh import TriMesh
from partwise.segmentation.boundary_refinement import refine_boundaries
from partwise.segmentation.parameters import BOUNDARY_PRESETS, BoundaryParameters
from partwise.segmentation.patch_parameters import PatchMethod
from partwise.segmentation.patches import over_segment
from partwise.unlabelled import NO_CLASS, NO_PART_ID
from partwise.workspace.labelling import PSB_ENDING

LABEL_ENDINGS = (".seg", PSB_ENDING)
OUT_ENDINGS = (*LABEL_ENDINGS, ".ply")


@dataclass(frozen=True, slots=True, eq=False)
class FaceLabels:
    """Part ids from 1, (m,) int64, −1 = unlabelled, and the names of parts where the file had them."""

    ids: Int[np.ndarray, " m"]
    names: Mapping[int, str]

    @property
    def n_unlabelled(self) -> int:
        return int((self.ids == NO_CLASS).sum())


@dataclass(frozen=True, slots=True)
class RefineRequest:
    """How to refine: a preset by name, or the [boundary] section of a configuration file; ω may be set over either.

    Raises
    ------
    ParameterError : a preset and a file, or a preset that is none.
    """

    preset: str | None = None
    config: Path | None = None
    omega: float | None = None

    def __post_init__(self) -> None:
        if self.preset is not None and self.config is not None:
            raise ParameterError("refinement must follow a preset or a configuration file but has both; leave one out")
        if self.preset is not None and self.preset not in BOUNDARY_PRESETS:
            raise ParameterError(f"preset must be one of {', '.join(BOUNDARY_PRESETS)} but is {self.preset!r}")

    def parameters(self) -> BoundaryParameters:
        """Raises ConfigError for a file that is wrong, ParameterError for ω outside [0, 1]."""
        chosen = (
            BOUNDARY_PRESETS[self.preset or "default"] if self.config is None else read_config(self.config).boundary
        )
        return chosen if self.omega is None else replace(chosen, angle_weight=self.omega)


@dataclass(frozen=True, slots=True)
class RefineReport:
    """How many faces had a label that is another now, and how many had none."""

    n_changed: int
    n_filled: int
    n_faces: int


@dataclass(frozen=True, slots=True)
class ReplayReport:
    """What a log left, and what it cost. sha256 : of the labels, as a revision of them has it."""

    n_events: int
    n_labelled: int
    n_faces: int
    sha256: str
    cost: AnnotationCost


def cut_patches(mesh_file: Path, method: PatchMethod, n_patches: int, out: Path) -> int:
    """Writes patches, numbered from 1, and says how many: more than asked for where there are more components.

    Raises
    ------
    ParameterError : more patches than faces, an ending of `out` that is not written.
    FileFormatError, MeshError : the mesh cannot be read.
    """
    _check_ending(out, OUT_ENDINGS)
    mesh = read_mesh(mesh_file)
    patches = over_segment(mesh, method).patches(n_patches) + 1
    n_made = int(patches.max())
    write_face_labels(out, mesh, FaceLabels(patches, {k: f"patch {k}" for k in range(1, n_made + 1)}))
    return n_made


def refine_labels(
    mesh_file: Path, labels_file: Path, request: RefineRequest, out: Path, anchor_file: Path | None = None
) -> RefineReport:
    """One pass of boundary refinement from file to file. `anchor_file` : labels to stay near, else those given.

    Raises
    ------
    LabelError : labels of another mesh, or no labelled face.
    ParameterError, ConfigError : as `RefineRequest` says, or an ending of a file that is not read or written.
    """
    _check_ending(out, OUT_ENDINGS)
    parameters, mesh = request.parameters(), read_mesh(mesh_file)
    labels = read_face_labels(labels_file, mesh.n_faces)
    anchor = None if anchor_file is None else read_face_labels(anchor_file, mesh.n_faces).ids
    try:
        refined = refine_boundaries(mesh, labels.ids, parameters, _diameter(mesh, parameters), anchor)
    except PartwiseError as error:
        raise type(error)(f"{labels_file}: {error}") from error
    write_face_labels(out, mesh, FaceLabels(refined, labels.names))
    n_changed = int(((refined != labels.ids) & (labels.ids != NO_CLASS)).sum())
    return RefineReport(n_changed, labels.n_unlabelled, mesh.n_faces)


def replay_log(mesh_file: Path, log_file: Path, out: Path, base_file: Path | None = None) -> ReplayReport:
    """Writes the labels that a stroke log leaves. `base_file` : labels that it starts from, else all unlabelled.

    Raises
    ------
    FileFormatError : not a stroke log.
    LabelError : a log of another mesh or from other labels, or a stroke that cannot be done.
    ParameterError : an ending of a file that is not read or written.
    """
    _check_ending(out, OUT_ENDINGS)
    mesh, log = read_mesh(mesh_file), read_log(log_file)
    base = FaceLabels(np.full(mesh.n_faces, NO_CLASS), {})
    if base_file is not None:
        base = read_face_labels(base_file, mesh.n_faces)
    try:
        labels = replay(mesh, np.where(base.ids == NO_CLASS, NO_PART_ID, base.ids), log)
    except PartwiseError as error:
        raise type(error)(f"{log_file}: {error}") from error
    ids = np.where(labels == NO_PART_ID, NO_CLASS, labels.astype(np.int64))
    left = FaceLabels(ids, base.names)
    write_face_labels(out, mesh, left)
    n_labelled = mesh.n_faces - left.n_unlabelled
    return ReplayReport(len(log.strokes), n_labelled, mesh.n_faces, labels_sha256(labels), annotation_cost(log.strokes))


def read_log(path: Path) -> StrokeLog:
    """The stroke log of a JSON file. Raises as `log_from_json`, with the file's name."""
    text = read_label_text(path, None)
    try:
        return log_from_json(text)
    except PartwiseError as error:
        raise type(error)(f"{path}: {error}") from error


def read_face_labels(path: Path, n_faces: int) -> FaceLabels:
    """Labels of a `.seg` or `_labels.txt` file; the parts of the latter are 1, 2, … in the file's order.

    Raises
    ------
    ParameterError : another ending.
    FileFormatError, LabelError : the file is damaged, or another mesh's.
    """
    _check_ending(path, LABEL_ENDINGS)
    if path.name.endswith(PSB_ENDING):
        named = read_psb_labels(path, n_faces)
        ids = np.where(named.indices == NO_CLASS, NO_CLASS, named.indices + 1)
        return FaceLabels(ids, dict(enumerate(named.part_names, start=1)))
    ids = read_seg(path, n_faces)
    return FaceLabels(np.where(ids == NO_PART_ID, NO_CLASS, ids), {})


def write_face_labels(path: Path, mesh: TriMesh, labels: FaceLabels) -> None:
    """Writes labels in the format of the file's ending; a part without a name is `part <id>`.

    Raises
    ------
    ParameterError : another ending.
    StoreError : the file cannot be written.
    """
    _check_ending(path, OUT_ENDINGS)
    part_ids = np.setdiff1d(labels.ids, [NO_CLASS])
    if path.name.endswith(PSB_ENDING):
        indices = np.where(labels.ids == NO_CLASS, NO_CLASS, np.searchsorted(part_ids, labels.ids))
        names = tuple(labels.names.get(part_id, f"part {part_id}") for part_id in part_ids.tolist())
        write_psb_labels(path, NamedLabels(names, indices))
    elif path.suffix == ".ply":
        colours = {k: PartEntry(k, f"part {k}", default_colour(k).lower()).rgb for k in part_ids.tolist()}
        write_ply_labels(path, LabelledMesh(mesh, labels.ids), colours)
    else:
        write_seg(path, labels.ids)


def _diameter(mesh: TriMesh, parameters: BoundaryParameters) -> np.ndarray | None:
    if parameters.angle_weight == 1:  # angles alone: rays would be cast for nothing
        return None
    from partwise.features.shape_diameter import shape_diameter

    return shape_diameter(mesh).astype(np.float64)


def _check_ending(path: Path, endings: tuple[str, ...]) -> None:
    if not path.name.endswith(endings):
        raise ParameterError(f"{path}: the name of a label file must end in {', '.join(endings)}; rename it")
