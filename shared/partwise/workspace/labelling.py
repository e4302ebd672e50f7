"""Commits label revisions, imported or confirmed, and keeps the bytes of the meshes they belong to for good."""

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path, PurePosixPath

import numpy as np
from jaxtyping import UInt16

from partwise.errors import ConflictError, LabelError, NotFoundError, PartwiseError, StoreError
from partwise.exchange.label_files import read_label_bytes
from partwise.exchange.labels_psb import read_psb_labels
from partwise.exchange.named_labels import to_part_ids
from partwise.exchange.seg import read_seg
from partwise.labels.schema import PartSchema
from partwise.store import meshes
from partwise.store.catalog import SHOWN_KINDS
from partwise.store.records import Collection, LabelRevision, Mesh, NewRevision, RevisionKind, Shape
from partwise.unlabelled import NO_CLASS, NO_PART_ID
from partwise.workspace.label_sources import NPZ_ENDING, PAIR_ENDING, POINTS_ENDING, read_own_labels
from partwise.workspace.partnet_folders import folder_labels, folder_of
from partwise.workspace.relabel import MoveReport, move_here, origin_on
from partwise.workspace.shapes import all_shapes, shape_mesh
from partwise.workspace.workspace import Workspace

PSB_ENDING = "_labels.txt"
SEG_ENDING = ".seg"
# A pair's labels end in .seg as well, so that its points are looked for first.
_ENDINGS = (PSB_ENDING, PAIR_ENDING, SEG_ENDING, NPZ_ENDING, POINTS_ENDING)


@dataclass(frozen=True, slots=True)
class RefusedLabels:
    """A label file that was not imported, and why, in one line."""

    file: str
    reason: str


@dataclass(frozen=True, slots=True)
class ImportReport:
    """What became of a folder's label files. `n_unchanged` were on record already; `n_unlabelled` shapes had none.

    moves : of labels that belong to the shapes' own files, to their working meshes.
    """

    n_imported: int
    n_unchanged: int
    n_unlabelled: int
    refused: tuple[RefusedLabels, ...]
    moves: MoveReport


def import_labels(
    workspace: Workspace,
    collection: Collection,
    folder: Path,
    kind: RevisionKind,
    author: str,
    mover: Callable[[Workspace, Collection], MoveReport] = move_here,
) -> ImportReport:
    """For each shape `a/b.off` reads the first of `a/b_labels.txt`, `a/b.pts` with `a/b.seg`, `a/b.seg`, `a/b.npz` and
    `a/b.txt` (ShapeNetPart points) below the folder, or the PartNet folder `a/b`. A wrong one costs only itself.

    A `.seg` file holds part ids of the collection's schema, 0 or −1 for unlabelled. Labels are of the faces of the
    shape's own file or of its working mesh, whichever has so many; of the file where both have. Those of the file are
    moved to the working mesh by `mover` once all are on record. Shapes whose newest labels of this kind are the same
    are left as they are; labels that a person confirmed are never hidden behind imported ones.

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
            f"{folder} must hold <shape>{PSB_ENDING}, {SEG_ENDING}, {NPZ_ENDING} or points' files but has none for the "
            f"{n_unlabelled} shapes of {collection.name!r}; are names and subfolders those of the meshes?"
        )
    return ImportReport(n_imported, n_unchanged, n_unlabelled, tuple(refused), mover(workspace, collection))


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
    mesh: Mesh | None = None,
) -> LabelRevision:
    """Keeps the mesh's bytes, then commits an immutable revision on it; what is on record already is returned instead.

    A person who confirms labels that were merely moved to this mesh makes them their own: that is a new revision.

    Parameters
    ----------
    mesh : one of the shape's; the working mesh unless another is given.

    Raises
    ------
    LabelError : one label per face is missing, or a label is not in the schema.
    ConflictError : the shape has no mesh yet.
    """
    mesh = shape_mesh(workspace, shape) if mesh is None else mesh
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
    if path.is_dir():
        mesh = workspace.catalog.original_meshes([shape.id]).get(shape.id) or shape_mesh(workspace, shape)
        labels = folder_labels(path, mesh, schema)
    elif path.name.endswith((PSB_ENDING, SEG_ENDING)):
        mesh = _mesh_of_file(workspace, shape, path)
        labels = read_labels(path, mesh.n_faces, schema)
    else:
        mesh, labels = read_own_labels(workspace, shape, path, schema)
    if _same_labels(workspace, shape, mesh, labels, kind) is not None:
        return False
    shown = workspace.catalog.head_revision(shape.id)
    if kind is RevisionKind.IMPORTED and shown is not None and shown.kind is RevisionKind.HUMAN:
        raise ConflictError(
            f"imported labels must not hide a person's but {shape.source_key} has labels that a person confirmed; "
            "take the file away, or put it on record with `partwise confirm`"
        )
    commit_labels(workspace, collection, shape, labels, kind, author, mesh)
    return True


def _mesh_of_file(workspace: Workspace, shape: Shape, path: Path) -> Mesh:
    """Which of the shape's meshes a label file belongs to, by its number of faces: the original, or the working mesh.

    A `_labels.txt` file may leave faces out: the last face it names must tell the two apart.
    """
    original = workspace.catalog.original_meshes([shape.id]).get(shape.id)
    working = workspace.catalog.meshes([shape.id]).get(shape.id)
    if original is None or working is None or original.n_faces == working.n_faces:
        return original or shape_mesh(workspace, shape)
    n_faces = _n_labels(path, max(original.n_faces, working.n_faces))
    for mesh in (original, working):
        if n_faces == mesh.n_faces:
            return mesh
    is_partial = path.name.endswith(PSB_ENDING)
    fitting = [mesh for mesh in (original, working) if is_partial and n_faces <= mesh.n_faces]
    if len(fitting) == 1:
        return fitting[0]
    raise LabelError(
        f"{path}: labels must be of the file's {original.n_faces:,} faces or of the working mesh's {working.n_faces:,} "
        f"but {'the last face named is' if is_partial else 'there are'} {n_faces:,}; are they another shape's?"
    )


def _n_labels(path: Path, max_faces: int) -> int:
    """Faces that a label file is for: its labels, or the last face that it names."""
    if not path.name.endswith(PSB_ENDING):
        return len(read_label_bytes(path, None).split())
    named = np.flatnonzero(read_psb_labels(path, max_faces).indices != NO_CLASS)
    return int(named[-1]) + 1 if len(named) else 0


def _same_labels(
    workspace: Workspace, shape: Shape, mesh: Mesh, labels: UInt16[np.ndarray, " m"], kind: RevisionKind
) -> LabelRevision | None:
    """The newest revision of this kind if it, or what it was moved from, says the same about the same mesh.

    A person's counts only if it is shown, and as that person made it.
    """
    head = workspace.catalog.head_revision(shape.id, SHOWN_KINDS if kind is RevisionKind.HUMAN else (kind,))
    if head is None or head.kind is not kind:
        return None
    found = origin_on(workspace.catalog, head, mesh.mesh_hash)
    if found is None or (kind is RevisionKind.HUMAN and found.origin is not None):
        return None
    return found if np.array_equal(workspace.catalog.labels(found.id), labels) else None


def _label_file(folder: Path, source_key: str) -> Path | None:
    stem = PurePosixPath(source_key).with_suffix("")
    candidates = (folder / f"{name}{ending}" for name in (source_key, stem) for ending in _ENDINGS)
    return next((path for path in candidates if path.is_file()), None) or folder_of(folder, source_key)


def _naming(path: Path, error: PartwiseError) -> str:
    return str(error) if str(path) in str(error) else f"{path}: {error}"
