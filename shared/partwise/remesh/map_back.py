"""Labels across remeshing, both ways: each face takes those of the nearest surface that faces the same way.

`map_faces` finds, once, whose labels each face takes (`FaceMap`); labels are then moved as often as wanted. `map_back`
makes the two maps between an original and its remeshed surface.
"""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Bool, Int
from scipy import sparse
from scipy.spatial import cKDTree

from partwise.errors import LabelError
from partwise.geometry.adjacency import edge_adjacency
from partwise.geometry.faces import bounding_box_diagonal, face_centroids
from partwise.geometry.surface_points import SurfacePoints, surface_points
from partwise.mesh import TriMesh

_N_SOURCE_POINTS = 60_000  # a third of a per cent of the diagonal apart on a usual shape
_N_TARGET_POINTS = 20_000
_MAX_PER_FACE = 4_000

# A face at a right angle is as bad as one this share of the diagonal, times √2, farther away.
_NORMAL_WEIGHT = 0.04
# Beyond the surfaces' usual distance plus this share of the diagonal, a point has no counterpart: it is hidden inside
# the other surface, or spans a hole in it.
_REACH = 0.005
_MIN_AGREEMENT = 0.5  # cosine: 60°
_WELD = 1e-6  # of the diagonal


@dataclass(frozen=True, slots=True, eq=False)
class FaceMap:
    """Whose labels the faces of a target mesh take from a source mesh.

    point_targets, point_sources : (s,) int64, ascending in target: a point on the target's face, and the source's face
        nearest to it. Every target face has at least one.
    donors : (m,) int64, for each target face the one whose points decide for it: itself, or, where it has no
        counterpart in the source, the nearest along the surface that has one.
    is_seen : (m,) bool, faces that have a counterpart.
    n_source_faces : of the source mesh.
    """

    point_targets: Int[np.ndarray, " s"]
    point_sources: Int[np.ndarray, " s"]
    donors: Int[np.ndarray, " m"]
    is_seen: Bool[np.ndarray, " m"]
    n_source_faces: int

    def labels(self, source_labels: Int[np.ndarray, " n"]) -> Int[np.ndarray, " m"]:
        """Label of each target face, (m,) int64: what most of its points say; the smaller label on a tie.

        Raises
        ------
        LabelError : not one label for each source face.
        """
        if source_labels.shape != (self.n_source_faces,):
            raise LabelError(
                f"labels must have one entry for each of the {self.n_source_faces} source faces but have shape "
                f"{source_labels.shape}; do they belong to another mesh?"
            )
        values, index = np.unique(source_labels, return_inverse=True)
        votes = np.zeros((len(self.donors), len(values)), dtype=np.int64)
        np.add.at(votes, (self.point_targets, index.ravel()[self.point_sources]), 1)
        return values[votes.argmax(axis=1)][self.donors].astype(np.int64)

    def source_faces(self) -> Int[np.ndarray, " m"]:
        """The one source face that stands for each target face, (m,) int64: that nearest to its donor's first point."""
        first = np.searchsorted(self.point_targets, self.donors)
        return self.point_sources[first]


@dataclass(frozen=True, slots=True, eq=False)
class MapBack:
    """Both maps between an original mesh and its remeshed surface."""

    to_remeshed: FaceMap
    to_original: FaceMap


def map_back(original: TriMesh, remeshed: TriMesh, *, is_original_oriented: bool = False) -> MapBack:
    """Maps both ways. Where the original's faces are known to look outwards, both sides of a sheet are told apart."""
    return MapBack(
        to_remeshed=map_faces(original, remeshed, is_oriented=is_original_oriented),
        to_original=map_faces(remeshed, original, is_oriented=is_original_oriented),
    )


def map_faces(source: TriMesh, target: TriMesh, *, is_oriented: bool) -> FaceMap:
    """For points on the target's faces, the source's face that is nearest and faces the same way.

    Near means the least |p − p'|² + w²·|n − n'|², w being 4 % of the diagonal, so that a wall's points are not given to
    the floor it stands on. Points without a counterpart have no vote; faces without such points take their label along
    their own surface, or, where none of their component's faces has a counterpart, from the nearest after all.

    Parameters
    ----------
    source, target : in the same coordinates.
    is_oriented : whether both meshes' faces look outwards; if not, n and −n are the same.
    """
    diagonal = bounding_box_diagonal(source)
    given = surface_points(source, _N_SOURCE_POINTS, _MAX_PER_FACE)
    asked = surface_points(target, _N_TARGET_POINTS, _MAX_PER_FACE)
    nearest = _nearest(given, asked, _NORMAL_WEIGHT * diagonal, is_oriented)
    distances = np.linalg.norm(given.points[nearest] - asked.points, axis=1)
    cosines = np.einsum("ij,ij->i", given.normals[nearest], asked.normals)
    agreement = cosines if is_oriented else np.abs(cosines)
    has_counterpart = (distances <= np.median(distances) + _REACH * diagonal) & (agreement >= _MIN_AGREEMENT)
    is_seen = np.zeros(target.n_faces, dtype=bool)
    is_seen[asked.faces[has_counterpart]] = True
    votes = has_counterpart | ~is_seen[asked.faces]
    return FaceMap(
        point_targets=asked.faces[votes],
        point_sources=given.faces[nearest[votes]],
        donors=_donors(target, is_seen),
        is_seen=is_seen,
        n_source_faces=source.n_faces,
    )


def _nearest(given: SurfacePoints, asked: SurfacePoints, normal_weight: float, is_oriented: bool) -> np.ndarray:
    """Index of the given point nearest to each asked one in position and normal together."""
    near = np.hstack([given.points, normal_weight * given.normals])
    if not is_oriented:
        near = np.concatenate([near, np.hstack([given.points, -normal_weight * given.normals])])
    index = cKDTree(near).query(np.hstack([asked.points, normal_weight * asked.normals]))[1]
    return np.asarray(index % len(given.faces))


def _donors(mesh: TriMesh, is_seen: np.ndarray) -> np.ndarray:
    """For each face the nearest seen one along the surface; itself where it is seen or nothing seen can be reached."""
    itself = np.arange(mesh.n_faces)
    if is_seen.all() or not is_seen.any():
        return itself
    pairs = edge_adjacency(_welded(mesh)).faces
    centroids = face_centroids(mesh)
    # A length of 0 would be no edge to the sparse graph.
    lengths = np.linalg.norm(centroids[pairs[:, 0]] - centroids[pairs[:, 1]], axis=1) + 1e-12
    graph = sparse.csr_array((lengths, (pairs[:, 0], pairs[:, 1])), shape=(mesh.n_faces,) * 2)
    _, _, source = sparse.csgraph.dijkstra(
        graph, directed=False, indices=np.flatnonzero(is_seen), return_predecessors=True, min_only=True
    )
    return np.where(source >= 0, source, itself).astype(np.int64)


def _welded(mesh: TriMesh) -> TriMesh:
    """The same faces, on one vertex for all that lie at one place: soups are often unwelded."""
    cells = np.rint(mesh.vertices / max(_WELD * bounding_box_diagonal(mesh), np.finfo(np.float64).tiny))
    place = np.unique(cells, axis=0, return_inverse=True)[1].ravel()
    return TriMesh(mesh.vertices, place[mesh.faces])
