"""How far two labellings' boundaries lie apart."""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Bool, Float, Int
from scipy.spatial import cKDTree

from partwise.errors import DegenerateMeshError, LabelError
from partwise.geometry.adjacency import EdgeAdjacency, edge_adjacency
from partwise.geometry.faces import bounding_box_diagonal
from partwise.mesh import TriMesh
from partwise.unlabelled import NO_CLASS

FARTHEST = 1.0
"""Distance where only one of the two has a boundary: a whole diagonal, beyond which nothing on the mesh can lie."""


@dataclass(frozen=True, slots=True, eq=False)
class _Boundary:
    """starts, ends : (b, 3) float64, the boundary's edges as segments."""

    starts: Float[np.ndarray, "b 3"]
    ends: Float[np.ndarray, "b 3"]

    @property
    def midpoints(self) -> Float[np.ndarray, "b 3"]:
        return (self.starts + self.ends) / 2

    @property
    def lengths(self) -> Float[np.ndarray, " b"]:
        return np.linalg.norm(self.ends - self.starts, axis=1)


def boundary_distance(mesh: TriMesh, predicted: Int[np.ndarray, " m"], truth: Int[np.ndarray, " m"]) -> float:
    """Mean of two directed distances, as a fraction of the bounding box's diagonal, in [0, 1].

    A directed distance is the mean, weighted by length, over one labelling's boundary edges, of the Euclidean distance
    from the edge's midpoint to the nearest point on a boundary edge of the other. It asks where boundaries are, not
    which parts they separate. Edges of a face whose truth is −1 count for neither; a predicted −1 is a label like any.
    Without a boundary in either labelling it is 0; without one in exactly one it is 1. Edges without
    length count for neither.

    Raises
    ------
    LabelError : not one label per face.
    DegenerateMeshError : the mesh is a single point.

    Source: cut discrepancy, Chen, Golovinskiy, Funkhouser 2009. Differs: straight instead of along the surface, and in
    units of the diagonal instead of the mean radius.
    """
    for name, labels in (("predicted", predicted), ("truth", truth)):
        if labels.shape != (mesh.n_faces,):
            raise LabelError(f"{name} must be ({mesh.n_faces},) but is {labels.shape}; are they another mesh's labels?")
    diagonal = bounding_box_diagonal(mesh)
    if not diagonal > 0:
        raise DegenerateMeshError("boundary distance needs a mesh with extent but it is a single point; drop the shape")
    adjacency = edge_adjacency(mesh)
    counted = (truth[adjacency.faces] != NO_CLASS).all(axis=1) & (adjacency.lengths > 0)
    first, second = (_boundary(mesh, adjacency, labels, counted) for labels in (predicted, truth))
    if not len(first.starts) or not len(second.starts):
        return 0.0 if len(first.starts) == len(second.starts) else FARTHEST
    return (_directed(first, second) + _directed(second, first)) / (2 * diagonal)


def _boundary(
    mesh: TriMesh, adjacency: EdgeAdjacency, labels: Int[np.ndarray, " m"], counted: Bool[np.ndarray, " k"]
) -> _Boundary:
    is_cut = counted & (labels[adjacency.faces[:, 0]] != labels[adjacency.faces[:, 1]])
    ends = mesh.vertices[adjacency.edges[is_cut]]
    return _Boundary(ends[:, 0], ends[:, 1])


def _directed(source: _Boundary, target: _Boundary) -> float:
    """Mean distance from the source's midpoints to the target's segments, model units."""
    points, tree = source.midpoints, cKDTree(target.midpoints)
    to_midpoint = tree.query(points)[0]
    # A segment nearer than the nearest midpoint has its own midpoint at most half its length farther off.
    reach = (to_midpoint + target.lengths.max() / 2) * (1 + 1e-9)
    candidates = tree.query_ball_point(points, reach)
    owner = np.repeat(np.arange(len(points)), [len(found) for found in candidates])
    segment = np.concatenate([np.asarray(found, dtype=np.int64) for found in candidates])
    distance = np.full(len(points), np.inf)
    np.minimum.at(distance, owner, _to_segments(points[owner], target.starts[segment], target.ends[segment]))
    return float(np.average(distance, weights=source.lengths))


def _to_segments(
    points: Float[np.ndarray, "c 3"], starts: Float[np.ndarray, "c 3"], ends: Float[np.ndarray, "c 3"]
) -> Float[np.ndarray, " c"]:
    """Distance of each point from the segment in the same row."""
    along = ends - starts
    share = np.einsum("ij,ij->i", points - starts, along) / np.einsum("ij,ij->i", along, along)
    return np.linalg.norm(points - starts - np.clip(share, 0.0, 1.0)[:, None] * along, axis=1)
