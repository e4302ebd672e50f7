"""Faces spread evenly over a surface, each speaking for the faces nearest to it."""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float, Int

from partwise.errors import ParameterError
from partwise.geometry.faces import face_areas, face_centroids
from partwise.geometry.geodesics import FaceGraph
from partwise.geometry.kernels import geodesics as kernels
from partwise.mesh import TriMesh


@dataclass(frozen=True, slots=True, eq=False)
class FaceSample:
    """Sampled faces and their Voronoi cells, grouped by component; within one, neighbours in the list lie close.

    faces : (t,) int64, distinct faces of positive area.
    component_starts : (c + 1,) int64; faces[component_starts[c] : component_starts[c + 1]] lie in component c.
    cell : (m,) int64, each face's nearest sample as an index into `faces`; −1 in a component without samples.
    areas : (t,) float64, area of each cell in squared model units.
    n_cell_faces : (t,) int64, faces in each cell.
    """

    faces: Int[np.ndarray, " t"]
    component_starts: Int[np.ndarray, " c_1"]
    cell: Int[np.ndarray, " m"]
    areas: Float[np.ndarray, " t"]
    n_cell_faces: Int[np.ndarray, " t"]


def farthest_point_faces(mesh: TriMesh, graph: FaceGraph, n_per_component: int) -> FaceSample:
    """Up to `n_per_component` faces of each connected component, farthest point first chosen, and their cells.

    Starts at each component's first face that has area. A component has fewer where it has fewer faces of positive
    area, none where all its faces are degenerate. Distances are geodesic.

    Raises
    ------
    ParameterError : n_per_component is not positive.

    Source: Eldar et al. 1997. Differs: per component, so that scraps cannot take the samples of the main body.
    """
    if n_per_component < 1:
        raise ParameterError(f"n_per_component must be at least 1 but is {n_per_component}; ask for one or more")
    areas = face_areas(mesh)
    n_components = int(graph.component.max()) + 1
    candidates = np.argsort(graph.component, kind="stable")
    candidates = candidates[areas[candidates] > 0]
    per_component = np.bincount(graph.component[candidates], minlength=n_components)
    faces, n_chosen, cell = kernels.farthest_points(
        graph.starts, graph.neighbours, graph.lengths, candidates, _starts(per_component), n_per_component
    )
    order = np.lexsort((_morton_codes(face_centroids(mesh)[faces]), graph.component[faces]))
    rank = np.empty(len(faces) + 1, dtype=np.int64)
    rank[order] = np.arange(len(faces))
    rank[-1] = -1
    cell = rank[cell[: mesh.n_faces]]
    owned = cell >= 0
    return FaceSample(
        faces=faces[order],
        component_starts=_starts(n_chosen),
        cell=cell,
        areas=np.bincount(cell[owned], weights=areas[owned], minlength=len(faces)).astype(np.float64),
        n_cell_faces=np.bincount(cell[owned], minlength=len(faces)),
    )


def _starts(counts: np.ndarray) -> np.ndarray:
    return np.concatenate([[0], np.cumsum(counts)]).astype(np.int64)


def _morton_codes(points: np.ndarray) -> np.ndarray:
    """Position along a Z-order curve of 1024³ cells: points with near codes are near."""
    if len(points) == 0:
        return np.zeros(0, dtype=np.int64)
    low = points.min(axis=0)
    extent = max(float((points - low).max()), np.finfo(np.float64).tiny)
    cells = ((points - low) / extent * 1023).astype(np.int64)
    code = np.zeros(len(points), dtype=np.int64)
    for bit in range(10):
        for axis in range(3):
            code |= ((cells[:, axis] >> bit) & 1) << (3 * bit + axis)
    return code
