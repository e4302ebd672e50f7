"""How right labels are where ground truth is on record."""

from dataclasses import dataclass

import numpy as np

from partwise.geometry.faces import face_areas
from partwise.metrics.accuracy import accuracy, accuracy_by_area
from partwise.store.records import Collection, Shape
from partwise.unlabelled import NO_CLASS, NO_PART_ID
from partwise.workspace.segmentations import Segmentation, reference_labels, segmented_shapes
from partwise.workspace.shapes import load_mesh
from partwise.workspace.workspace import Workspace


@dataclass(frozen=True, slots=True)
class ShapeAccuracy:
    """Shares in [0, 1] of a shape's faces and of its area whose label is the true one."""

    shape: Shape
    by_face: float
    by_area: float


def assess(workspace: Workspace, collection: Collection, segmentation: Segmentation) -> list[ShapeAccuracy]:
    """Every shape that has such labels and ground truth on the same mesh (see `reference_labels`), by id."""
    assessed = []
    for segmented in segmented_shapes(workspace, collection, segmentation):
        truth = reference_labels(workspace, segmented.mesh)
        if truth is None or not truth.any():
            continue
        labels, true_labels = (
            np.where(ids == NO_PART_ID, NO_CLASS, ids.astype(np.int64)) for ids in (segmented.labels, truth)
        )
        areas = face_areas(load_mesh(workspace, segmented.mesh))
        assessed.append(
            ShapeAccuracy(segmented.shape, accuracy(labels, true_labels), accuracy_by_area(labels, true_labels, areas))
        )
    return assessed
