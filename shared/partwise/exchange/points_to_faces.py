"""Labels from points to the faces of the mesh that they lie on: an area-sampled vote of the nearest points."""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float, Int
from scipy.spatial import cKDTree

from partwise.errors import LabelError, ParameterError
from partwise.exchange.labelled_points import LabelledPoints
from partwise.geometry.faces import bounding_box_diagonal
from partwise.geometry.surface_points import surface_points
from partwise.mesh import TriMesh
from partwise.remesh.map_back import FaceMap
from partwise.unlabelled import NO_CLASS

_N_SAMPLES = 20_000
_MAX_PER_FACE = 4_000
_NORMAL_WEIGHT = 0.04  # of the diagonal, as where labels move between meshes


@dataclass(frozen=True, slots=True)
class PointTransfer:
    """How labels move.

    n_neighbours : points that vote for each sample of a face, 1 or more; more forgives stray labels, 1 keeps edges
        sharper.
    max_distance : the 95th percentile of the points' distance to the mesh, as a share of its diagonal, above which the
        points are refused as another shape's.
    reach : samples farther from every point than this many times the points' usual distance from each other have no
        vote, and faces without a vote stay unlabelled.
    fit_box : move and scale the points so that their bounding box has the mesh's centre and diagonal: ShapeNetPart's
        points are normalised, their meshes are not.
    """

    n_neighbours: int = 1
    max_distance: float = 0.02
    reach: float = 8.0
    fit_box: bool = False

    def __post_init__(self) -> None:
        if self.n_neighbours < 1:
            raise ParameterError(f"n_neighbours must be at least 1 but is {self.n_neighbours}; raise it")
        for name in ("max_distance", "reach"):
            if not getattr(self, name) > 0:
                raise ParameterError(f"{name} must be positive but is {getattr(self, name)}; raise it")


_DEFAULT_TRANSFER = PointTransfer()


def face_labels_from_points(
    points: LabelledPoints, mesh: TriMesh, transfer: PointTransfer = _DEFAULT_TRANSFER
) -> Int[np.ndarray, " m"]:
    """Label of each face, (m,) int64: what most of its samples' nearest points say; −1 where none is near.

    Near means position and, where points have normals, direction (n and −n alike), as in `partwise.remesh.map_back`.

    Raises
    ------
    LabelError : the points do not lie on the mesh.
    """
    positions = _on_box_of(mesh, points.points) if transfer.fit_box else points.points
    samples = surface_points(mesh, _N_SAMPLES, _MAX_PER_FACE)
    diagonal = bounding_box_diagonal(mesh)
    _check_on_mesh(positions, samples.points, transfer.max_distance * diagonal, transfer.fit_box)
    n_neighbours = min(transfer.n_neighbours, len(positions))
    nearest = _nearest(points, positions, samples.points, samples.normals, _NORMAL_WEIGHT * diagonal, n_neighbours)
    distances = np.linalg.norm(positions[nearest[:, 0]] - samples.points, axis=1)
    has_vote = distances <= transfer.reach * _usual_spacing(positions)
    n_votes = np.bincount(samples.faces[has_vote], minlength=mesh.n_faces)
    # Faces without a vote keep theirs for now, so that the map has every face.
    votes = has_vote | (n_votes[samples.faces] == 0)
    face_map = FaceMap(
        point_targets=np.repeat(samples.faces[votes], n_neighbours),
        point_sources=nearest[votes].ravel(),
        donors=np.arange(mesh.n_faces),
        is_seen=n_votes > 0,
        n_source_faces=len(positions),
    )
    return np.where(face_map.is_seen, face_map.labels(points.labels), NO_CLASS)


def _nearest(
    points: LabelledPoints,
    positions: Float[np.ndarray, "s 3"],
    asked: Float[np.ndarray, "t 3"],
    asked_normals: Float[np.ndarray, "t 3"],
    normal_weight: float,
    n_neighbours: int,
) -> Int[np.ndarray, "t k"]:
    if points.normals is None:
        return np.asarray(cKDTree(positions).query(asked, k=range(1, n_neighbours + 1))[1])
    oriented = normal_weight * points.normals
    both_ways = np.concatenate([np.hstack([positions, oriented]), np.hstack([positions, -oriented])])
    query = np.hstack([asked, normal_weight * asked_normals])
    return np.asarray(cKDTree(both_ways).query(query, k=range(1, n_neighbours + 1))[1]) % len(positions)


def _usual_spacing(positions: Float[np.ndarray, "s 3"]) -> float:
    """Median distance of points to their nearest neighbour; infinite for a single point."""
    if len(positions) < 2:
        return np.inf
    to_itself_and_next = np.asarray(cKDTree(positions).query(positions, k=2)[0])
    return float(np.median(to_itself_and_next[:, 1]))


def _check_on_mesh(
    positions: Float[np.ndarray, "s 3"], samples: Float[np.ndarray, "t 3"], limit: float, is_fitted: bool
) -> None:
    distance = float(np.percentile(cKDTree(samples).query(positions)[0], 95))
    if distance > limit:
        remedy = "do they belong to another mesh?" if is_fitted else "if they are scaled, fit their box to the mesh's"
        raise LabelError(
            f"points must lie within {limit:.3g} of the mesh but 5 % of them are {distance:.3g} or more away; {remedy}"
        )


def _on_box_of(mesh: TriMesh, positions: Float[np.ndarray, "s 3"]) -> Float[np.ndarray, "s 3"]:
    used = mesh.vertices[np.unique(mesh.faces)]
    low, high = positions.min(axis=0), positions.max(axis=0)
    extent = float(np.linalg.norm(high - low))
    scale = bounding_box_diagonal(mesh) / extent if extent > 0 else 1.0
    return (positions - (low + high) / 2) * scale + (used.min(axis=0) + used.max(axis=0)) / 2
