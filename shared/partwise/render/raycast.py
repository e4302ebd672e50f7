"""`RayCastRenderer`: the 20 depth views by casting one ray through each pixel's centre. Needs no graphics driver."""

from types import TracebackType
from typing import Self

import numpy as np
from jaxtyping import Float32

from partwise.mesh import TriMesh
from partwise.render.ray_scene import RayScene
from partwise.render.views import N_VIEWS, VIEW_SIZE, fit_unit_sphere, nearness, pixel_centres, view_frames

CAMERA_HEIGHT = 1.5  # radii: outside the sphere, with room for rounding


class RayCastRenderer:
    """A `DepthRenderer` on Embree. Holds the rays, about 10 MB, and nothing that must be freed.

    Raises
    ------
    DegenerateMeshError (from `depth_views`) : all vertices that faces use coincide.
    """

    def __init__(self) -> None:
        centres = pixel_centres()
        x, y = np.meshgrid(centres, centres[::-1])
        plane = np.stack([x, y, np.full_like(x, CAMERA_HEIGHT)], axis=-1).reshape(-1, 3)
        frames = view_frames()
        self._origins = (plane @ frames).reshape(-1, 3).astype(np.float32)
        self._directions = np.repeat(-frames[:, 2], len(plane), axis=0).astype(np.float32)

    @property
    def name(self) -> str:
        return "raycast"

    def depth_views(self, mesh: TriMesh) -> Float32[np.ndarray, "20 144 144"]:
        """Nearness images, (20, 144, 144) float32; see `DepthRenderer.depth_views`."""
        scene = RayScene(fit_unit_sphere(mesh), mesh.faces)
        hits = scene.first_hits(self._origins, self._directions)
        values = np.where(hits.is_hit, nearness(CAMERA_HEIGHT - hits.distances), np.float32(0))
        return values.reshape(N_VIEWS, VIEW_SIZE, VIEW_SIZE)

    def close(self) -> None:
        """Nothing to free."""

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, exc_type: type[BaseException] | None, exc: BaseException | None, traceback: TracebackType | None
    ) -> None:
        self.close()
