"""Which labels of a shape are shown, what they are told apart by, and reading them."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field

import numpy as np
from jaxtyping import UInt16

from partwise.errors import NotFoundError
from partwise.store.catalog import SHOWN_KINDS
from partwise.store.records import LabelRevision, Shape
from partwise.workspace.segmentations import EVALUATE, REFINE, Segmentation, segment
from partwise.workspace.workspace import Workspace


@dataclass(frozen=True, slots=True, eq=False)
class ShownLabels:
    """Labels that are there, not yet read.

    identity : differs from that of all other labels. metadata : what goes with them. read : (m,) uint16 part ids.
    """

    mesh_hash: str
    identity: str
    read: Callable[[], UInt16[np.ndarray, " m"]] = field(repr=False)
    metadata: Mapping[str, str] = field(default_factory=dict)


def shown_labels(workspace: Workspace, shape: Shape, segmentation: Segmentation) -> ShownLabels | None:
    """The shape's labels of this segmentation on its present mesh; None if there are none."""
    if segmentation is Segmentation.CONFIRMED:
        head = workspace.catalog.head_revision(shape.id)
        return None if head is None or head.mesh_hash != shape.mesh_hash else _of_revision(workspace, head)
    stage = EVALUATE if segmentation is Segmentation.PREDICTED else REFINE
    run = workspace.catalog.stage_runs([shape.id], stage).get(shape.id)
    if run is None or run.summary["mesh_hash"] != shape.mesh_hash:
        return None

    def read() -> UInt16[np.ndarray, " m"]:
        for found in segment(workspace, [shape], segmentation):
            return found.labels
        raise NotFoundError(f"shape {shape.id} has no {segmentation.value} labels any more; ask again")

    about = {"mesh_hash": run.summary["mesh_hash"], "model_version": str(run.summary["model_version"])}
    identity = f"{stage} {run.id} {run.block_name} {run.row}"  # a run that is done again keeps its id
    return ShownLabels(run.summary["mesh_hash"], identity, read, about)


def labels_of_revision(workspace: Workspace, shape: Shape, revision_id: int) -> ShownLabels:
    """The labels of one of the shape's revisions.

    Raises
    ------
    NotFoundError : it has no such revision, or none that may be shown.
    """
    for revision in workspace.catalog.revisions(shape.id):
        if revision.id == revision_id and revision.kind in SHOWN_KINDS:
            return _of_revision(workspace, revision)
    raise NotFoundError(f"shape {shape.id} has no revision {revision_id}; see /shapes/{shape.id}/revisions")


def _of_revision(workspace: Workspace, revision: LabelRevision) -> ShownLabels:
    about = {
        "mesh_hash": revision.mesh_hash,
        "revision_id": str(revision.id),
        "schema_version": str(revision.schema_version),
    }
    return ShownLabels(
        revision.mesh_hash, f"revision {revision.id}", lambda: workspace.catalog.labels(revision.id), about
    )
