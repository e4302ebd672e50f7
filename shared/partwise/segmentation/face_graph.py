"""`FaceGraph`: which faces touch across edges, laid out so that growing a region costs what the region costs.

Two faces touch when they share an edge: two different vertex indices. An edge of q > 2 faces joins all q to each other,
unlike the pairs of `partwise.geometry.adjacency`, so that a region does not depend on the order of faces. Vertices at
one place under two indices join nothing.
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from jaxtyping import Bool, Int

from partwise.errors import ParameterError
from partwise.mesh import TriMesh

_NONE = -1


@dataclass(frozen=True, slots=True, eq=False)
class FaceGraph:
    """Adjacency over m faces.

    opposite : (m, 3) int64, the face across each edge, −1 at a border and at edges of more than two faces.
    fans : (m, 3) int64, which fan each edge is, −1 where it has at most two faces.
    fan_start : (q + 1,) int64, where in `fan_faces` each fan begins.
    fan_faces : (p,) int64, the faces of each fan.
    """

    opposite: Int[np.ndarray, "m 3"]
    fans: Int[np.ndarray, "m 3"]
    fan_start: Int[np.ndarray, " q+1"]
    fan_faces: Int[np.ndarray, " p"]

    @classmethod
    def build(cls, mesh: TriMesh) -> "FaceGraph":
        corners = np.sort(mesh.faces[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2), axis=1)
        key = corners[:, 0] * mesh.n_vertices + corners[:, 1]
        key[corners[:, 0] == corners[:, 1]] = _NONE  # an edge without length between indices is no edge
        order = np.argsort(key, kind="stable")
        order = order[key[order] != _NONE]
        starts = np.flatnonzero(np.diff(key[order], prepend=_NONE))
        counts = np.diff(starts, append=len(order))
        opposite = np.full(3 * mesh.n_faces, _NONE)
        first, second = order[starts[counts == 2]], order[starts[counts == 2] + 1]
        opposite[first], opposite[second] = second // 3, first // 3
        fans = np.full(3 * mesh.n_faces, _NONE)
        fan_of_place = np.repeat(np.where(counts > 2, np.cumsum(counts > 2) - 1, _NONE), counts)
        fans[order] = fan_of_place
        fan_start = np.concatenate([[0], np.cumsum(counts[counts > 2])])
        return cls(opposite.reshape(-1, 3), fans.reshape(-1, 3), fan_start, order[fan_of_place != _NONE] // 3)

    @property
    def n_faces(self) -> int:
        return len(self.opposite)

    def check_face(self, face: int) -> None:
        """Raises ParameterError unless 0 ≤ face < m."""
        check_face(face, self.n_faces)

    def grown(self, seed: int, is_open: Callable[[np.ndarray], np.ndarray]) -> Int[np.ndarray, " r"]:
        """Faces reached from `seed` breadth-first through open faces, ascending; none when the seed is not open.

        `is_open` takes face ids (k,) int64 and returns (k,) bool. It is asked about each face at most once.

        Raises
        ------
        ParameterError : the seed is outside the mesh.
        """
        self.check_face(seed)
        frontier = np.array([seed])
        frontier = frontier[is_open(frontier)]
        is_seen = np.zeros(self.n_faces + 1, dtype=bool)
        is_seen[[seed, _NONE]] = True  # the last place stands for "no face"
        is_spent = np.zeros(len(self.fan_start) - 1, dtype=bool)
        place = np.empty(self.n_faces, dtype=np.int64)
        rings = [frontier]
        while len(frontier):
            near = self.opposite[frontier].ravel()
            if len(is_spent):
                near = np.concatenate([near, self._fan_members(frontier, is_spent)])
            near = near[~is_seen[near]]
            place[near] = np.arange(len(near))
            near = near[place[near] == np.arange(len(near))]  # each face once
            is_seen[near] = True
            frontier = near[is_open(near)]
            rings.append(frontier)
        return np.sort(np.concatenate(rings))

    def _fan_members(self, frontier: np.ndarray, is_spent: Bool[np.ndarray, " q"]) -> Int[np.ndarray, " k"]:
        """Faces of the fans at `frontier` that were not asked for before: a fan of q faces costs q, never q²."""
        fans = self.fans[frontier].ravel()
        fans = np.unique(fans[fans != _NONE])
        fans = fans[~is_spent[fans]]
        is_spent[fans] = True
        parts = [self.fan_faces[self.fan_start[fan] : self.fan_start[fan + 1]] for fan in fans.tolist()]
        return np.concatenate(parts) if parts else np.empty(0, dtype=np.int64)


def check_face(face: int, n_faces: int) -> None:
    """Raises ParameterError unless 0 ≤ face < n_faces."""
    if not 0 <= face < n_faces:
        raise ParameterError(
            f"a face must be 0 to {n_faces - 1} but is {face}; was it chosen on another mesh or resolution?"
        )
