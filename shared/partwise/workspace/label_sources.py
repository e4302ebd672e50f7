"""Label files that say by themselves which of a shape's meshes they are for: NPZ by hash, points by where they lie."""

from pathlib import Path

import numpy as np
from jaxtyping import UInt16

from partwise.errors import LabelError
from partwise.exchange.label_npz import read_npz
from partwise.exchange.labelled_mesh import DescribedMesh
from partwise.exchange.labelled_points import LabelledPoints, read_point_pair, read_points
from partwise.exchange.named_labels import NamedLabels, to_part_ids
from partwise.exchange.points_to_faces import PointTransfer, face_labels_from_points
from partwise.labels.schema import PartSchema
from partwise.mesh import TriMesh
from partwise.store.records import Mesh, Shape
from partwise.unlabelled import NO_CLASS, NO_PART_ID
from partwise.workspace.shapes import load_mesh, shape_mesh
from partwise.workspace.workspace import Workspace

NPZ_ENDING, POINTS_ENDING, PAIR_ENDING = ".npz", ".txt", ".pts"


def read_own_labels(
    workspace: Workspace, shape: Shape, path: Path, schema: PartSchema
) -> tuple[Mesh, UInt16[np.ndarray, " m"]]:
    """The mesh of the shape that a file's labels are for, and its part ids, 0 where unlabelled.

    NPZ's parts are those of the schema by name. Points' labels are its part ids, −1 for unlabelled, and belong
    to the shape's own file; where they do not lie on it, their bounding box is fitted to it first.

    Raises
    ------
    FileFormatError : the file cannot be read as its name says.
    LabelError : labels of another mesh, points of another shape, or a part that is not in the schema.
    """
    original = workspace.catalog.original_meshes([shape.id]).get(shape.id)
    if path.suffix == NPZ_ENDING:
        described = read_npz(path)
        working = workspace.catalog.meshes([shape.id]).get(shape.id)
        mesh_hash = described.mesh.content_hash()
        for mesh in (original, working):
            if mesh is not None and mesh.mesh_hash == mesh_hash:
                return mesh, _as_stored(_by_name(described, schema, path), schema, path)
        raise LabelError(
            f"{path}: labels must be of one of the shape's meshes but are of mesh {mesh_hash[:12]}…, which is none of "
            "them; were they exported before the shape was remeshed?"
        )
    mesh = original or shape_mesh(workspace, shape)
    points = read_points(path) if path.suffix == POINTS_ENDING else read_point_pair(path, path.with_suffix(".seg"))
    _check_known(points.labels, schema, path)
    try:
        return mesh, _as_stored(_on_faces(points, load_mesh(workspace, mesh)), schema, path)
    except LabelError as error:
        raise LabelError(str(error) if str(path) in str(error) else f"{path}: {error}") from error


def _on_faces(points: LabelledPoints, mesh: TriMesh) -> np.ndarray:
    try:
        return face_labels_from_points(points, mesh)
    except LabelError:
        return face_labels_from_points(points, mesh, PointTransfer(fit_box=True))


def _by_name(described: DescribedMesh, schema: PartSchema, path: Path) -> np.ndarray:
    """Labels as ids of the schema; parts without faces need not be in it."""
    used = [part for part in described.parts.parts if (described.labels == part.id).any()]
    indices = np.full(len(described.labels), NO_CLASS, dtype=np.int64)
    for index, part in enumerate(used):
        indices[described.labels == part.id] = index
    named = NamedLabels(tuple(part.name for part in used), indices)
    return to_part_ids(named, {part.name: part.id for part in schema.parts}, str(path))


def _as_stored(labels: np.ndarray, schema: PartSchema, path: Path) -> UInt16[np.ndarray, " m"]:
    _check_known(labels, schema, path)
    return np.where(labels == NO_CLASS, NO_PART_ID, labels).astype(np.uint16)


def _check_known(labels: np.ndarray, schema: PartSchema, path: Path) -> None:
    strangers = np.setdiff1d(labels, [NO_CLASS, *schema.ids])
    if len(strangers):
        raise LabelError(
            f"{path}: labels must be part ids of the schema (ids {schema.ids}) or −1 but one is {strangers[0]}; "
            "renumber the file"
        )
