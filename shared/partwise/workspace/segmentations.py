"""The labels of a shape by where they come from: confirmed by people, refined by the cut, predicted by the model."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np
from jaxtyping import UInt16

from partwise.store.catalog import SHOWN_KINDS
from partwise.store.records import Collection, Mesh, RevisionKind, Shape
from partwise.workspace.choices import Segmentation as Segmentation
from partwise.workspace.relabel import MIN_AGREEMENT
from partwise.workspace.shapes import pages_of_shapes
from partwise.workspace.workspace import Workspace

MESH, REMESH, DESCRIBE, PICTURE, EVALUATE, REFINE = "mesh", "remesh", "describe", "picture", "evaluate", "refine"
"""Names of the stages on record."""


@dataclass(frozen=True, slots=True, eq=False)
class SegmentedShape:
    """A shape's labels: (m,) uint16 part ids in the face order of `mesh`, 0 = unlabelled.

    model_version : of predicted and refined labels; None for those that people made.
    """

    shape: Shape
    mesh: Mesh
    labels: UInt16[np.ndarray, " m"]
    model_version: int | None


def segmented_shapes(
    workspace: Workspace, collection: Collection, segmentation: Segmentation
) -> Iterator[SegmentedShape]:
    """Every shape of the collection that has such labels, by id."""
    for page in pages_of_shapes(workspace.catalog, collection.id):
        yield from segment(workspace, page, segmentation)


def segment(workspace: Workspace, shapes: Sequence[Shape], segmentation: Segmentation) -> Iterator[SegmentedShape]:
    """Those of the given shapes that have such labels on their present mesh, in their order."""
    catalog, ids = workspace.catalog, [shape.id for shape in shapes]
    meshes = catalog.meshes(ids)
    if segmentation is Segmentation.CONFIRMED:
        heads = catalog.head_revisions(ids, SHOWN_KINDS)
        for shape in shapes:
            head, mesh = heads.get(shape.id), meshes.get(shape.id)
            if head is not None and mesh is not None and head.mesh_hash == mesh.mesh_hash:
                yield SegmentedShape(shape, mesh, catalog.labels(head.id), None)
        return
    runs = catalog.stage_runs(ids, EVALUATE if segmentation is Segmentation.PREDICTED else REFINE)
    for shape in shapes:
        run, mesh = runs.get(shape.id), meshes.get(shape.id)
        if run is None or mesh is None or run.block_name is None or run.row is None:
            continue
        if run.summary["mesh_hash"] == mesh.mesh_hash:  # else predicted before the shape got this mesh
            labels = _labels_of_run(workspace, run.block_name, run.row, segmentation)
            yield SegmentedShape(shape, mesh, labels, run.summary["model_version"])


def reference_labels(workspace: Workspace, mesh: Mesh) -> UInt16[np.ndarray, " m"] | None:
    """Ground truth on this very mesh, for experiments; None if there is none. Never trained on, never shown.

    Ground truth that was moved to this mesh and suffered on the way is none: what differs may be its own error.
    """
    head = workspace.catalog.head_revision(mesh.shape_id, (RevisionKind.REFERENCE,))
    if head is None or head.mesh_hash != mesh.mesh_hash:
        return None
    has_suffered = head.origin is not None and head.origin.agreement < MIN_AGREEMENT
    return None if has_suffered else workspace.catalog.labels(head.id)


def _labels_of_run(
    workspace: Workspace, block_name: str, row: int, segmentation: Segmentation
) -> UInt16[np.ndarray, " m"]:
    if segmentation is Segmentation.REFINED:
        return workspace.arrays.read(block_name, row, "labels")
    arrays = workspace.arrays.read_many(block_name, row, ("probabilities", "part_ids"))
    return arrays["part_ids"][np.argmax(arrays["probabilities"], axis=1)]
