"""Commits label revisions, imported or confirmed, and keeps the bytes of the meshes they belong to for good."""

from dataclasses import dataclass
from pathlib import Path, PurePosixPath

import numpy as np
from jaxtyping import UInt16
from safetensors.numpy import save

from partwise.errors import LabelError, NotFoundError, PartwiseError
from partwise.exchange.labels_psb import read_psb_labels
from partwise.exchange.named_labels import UNLABELLED as NO_LABEL
from partwise.exchange.named_labels import to_part_ids
from partwise.exchange.seg import read_seg
from partwise.labels.schema import UNLABELLED, PartSchema
from partwise.store.records import Collection, LabelRevision, Mesh, NewRevision, RevisionKind, Shape
from partwise.workspace.shapes import all_shapes, load_mesh, shape_mesh
from partwise.workspace.workspace import Workspace

PSB_ENDING = "_labels.txt"
SEG_ENDING = ".seg"


@dataclass(frozen=True, slots=True)
class RefusedLabels:
    """A label file that was not imported, and why, in one line."""

    file: str
    reason: str


@dataclass(frozen=True, slots=True)
class ImportReport:
    """What became of a folder's label files; `n_unlabelled` shapes had none."""

    n_imported: int
    n_unlabelled: int
    refused: tuple[RefusedLabels, ...]


def import_labels(
    workspace: Workspace, collection: Collection, folder: Path, kind: RevisionKind, author: str
) -> ImportReport:
    """For each shape `a/b.off` reads `a/b_labels.txt` or `a/b.seg` below the folder. A wrong file costs only itself.

    A `.seg` file holds part ids of the collection's schema, 0 for unlabelled.
    Shapes whose newest labels of this kind are the same are left as they are.
    """
    schema = workspace.catalog.parts(collection.id)
    n_imported = n_unlabelled = 0
    refused: list[RefusedLabels] = []
    for shape in all_shapes(workspace.catalog, collection.id):
        path = _label_file(folder, shape.source_key)
        if path is None:
            n_unlabelled += 1
            continue
        try:
            mesh = shape_mesh(workspace, shape)
            labels = read_labels(path, mesh.n_faces, schema)
            commit_labels(workspace, collection, shape, labels, kind, author)
            n_imported += 1
        except PartwiseError as error:
            refused.append(RefusedLabels(str(path), str(error)))
    return ImportReport(n_imported, n_unlabelled, tuple(refused))


def read_labels(path: Path, n_faces: int, schema: PartSchema) -> UInt16[np.ndarray, " m"]:
    """Part ids of a label file, (n_faces,) uint16.

    Raises
    ------
    FileFormatError : the file cannot be read as its name says.
    LabelError : the wrong number of labels, or a part that is not in the schema.
    """
    if path.name.endswith(PSB_ENDING):
        named = read_psb_labels(path, n_faces)
        ids = to_part_ids(named, {part.name: part.id for part in schema.parts}, str(path))
    else:
        ids = read_seg(path, n_faces)
    ids = np.where(ids == NO_LABEL, UNLABELLED, ids)
    unknown = sorted(set(np.unique(ids).tolist()) - {UNLABELLED, *schema.ids})
    if unknown:
        raise LabelError(f"{path}: part id {unknown[0]} is not in the schema (ids {schema.ids}); correct the file")
    return ids.astype(np.uint16)


def commit_labels(
    workspace: Workspace,
    collection: Collection,
    shape: Shape,
    labels: UInt16[np.ndarray, " m"],
    kind: RevisionKind,
    author: str,
) -> LabelRevision:
    """Keeps the mesh's bytes, then commits an immutable revision on it. Equal to the newest of its kind: returns that.

    Raises
    ------
    LabelError : one label per face is missing, or a label is not in the schema.
    ConflictError : the shape has no mesh yet.
    """
    catalog = workspace.catalog
    mesh = shape_mesh(workspace, shape)
    head = catalog.head_revision(shape.id, (kind,))
    if head is not None and head.mesh_hash == mesh.mesh_hash and np.array_equal(catalog.labels(head.id), labels):
        return head
    if kind is not RevisionKind.REFERENCE:
        keep_mesh(workspace, mesh)
    return catalog.add_revision(
        NewRevision(
            shape_id=shape.id,
            mesh_hash=mesh.mesh_hash,
            kind=kind,
            author_id=person_id(workspace, author),
            schema_version=collection.schema_version,
            labels=labels,
            parent_id=head.id if head else None,
        )
    )


def keep_mesh(workspace: Workspace, mesh: Mesh) -> None:
    """Keeps the bytes of a mesh under its content hash, never swept: labels on it are worth nothing without them."""
    if mesh.kept_key is not None:
        return
    key = f"kept/meshes/{mesh.mesh_hash}.safetensors"
    stored = load_mesh(workspace, mesh)
    arrays = {"vertices": stored.vertices.astype(np.float32), "faces": stored.faces.astype(np.uint32)}
    workspace.arrays.put_bytes(key, save(arrays))
    workspace.catalog.keep_mesh(mesh.mesh_hash, key)


def person_id(workspace: Workspace, name: str) -> int:
    """The id of the person of this name, who is added if new."""
    try:
        return workspace.catalog.get_person(name).id
    except NotFoundError:
        return workspace.catalog.add_person(name).id


def _label_file(folder: Path, source_key: str) -> Path | None:
    stem = PurePosixPath(source_key).with_suffix("")
    candidates = (folder / f"{stem}{ending}" for ending in (PSB_ENDING, SEG_ENDING))
    return next((path for path in candidates if path.is_file()), None)
