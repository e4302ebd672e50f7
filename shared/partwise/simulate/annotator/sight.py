"""`Sight`: what a person sees of a shape. The only place that knows which part belongs where.

A person looks at the coloured surface and knows, for any spot, which part it belongs to, and so where colours are
wrong, roughly how much of the shape is right, and how far a spot is from where another part begins. Nothing else of
the simulated annotator is told the truth.
"""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Bool, Float, Int, Integer, UInt16
from scipy.spatial import cKDTree

from partwise.errors import LabelError, NotEnoughDataError
from partwise.geometry.adjacency import edge_adjacency, label_regions
from partwise.geometry.faces import bounding_box_diagonal, face_areas, face_centroids, face_normals
from partwise.mesh import TriMesh
from partwise.unlabelled import NO_PART_ID

NEGLIGIBLE = 0.003
"""Share of the area below which a person does not think of a region as something of its own."""


@dataclass(frozen=True, slots=True, eq=False)
class Sight:
    """A shape in sight. Lengths in diagonals of the bounding box, areas in shares of the shape's.

    points, normals : (m, 3) of each face. areas : (m,), 0 where nobody knows what belongs.
    pairs : (k, 2) int64, faces that touch across an edge.
    belongs : (m,) uint16, the part id that a person would say; 0 where nobody knows.
    room : (m,), distance from the nearest face that another part belongs on.
    segments : (m,) int64, connected region of equal `belongs`, from 0.
    tree : of points, to find the face under the pointer.
    """

    points: Float[np.ndarray, "m 3"]
    normals: Float[np.ndarray, "m 3"]
    areas: Float[np.ndarray, " m"]
    pairs: Int[np.ndarray, "k 2"]
    belongs: UInt16[np.ndarray, " m"]
    room: Float[np.ndarray, " m"]
    segments: Int[np.ndarray, " m"]
    tree: cKDTree

    @classmethod
    def of(cls, mesh: TriMesh, belongs: Integer[np.ndarray, " m"]) -> "Sight":
        """Of a mesh and the part id that belongs on each face, 0 where unknown.

        Raises
        ------
        LabelError : not one part id a face.
        NotEnoughDataError : nothing with area belongs to a part.
        """
        if belongs.shape != (mesh.n_faces,) or int(belongs.min()) < NO_PART_ID:
            raise LabelError(f"there must be {mesh.n_faces} part ids ≥ 0 but they are {belongs.shape}; another mesh's?")
        areas = np.where(belongs == NO_PART_ID, 0.0, face_areas(mesh))
        if not areas.sum() > 0:
            raise NotEnoughDataError("an annotator must know what belongs somewhere but no face has a part; label some")
        points = (face_centroids(mesh) - mesh.vertices.mean(axis=0)) / bounding_box_diagonal(mesh)
        pairs = edge_adjacency(mesh).faces
        return cls(
            points=points,
            normals=face_normals(mesh),
            areas=areas / areas.sum(),
            pairs=pairs,
            belongs=belongs.astype(np.uint16),
            room=_room(points, belongs),
            segments=label_regions(belongs, pairs),
            tree=cKDTree(points),
        )

    @property
    def n_faces(self) -> int:
        return len(self.points)

    @property
    def n_ids(self) -> int:
        """One more than the largest part id that belongs somewhere."""
        return int(self.belongs.max()) + 1

    def is_wrong(self, labels: Integer[np.ndarray, " m"]) -> Bool[np.ndarray, " m"]:
        """Where the colour is not that of what belongs, unlabelled included, (m,) bool."""
        return (labels != self.belongs) & (self.belongs != NO_PART_ID)

    def right_share(self, labels: Integer[np.ndarray, " m"]) -> float:
        """Share of the area that is labelled right, in [0, 1]."""
        return float(self.areas[labels == self.belongs].sum())

    def is_ready_to_fill(self, labels: Integer[np.ndarray, " m"]) -> bool:
        """Whether something is unlabelled and every segment worth a thought has some of its part already.

        Then a person expects that filling the rest with what is near comes out right.
        """
        if not (labels == NO_PART_ID).any():
            return False
        whole = np.bincount(self.segments, weights=self.areas)
        right = np.bincount(self.segments, weights=np.where(labels == self.belongs, self.areas, 0.0))
        return bool((right[whole > NEGLIGIBLE] > 0).all())

    def gain_table(
        self, labels: Integer[np.ndarray, " m"], groups: Int[np.ndarray, " m"]
    ) -> tuple[Int[np.ndarray, " g"], Float[np.ndarray, " g"]]:
        """For each group of faces, the part to give all of it and how much more would then be right (negative: less).

        groups : (m,) int64 from 0.
        """
        n_groups = int(groups.max()) + 1
        wanted = np.bincount(
            groups * self.n_ids + self.belongs, weights=self.areas, minlength=n_groups * self.n_ids
        ).reshape(n_groups, self.n_ids)
        right_now = np.bincount(groups, weights=np.where(labels == self.belongs, self.areas, 0.0), minlength=n_groups)
        part = np.argmax(wanted, axis=1)
        return part, wanted[np.arange(n_groups), part] - right_now

    def face_at(self, point: Float[np.ndarray, " 3"], view: Float[np.ndarray, " 3"]) -> int:
        """The face that a pointer near `point` meets, seen from `view`: the nearest of those that look that way."""
        nearest = np.asarray(self.tree.query(point, k=min(8, self.n_faces))[1]).ravel()
        facing = nearest[self.normals[nearest] @ view > 0]
        return int(facing[0] if len(facing) else nearest[0])


def _room(points: Float[np.ndarray, "m 3"], belongs: Integer[np.ndarray, " m"]) -> Float[np.ndarray, " m"]:
    room = np.ones(len(points))  # a whole diagonal where there is no other part
    for part in np.unique(belongs):
        own = belongs == part
        if not own.all():
            room[own] = cKDTree(points[~own]).query(points[own])[0]
    return room
