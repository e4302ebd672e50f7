"""Brings every shape to one size and place, so that descriptors compare."""

import numpy as np

from partwise.errors import DegenerateMeshError
from partwise.geometry.faces import face_areas, face_centroids
from partwise.mesh import TriMesh

CENTROID_DISTANCE_PERCENTILE = 33.0
NORMALISED_DISTANCE = 0.5


def normalise(mesh: TriMesh) -> TriMesh:
    """Centred at the area-weighted centroid; 33rd percentile of the faces' centroid distance scaled to 0.5.

    Rotation is left alone. Idempotent up to rounding.

    Raises
    ------
    DegenerateMeshError : the mesh has no area, or no extent.

    Source: Kalogerakis, Hertzmann, Singh 2010.
    """
    areas = face_areas(mesh)
    total = float(areas.sum())
    if not total > 0:
        raise DegenerateMeshError("a mesh must have area but all its faces are degenerate; check the export's scale")
    centroids = face_centroids(mesh)
    centre = areas @ centroids / total
    distance = np.percentile(np.linalg.norm(centroids - centre, axis=1), CENTROID_DISTANCE_PERCENTILE)
    if not distance > 0:
        raise DegenerateMeshError("a mesh must have extent but its faces lie at one point; check the export's scale")
    return TriMesh((mesh.vertices - centre) * (NORMALISED_DISTANCE / distance), mesh.faces)
