"""How well labels agree with the truth, by every measure there is."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from jaxtyping import Int

from partwise.errors import NotEnoughDataError
from partwise.geometry.faces import face_areas
from partwise.mesh import TriMesh
from partwise.metrics.accuracy import accuracy, accuracy_by_area
from partwise.metrics.boundary_distance import boundary_distance
from partwise.metrics.iou import mean_iou, part_iou


@dataclass(frozen=True, slots=True)
class Agreement:
    """Of labels with the truth of one shape.

    accuracy, accuracy_by_area : shares of faces and of area that are right, in [0, 1].
    iou : by area, of each part that either names, in [0, 1]. mean_iou : over those.
    boundary_distance : in diagonals.
    """

    accuracy: float
    accuracy_by_area: float
    iou: dict[str, float]
    mean_iou: float
    boundary_distance: float


def agreement(
    mesh: TriMesh, labels: Int[np.ndarray, " m"], truth: Int[np.ndarray, " m"], part_names: Sequence[str]
) -> Agreement:
    """Labels and truth are indices into the part names, −1 where unlabelled.

    Raises
    ------
    LabelError : labels of another mesh, or that are not among the parts.
    NotEnoughDataError : nothing has a true label.
    """
    areas = face_areas(mesh)
    iou = part_iou(labels, truth, np.arange(len(part_names)), areas)
    return Agreement(
        accuracy=accuracy(labels, truth),
        accuracy_by_area=accuracy_by_area(labels, truth, areas),
        iou={name: float(value) for name, value in zip(part_names, iou, strict=True) if not np.isnan(value)},
        mean_iou=mean_iou(iou),
        boundary_distance=boundary_distance(mesh, labels, truth),
    )


def mean_agreement(agreements: Sequence[Agreement]) -> Agreement:
    """Means over shapes, each counting the same; a part's over the shapes that have it.

    Raises
    ------
    NotEnoughDataError : no shapes.
    """
    if not agreements:
        raise NotEnoughDataError("a mean needs a shape but there are none; name a folder of labelled shapes")
    of_part: dict[str, list[float]] = {}
    for each in agreements:
        for name, value in each.iou.items():
            of_part.setdefault(name, []).append(value)
    means = {
        name: float(np.mean([getattr(each, name) for each in agreements]))
        for name in ("accuracy", "accuracy_by_area", "mean_iou", "boundary_distance")
    }
    return Agreement(iou={name: float(np.mean(of_part[name])) for name in sorted(of_part)}, **means)
