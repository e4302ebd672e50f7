"""Segment-wide: the connected region of equal label around a face."""

import numpy as np
from jaxtyping import Int, Integer

from partwise.errors import LabelError
from partwise.segmentation.face_graph import FaceGraph


def region_of(graph: FaceGraph, labels: Integer[np.ndarray, " m"], seed: int) -> Int[np.ndarray, " r"]:
    """Faces joined to `seed` across edges through faces of its label, ascending; the seed among them.

    Unlabelled is a label like any other here, so that one click fills a grey region.

    Raises
    ------
    LabelError : not one label per face.
    ParameterError : the seed is outside the mesh.
    """
    if labels.shape != (graph.n_faces,):
        raise LabelError(
            f"there must be one label per face but there are {labels.shape} labels for {graph.n_faces} faces; "
            "do they belong to another mesh?"
        )
    graph.check_face(seed)
    label = labels[seed]
    return graph.grown(seed, lambda faces: labels[faces] == label)
