"""From a field to a closed welded triangle mesh: sample near the surface, march cubes, reduce to a face count."""

from collections.abc import Callable

import numpy as np
from jaxtyping import Float, Int

from partwise.errors import DegenerateMeshError
from partwise.geometry.adjacency import edge_adjacency, edge_components, label_regions
from partwise.geometry.contouring import Field, Grid, grid_over
from partwise.geometry.contouring import contour as contour_surface
from partwise.geometry.faces import face_areas, face_centroids
from partwise.geometry.submesh import keep_faces
from partwise.mesh import TriMesh
from partwise.remesh.decimate import decimate
from partwise.simulate.primitives import Points

_STEEPNESS = 1.35  # how much faster than distance a (deformed) field may change
_N_PROBE = 40  # cells along the longest side when looking for the shape's extent


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
    """Zero surface of a blueprint's field, which deformations make steeper than a distance; see `geometry.contouring`.

    Raises
    ------
    DegenerateMeshError : the surface does not cross the grid.
    """
    return contour_surface(field, grid, _STEEPNESS)


def largest_component(mesh: TriMesh) -> tuple[TriMesh, float]:
    """The edge-connected component with most area, and its share of the whole area."""
    component = edge_components(mesh)
    area = np.bincount(component, weights=face_areas(mesh))
    keep = component == int(area.argmax())
    return keep_faces(mesh, keep), float(area.max() / area.sum())


def reduce_faces(mesh: TriMesh, n_faces: int) -> TriMesh | None:
    """The mesh with about `n_faces` faces and still a clean manifold, or None where no reducer manages that."""
    return decimate(mesh, n_faces).mesh


def smooth_labels(mesh: TriMesh, labels: Int[np.ndarray, " m"], min_share: float) -> Int[np.ndarray, " m"]:
    """Labels without islands: regions of less than `min_share` of all area take the label they share most border with.

    A region without neighbours of another label is left as it is.
    """
    labels = labels.copy()
    adjacency = edge_adjacency(mesh)
    areas = face_areas(mesh)
    for _ in range(4):
        region = label_regions(labels, adjacency.faces)
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
