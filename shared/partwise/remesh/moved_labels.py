"""Labels of one mesh of a shape moved to another, and how well that went."""

from dataclasses import dataclass

import numpy as np
from jaxtyping import UInt16

from partwise.errors import LabelError
from partwise.geometry.faces import face_areas
from partwise.mesh import TriMesh
from partwise.remesh.accept_as_is import defects_of
from partwise.remesh.map_back import map_back
from partwise.unlabelled import NO_PART_ID


@dataclass(frozen=True, slots=True, eq=False)
class MovedLabels:
    """Part ids on the new mesh, (m,) uint16, 0 = unlabelled.

    agreement : share of the old mesh's labelled area in [0, 1] whose label survives from there to the new mesh and
        back; 1 where nothing is labelled.
    """

    labels: UInt16[np.ndarray, " m"]
    agreement: float


def moved_labels(old_mesh: TriMesh, new_mesh: TriMesh, labels: UInt16[np.ndarray, " n"]) -> MovedLabels:
    """Each face of the new mesh takes the label of the nearest surface of the old one that faces the same way.

    Parameters
    ----------
    old_mesh, new_mesh : of one shape, in the same coordinates. Where both are closed and look outwards, the two sides
        of a thin wall are told apart.
    labels : (n,) part ids of the old mesh's faces, 0 = unlabelled.

    Raises
    ------
    LabelError : not one label for each of the old mesh's faces.
    """
    if labels.shape != (old_mesh.n_faces,):
        raise LabelError(
            f"labels must have one entry for each of the {old_mesh.n_faces} faces but have shape {labels.shape}; "
            "do they belong to another mesh?"
        )
    is_oriented = defects_of(old_mesh) is None and defects_of(new_mesh) is None
    maps = map_back(old_mesh, new_mesh, is_original_oriented=is_oriented)
    moved = maps.to_remeshed.labels(labels.astype(np.int64))
    returned = maps.to_original.labels(moved)
    areas = np.where(labels == NO_PART_ID, 0.0, face_areas(old_mesh))
    total = areas.sum()
    agreement = float(areas[returned == labels].sum() / total) if total > 0 else 1.0
    return MovedLabels(moved.astype(np.uint16), min(1.0, agreement))  # sums differ in the last digit
