"""The labels of shapes on the mesh where they are wanted: the working mesh, or the faces of the file as it came."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np
from jaxtyping import UInt16

from partwise.errors import PartwiseError, StoreError
from partwise.remesh.moved_labels import MovedLabels
from partwise.store.catalog import SHOWN_KINDS
from partwise.store.records import Mesh, MeshRole, Shape
from partwise.workspace.relabel import compute_move, require_store, with_origins
from partwise.workspace.segmentations import Segmentation, segment
from partwise.workspace.workspace import Workspace


@dataclass(frozen=True, slots=True, eq=False)
class PlacedLabels:
    """A shape's labels: (m,) uint16 part ids in the face order of `mesh`, 0 = unlabelled.

    model_version : of predicted and refined labels; None for those that people made.
    kind : "human" or "imported" for labels that people made, else the segmentation's name.
    revision_ids : the revision they are, what that was moved from, and so on; empty for predicted and refined labels.
    agreement : share of the area in [0, 1] that survives the way here from the mesh they were on, and back; None where
        they are as on record.
    is_in_review : they wait for someone to look at them.
    """

    shape: Shape
    mesh: Mesh
    labels: UInt16[np.ndarray, " m"]
    model_version: int | None
    kind: str
    revision_ids: tuple[int, ...] = ()
    agreement: float | None = None
    is_in_review: bool = False


@dataclass(frozen=True, slots=True)
class Unplaced:
    """A shape whose labels could not be brought to the mesh where they are wanted, and why, in one line."""

    shape: Shape
    reason: str


def place(
    workspace: Workspace, shapes: Sequence[Shape], segmentation: Segmentation, role: MeshRole
) -> Iterator[PlacedLabels | Unplaced]:
    """Those of the shapes that have such labels and such a mesh, in their order.

    On the original, labels that were given to its very faces come back as they are, as long as nobody has changed them
    since; others are mapped back. Labels that still wait to be moved to the working mesh are left out there.

    Raises
    ------
    StoreError : a store cannot be reached. A mesh that cannot be read costs only its shape.
    """
    if segmentation is Segmentation.CONFIRMED:
        yield from _confirmed(workspace, shapes, role)
    else:
        yield from _from_models(workspace, shapes, segmentation, role)


def _confirmed(workspace: Workspace, shapes: Sequence[Shape], role: MeshRole) -> Iterator[PlacedLabels | Unplaced]:
    catalog = workspace.catalog
    meshes = _meshes(workspace, shapes, role)
    heads = catalog.head_revisions([shape.id for shape in shapes], SHOWN_KINDS)
    for shape in shapes:
        head, mesh = heads.get(shape.id), meshes.get(shape.id)
        if head is None or mesh is None:
            continue
        chain = tuple(with_origins(catalog, head))
        there = next((i for i, revision in enumerate(chain) if revision.mesh_hash == mesh.mesh_hash), None)
        if there is not None:
            labels, agreement, chain = catalog.labels(chain[there].id), None, chain[there:]
        elif role is MeshRole.ORIGINAL:
            labelled = catalog.mesh(shape.id, head.mesh_hash)
            moved = _moved(workspace, shape, labelled, mesh, catalog.labels(head.id))
            if isinstance(moved, Unplaced):
                yield moved
                continue
            labels, agreement = moved.labels, moved.agreement
        else:
            continue
        is_in_review = any(
            review.outcome is None and review.revision_id == chain[0].id for review in catalog.reviews(shape.id)
        )
        ids = tuple(revision.id for revision in chain)
        yield PlacedLabels(shape, mesh, labels, None, head.kind.value, ids, agreement, is_in_review)


def _from_models(
    workspace: Workspace, shapes: Sequence[Shape], segmentation: Segmentation, role: MeshRole
) -> Iterator[PlacedLabels | Unplaced]:
    meshes = _meshes(workspace, shapes, role)
    for segmented in segment(workspace, shapes, segmentation):
        mesh = meshes.get(segmented.shape.id)
        if mesh is None:
            continue
        labels, agreement = segmented.labels, None
        if mesh.mesh_hash != segmented.mesh.mesh_hash:
            moved = _moved(workspace, segmented.shape, segmented.mesh, mesh, segmented.labels)
            if isinstance(moved, Unplaced):
                yield moved
                continue
            labels, agreement = moved.labels, moved.agreement
        yield PlacedLabels(
            segmented.shape, mesh, labels, segmented.model_version, segmentation.value, agreement=agreement
        )


def _moved(
    workspace: Workspace, shape: Shape, old_mesh: Mesh, new_mesh: Mesh, labels: UInt16[np.ndarray, " n"]
) -> MovedLabels | Unplaced:
    try:
        return compute_move(workspace.arrays, old_mesh, new_mesh, labels)
    except PartwiseError as error:
        if isinstance(error, StoreError):
            require_store(workspace.arrays)
        return Unplaced(shape, str(error))


def _meshes(workspace: Workspace, shapes: Sequence[Shape], role: MeshRole) -> dict[int, Mesh]:
    ids = [shape.id for shape in shapes]
    of_role = workspace.catalog.meshes if role is MeshRole.WORKING else workspace.catalog.original_meshes
    return dict(of_role(ids))
