"""From a field to a closed welded triangle mesh: sample near the surface, march cubes, reduce to a face count."""

import logging
from collections.abc import Callable
from dataclasses import dataclass
from typing import TypeAlias

import fast_simplification
import igl
import numpy as np
import pymeshlab
from jaxtyping import Float, Int
from scipy import sparse

from partwise.errors import DegenerateMeshError
from partwise.geometry.adjacency import edge_adjacency, edge_components
from partwise.geometry.faces import face_areas, face_centroids
from partwise.geometry.manifold import manifold_report
from partwise.mesh import TriMesh
from partwise.simulate.primitives import Distances, Points

_log = logging.getLogger(__name__)

Field: TypeAlias = Callable[[Points], Distances]

_BLOCK = 4  # grid points along a block's side
_STEEPNESS = 1.35  # how much faster than distance a (deformed) field may change
_N_PROBE = 40  # cells along the longest side when looking for the shape's extent
_CUBE = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [0, 0, 1], [1, 0, 1], [1, 1, 1], [0, 1, 1]])


@dataclass(frozen=True, slots=True, eq=False)
class Grid:
    """Cubic lattice: `origin` (3,) and `spacing` in model units, `n_blocks` (3,) blocks of 4×4×4 points."""

    origin: Float[np.ndarray, "3"]
    spacing: float
    n_blocks: Int[np.ndarray, "3"]

    @property
    def shape(self) -> tuple[int, int, int]:
        x, y, z = (int(n) * _BLOCK for n in self.n_blocks)
        return (x, y, z)


def grid_over(bounds: Float[np.ndarray, "2 3"], spacing: float) -> Grid:
    """The grid with one cell of room around the box (low, high)."""
    n_points = np.ceil((bounds[1] - bounds[0]) / spacing).astype(np.int64) + 4
    return Grid(bounds[0] - 1.5 * spacing, spacing, -(-n_points // _BLOCK))


def tight_bounds(field: Field, loose: Float[np.ndarray, "2 3"]) -> Float[np.ndarray, "2 3"]:
    """A box (low, high) inside the loose one that still holds everything the field calls inside.

    Raises
    ------
    DegenerateMeshError : the field is nowhere near negative.
    """
    spacing = float((loose[1] - loose[0]).max()) / _N_PROBE
    grid = grid_over(loose, spacing)
    index = np.indices(grid.shape).reshape(3, -1).T
    points = grid.origin + index * spacing
    near = points[field(points) < _STEEPNESS * spacing * np.sqrt(3.0) / 2.0]
    if len(near) == 0:
        raise DegenerateMeshError("a field must be negative somewhere but this one is not; is the blueprint empty?")
    return np.array([near.min(axis=0) - spacing / 2.0, near.max(axis=0) + spacing / 2.0])


def contour(field: Field, grid: Grid) -> TriMesh:
    """Zero surface of the field on the grid: welded, oriented outwards, closed where it does not leave the grid.

    The field is sampled only in blocks that the surface may cross. Values are kept off zero, so no face is degenerate.

    Raises
    ------
    DegenerateMeshError : the surface does not cross the grid.

    Source: Lorensen & Cline 1987 (libigl's).
    """
    values = _sample(field, grid)
    inside = values < 0.0
    corners = [inside[tuple(slice(o, n - 1 + o) for o, n in zip(c, grid.shape, strict=True))] for c in _CUBE]
    n_inside = np.sum(corners, axis=0, dtype=np.int8)
    cells = np.argwhere((n_inside > 0) & (n_inside < 8))
    if len(cells) == 0:
        raise DegenerateMeshError(
            f"the surface does not cross a grid of spacing {grid.spacing:.4g}; is the shape thinner than that?"
        )
    corner_index = np.ravel_multi_index(tuple((cells[:, None, :] + _CUBE).reshape(-1, 3).T), grid.shape)
    used, compact = np.unique(corner_index, return_inverse=True)
    points = grid.origin + np.stack(np.unravel_index(used, grid.shape), axis=1) * grid.spacing
    vertices, faces, _ = igl.marching_cubes(values.ravel()[used], points, compact.reshape(-1, 8).astype(np.int64), 0.0)
    return TriMesh(vertices, faces)


def largest_component(mesh: TriMesh) -> tuple[TriMesh, float]:
    """The edge-connected component with most area, and its share of the whole area."""
    component = edge_components(mesh)
    area = np.bincount(component, weights=face_areas(mesh))
    keep = component == int(area.argmax())
    return _keep_faces(mesh, keep), float(area.max() / area.sum())


def reduce_faces(mesh: TriMesh, n_faces: int) -> TriMesh | None:
    """The mesh with `n_faces` faces and still a clean manifold, or None where neither reducer manages that.

    A few more faces are left where fewer cannot carry the surface's handles.

    Source: Garland & Heckbert 1997 (fast-simplification's, else MeshLab's with its test of topology).
    """
    # Each aggressiveness breaks other meshes, so several quick tries come before the slow reducer.
    for aggressiveness in (4.0, 5.5, 3.0, 7.0):
        reduced = _reduce_fast(mesh, n_faces, aggressiveness)
        if manifold_report(reduced).is_clean:
            return reduced
        _log.debug("reduction broke the mesh", extra={"aggressiveness": aggressiveness})
    reduced = _reduce_keeping_topology(mesh, n_faces)
    return reduced if manifold_report(reduced).is_clean else None


def smooth_labels(mesh: TriMesh, labels: Int[np.ndarray, " m"], min_share: float) -> Int[np.ndarray, " m"]:
    """Labels without islands: regions of less than `min_share` of all area take the label they share most border with.

    A region without neighbours of another label is left as it is.
    """
    labels = labels.copy()
    adjacency = edge_adjacency(mesh)
    areas = face_areas(mesh)
    for _ in range(4):
        region = _label_regions(labels, adjacency.faces)
        share = np.bincount(region, weights=areas) / areas.sum()
        a, b = region[adjacency.faces].T
        label_of = np.zeros(len(share), dtype=np.int64)
        label_of[region] = labels
        small = share < min_share
        if not small.any() or len(share) == 1:
            break
        border = np.zeros((len(share), int(labels.max()) + 1))
        for inner, outer in ((a, b), (b, a)):
            differs = label_of[inner] != label_of[outer]
            # Large neighbours only, so that two islands do not swap labels for ever.
            counts = differs & ~small[outer]
            np.add.at(border, (inner[counts], label_of[outer[counts]]), adjacency.lengths[counts])
        change = small & (border.sum(axis=1) > 0)
        label_of[change] = border[change].argmax(axis=1)
        labels = label_of[region]
    return labels


def label_by_nearest(
    mesh: TriMesh, nearest: Callable[[Points], Int[np.ndarray, " n"]], part_of_piece: Int[np.ndarray, " k"]
) -> Int[np.ndarray, " m"]:
    """Part index of each face: that of the piece nearest to its centroid, (m,) int64."""
    return part_of_piece[nearest(face_centroids(mesh))]


def _sample(field: Field, grid: Grid) -> np.ndarray:
    """Field on all grid points; in blocks that the surface cannot cross, the value at the block's centre."""
    h = grid.spacing
    block = np.indices(tuple(grid.n_blocks)).reshape(3, -1).T
    at_centre = field(grid.origin + (block * _BLOCK + (_BLOCK - 1) / 2.0) * h)
    reach = _STEEPNESS * h * np.sqrt(3.0) * ((_BLOCK - 1) / 2.0 + 1.0)
    active = block[np.abs(at_centre) <= reach]
    values = np.broadcast_to(
        at_centre.reshape(*grid.n_blocks)[:, None, :, None, :, None],
        (grid.n_blocks[0], _BLOCK, grid.n_blocks[1], _BLOCK, grid.n_blocks[2], _BLOCK),
    ).copy()
    within = np.indices((_BLOCK,) * 3).reshape(3, -1).T
    index = (active[:, None, :] * _BLOCK + within).reshape(-1, 3)
    fine = field(grid.origin + index * h)
    floor = 0.02 * h
    fine = np.where(np.abs(fine) < floor, np.where(fine < 0.0, -floor, floor), fine)
    values = values.reshape(grid.shape)
    values[tuple(index.T)] = fine
    return values


def _keep_faces(mesh: TriMesh, keep: np.ndarray) -> TriMesh:
    used, faces = np.unique(mesh.faces[keep], return_inverse=True)
    return TriMesh(mesh.vertices[used], faces.reshape(-1, 3))


def _reduce_fast(mesh: TriMesh, n_faces: int, aggressiveness: float) -> TriMesh:
    vertices, faces = fast_simplification.simplify(
        mesh.vertices.copy(), mesh.faces.copy(), target_count=n_faces, agg=aggressiveness
    )[:2]
    return _keep_faces(TriMesh(vertices, faces), np.ones(len(faces), dtype=bool))


def _reduce_keeping_topology(mesh: TriMesh, n_faces: int) -> TriMesh:
    meshes = pymeshlab.MeshSet()
    meshes.add_mesh(pymeshlab.Mesh(mesh.vertices, mesh.faces))
    meshes.meshing_decimation_quadric_edge_collapse(targetfacenum=n_faces, preservetopology=True, preservenormal=True)
    reduced = meshes.current_mesh()
    return TriMesh(reduced.vertex_matrix(), reduced.face_matrix().astype(np.int64))


def _label_regions(labels: np.ndarray, pairs: np.ndarray) -> np.ndarray:
    same = pairs[labels[pairs[:, 0]] == labels[pairs[:, 1]]]
    graph = sparse.coo_array((np.ones(len(same), dtype=bool), (same[:, 0], same[:, 1])), shape=(len(labels),) * 2)
    return sparse.csgraph.connected_components(graph, directed=False)[1].astype(np.int64)
