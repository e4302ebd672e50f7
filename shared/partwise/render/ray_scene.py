"""`RayScene`: first hits and shadow tests of many rays against one mesh, by Embree.

Rays are float32 inside Embree, so callers pass geometry scaled to about one unit.
"""

from dataclasses import dataclass

import numpy as np
from embreex.mesh_construction import TriangleMesh
from embreex.rtcore_scene import EmbreeScene
from jaxtyping import Bool, Float, Float32, Int, Int32

MISS = -1


@dataclass(frozen=True, slots=True)
class RayHits:
    """Nearest hit of each of r rays; either side of a face counts.

    face_ids : (r,) int32, −1 for a miss. distances : (r,) float32 in lengths of the direction; large for a miss.
    barycentric : (r, 2) float32, weights of the face's second and third corner.
    """

    face_ids: Int32[np.ndarray, " r"]
    distances: Float32[np.ndarray, " r"]
    barycentric: Float32[np.ndarray, "r 2"]

    @property
    def is_hit(self) -> Bool[np.ndarray, " r"]:
        return self.face_ids != MISS


class RayScene:
    """A bounding volume hierarchy over one mesh, built once and queried often.

    Parameters
    ----------
    vertices : (n, 3), about one unit in size. faces : (m, 3), indices into vertices.
    """

    def __init__(self, vertices: Float[np.ndarray, "n 3"], faces: Int[np.ndarray, "m 3"]) -> None:
        self._scene = EmbreeScene()
        TriangleMesh(
            scene=self._scene,
            vertices=np.ascontiguousarray(vertices, dtype=np.float32),
            indices=np.ascontiguousarray(faces, dtype=np.int32),
        )

    def first_hits(self, origins: Float[np.ndarray, "r 3"], directions: Float[np.ndarray, "r 3"]) -> RayHits:
        """Nearest hit of each ray, from its origin on. Both inputs (r, 3); directions need not be unit vectors."""
        hits = self._scene.run(_float32(origins), _float32(directions), query="INTERSECT", output=True)
        return RayHits(hits["primID"], hits["tfar"], np.stack([hits["u"], hits["v"]], axis=1))

    def is_occluded(
        self, origins: Float[np.ndarray, "r 3"], directions: Float[np.ndarray, "r 3"], max_distance: float
    ) -> Bool[np.ndarray, " r"]:
        """Whether anything lies on each ray within max_distance (lengths of the direction), (r,) bool."""
        limits = np.full(len(origins), max_distance, dtype=np.float32)
        found = self._scene.run(_float32(origins), _float32(directions), dists=limits, query="OCCLUDED")
        return np.asarray(found != MISS)


def _float32(rows: np.ndarray) -> np.ndarray:
    return np.ascontiguousarray(rows, dtype=np.float32)
