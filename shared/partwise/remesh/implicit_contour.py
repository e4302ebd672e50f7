"""The surface at a fixed distance from any polygon soup, contoured on a grid: for shapes that no wrap fits."""

import igl
import numpy as np

from partwise.errors import DegenerateMeshError
from partwise.geometry.contouring import contour, grid_over
from partwise.mesh import TriMesh
from partwise.remesh.parameters import ImplicitContour


def implicit_contour(mesh: TriMesh, parameters: ImplicitContour) -> TriMesh:
    """All points `offset_cells` away from the mesh: closed, oriented outwards, with a component for every cavity too.

    Raises
    ------
    DegenerateMeshError : the mesh has no extent.

    Source: George, Xie, Lai, Tam 2018 (unsigned distance on a grid). Differs: sampled near the surface only.
    """
    used = mesh.vertices[np.unique(mesh.faces)]
    bounds = np.stack([used.min(axis=0), used.max(axis=0)])
    longest = float((bounds[1] - bounds[0]).max())
    if not longest > 0:
        raise DegenerateMeshError("a mesh must have extent to be contoured but is one point; check the export's scale")
    spacing = longest / parameters.n_cells
    offset = parameters.offset_cells * spacing
    tree = igl.AABB()
    tree.init(mesh.vertices, mesh.faces)

    def distance_beyond_offset(points: np.ndarray) -> np.ndarray:
        squared = tree.squared_distance(mesh.vertices, mesh.faces, np.ascontiguousarray(points))[0]
        return np.sqrt(squared) - offset

    return contour(distance_beyond_offset, grid_over(bounds + np.array([[-offset], [offset]]), spacing), steepness=1.0)
