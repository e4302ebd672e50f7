"""Commits label revisions, imported or confirmed, and keeps the bytes of the meshes they belong to for good."""

from dataclasses import dataclass
from pathlib import Path, PurePosixPath

import numpy as np
from jaxtyping import UInt16

from partwise.errors import ConflictError, LabelError, NotFoundError, PartwiseError, StoreError
from partwise.exchange.labels_psb import read_psb_labels
from partwise.exchange.named_labels import to_part_ids
from partwise.exchange.seg import read_seg
from partwise.labels.schema import PartSchema
from partwise.store import meshes
from partwise.store.catalog import SHOWN_KINDS
from partwise.store.records import Collection, LabelRevision, Mesh, NewRevision, RevisionKind, Shape
from partwise.unlabelled import NO_CLASS, NO_PART_ID
from partwise.workspace.shapes import all_shapes, shape_mesh
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
    """What became of a folder's label files. `n_unchanged` were on record already; `n_unlabelled` shapes had none."""

    n_imported: int
    n_unchanged: int
    n_unlabelled: int
    refused: tuple[RefusedLabels, ...]


def import_labels(
    workspace: Workspace, collection: Collection, folder: Path, kind: RevisionKind, author: str
) -> ImportReport:
    """For each shape `a/b.off` reads `a/b_labels.txt` or `a/b.seg` below the folder. A wrong file costs only itself.

    A `.seg` file holds part ids of the collection's schema, 0 or −1 for unlabelled. Shapes whose newest labels of this
    kind are the same are left as they are; labels that a person confirmed are never hidden behind imported ones.

    Raises
    ------
    NotFoundError : there is no such folder, or no label file of any shape in it.
    StoreError : a store cannot be reached or written.
    """
    if not folder.is_dir():
        raise NotFoundError(f"labels are read from a folder but {folder} is not one; check the path")
    schema = workspace.catalog.parts(collection.id)
    n_imported = n_unchanged = n_unlabelled = 0
    refused: list[RefusedLabels] = []
    for shape in all_shapes(workspace.catalog, collection.id):
        path = _label_file(folder, shape.source_key)
        if path is None:
            n_unlabelled += 1
            continue
        try:
            is_new = _import(workspace, collection, shape, path, schema, kind, author)
            n_imported, n_unchanged = n_imported + is_new, n_unchanged + (not is_new)
        except StoreError:
            raise
        except PartwiseError as error:
            refused.append(RefusedLabels(str(path), _naming(path, error)))
    if n_imported + n_unchanged + len(refused) == 0:
        raise NotFoundError(
            f"{folder} must hold <shape>{PSB_ENDING} or <shape>{SEG_ENDING} files but has none for the "
            f"{n_unlabelled} shapes of {collection.name!r}; are names and subfolders those of the meshes?"
        )
    return ImportReport(n_imported, n_unchanged, n_unlabelled, tuple(refused))


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
    ids = np.where(ids == NO_CLASS, NO_PART_ID, ids)
    unknown = sorted(set(np.unique(ids).tolist()) - {NO_PART_ID, *schema.ids})
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
    """Keeps the mesh's bytes, then commits an immutable revision on it; what is on record already is returned instead.

    Raises
    ------
    LabelError : one label per face is missing, or a label is not in the schema.
    ConflictError : the shape has no mesh yet.
    """
    mesh = shape_mesh(workspace, shape)
    same = _same_labels(workspace, shape, mesh, labels, kind)
    if same is not None:
        return same
    if kind is not RevisionKind.REFERENCE:
        keep_mesh(workspace, mesh)
    parent = workspace.catalog.head_revision(shape.id, SHOWN_KINDS if kind in SHOWN_KINDS else (kind,))
    return workspace.catalog.add_revision(
        NewRevision(
            shape_id=shape.id,
            mesh_hash=mesh.mesh_hash,
            kind=kind,
            author_id=person_id(workspace, author),
            schema_version=collection.schema_version,
            labels=labels,
            parent_id=parent.id if parent else None,
        )
    )


def keep_mesh(workspace: Workspace, mesh: Mesh) -> None:
    """Keeps the bytes of a mesh under its content hash, never swept: labels on it are worth nothing without them."""
    meshes.keep_mesh(workspace.catalog, workspace.arrays, mesh)


def person_id(workspace: Workspace, name: str) -> int:
    """The id of the person of this name, who is added if new."""
    try:
        return workspace.catalog.get_person(name).id
    except NotFoundError:
        return workspace.catalog.add_person(name).id


def _import(
    workspace: Workspace,
    collection: Collection,
    shape: Shape,
    path: Path,
    schema: PartSchema,
    kind: RevisionKind,
    author: str,
) -> bool:
    """Commits one file's labels; whether they are new."""
    mesh = shape_mesh(workspace, shape)
    labels = read_labels(path, mesh.n_faces, schema)
    if _same_labels(workspace, shape, mesh, labels, kind) is not None:
        return False
    shown = workspace.catalog.head_revision(shape.id)
    if kind is RevisionKind.IMPORTED and shown is not None and shown.kind is RevisionKind.HUMAN:
        raise ConflictError(
            f"imported labels must not hide a person's but {shape.source_key} has labels that a person confirmed; "
            "take the file away, or put it on record with `partwise confirm`"
        )
    commit_labels(workspace, collection, shape, labels, kind, author)
    return True


def _same_labels(
    workspace: Workspace, shape: Shape, mesh: Mesh, labels: UInt16[np.ndarray, " m"], kind: RevisionKind
) -> LabelRevision | None:
    """The newest revision of this kind if it says the same about the same mesh; a person's only if it is shown."""
    head = workspace.catalog.head_revision(shape.id, SHOWN_KINDS if kind is RevisionKind.HUMAN else (kind,))
    if head is None or head.kind is not kind or head.mesh_hash != mesh.mesh_hash:
        return None
    return head if np.array_equal(workspace.catalog.labels(head.id), labels) else None


def _label_file(folder: Path, source_key: str) -> Path | None:
    stem = PurePosixPath(source_key).with_suffix("")
    candidates = (folder / f"{name}{ending}" for name in (source_key, stem) for ending in (PSB_ENDING, SEG_ENDING))
    return next((path for path in candidates if path.is_file()), None)


def _naming(path: Path, error: PartwiseError) -> str:
    return str(error) if str(path) in str(error) else f"{path}: {error}"
