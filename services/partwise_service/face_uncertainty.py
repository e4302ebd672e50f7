"""How unsure the newest model is of each face of a shape: what an annotator looks at first."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field

import numpy as np
from jaxtyping import Float32

from partwise.selection.acquisition import face_entropy
from partwise.store.records import Shape
from partwise.workspace.segmentations import EVALUATE
from partwise.workspace.workspace import Workspace


@dataclass(frozen=True, slots=True, eq=False)
class FaceUncertainty:
    """Uncertainty that is there, not yet read.

    identity : differs from that of all other uncertainty. metadata : what goes with it. read : (m,) float32, the
    entropy of a face's probabilities as a share of the largest there can be, in [0, 1].
    """

    identity: str
    read: Callable[[], Float32[np.ndarray, " m"]] = field(repr=False)
    metadata: Mapping[str, str]


def find_uncertainty(workspace: Workspace, shape: Shape) -> FaceUncertainty | None:
    """Of the shape's present mesh; None if no model has seen it."""
    run = workspace.catalog.stage_runs([shape.id], EVALUATE).get(shape.id)
    if run is None or run.block_name is None or run.row is None or run.summary["mesh_hash"] != shape.mesh_hash:
        return None
    block_name, row = run.block_name, run.row

    def read() -> Float32[np.ndarray, " m"]:
        probabilities = workspace.arrays.read(block_name, row, "probabilities")
        most = np.log(max(probabilities.shape[1], 2))  # a single part is sure, not a division by zero
        return (face_entropy(probabilities) / most).clip(0.0, 1.0).astype(np.float32)

    about = {"mesh_hash": run.summary["mesh_hash"], "model_version": str(run.summary["model_version"])}
    return FaceUncertainty(f"{EVALUATE} {run.id} {block_name} {row}", read, about)  # done again, a run keeps its id
