"""The 20 orthographic cameras around a shape, and what a depth renderer promises.

The shape is moved into the unit sphere (`fit_unit_sphere`) and seen from each vertex of a regular dodecahedron. Every
renderer uses these cameras, this pixel grid and `nearness`, so that images agree whatever draws them.
"""

from types import TracebackType
from typing import Protocol, Self

import numpy as np
from jaxtyping import Float, Float32

from partwise.errors import DegenerateMeshError, PartwiseError
from partwise.mesh import TriMesh

N_VIEWS = 20
VIEW_SIZE = 144  # pixels; 18 HOG cells of 8

# A surface point on the far side of the sphere must still differ from the background, also in 8 bits.
FARTHEST_NEARNESS = 1.0 / 255.0


class RenderError(PartwiseError, RuntimeError):
    """No picture can be drawn: a GL context cannot be made, or the renderer is closed."""


class DepthRenderer(Protocol):
    """Draws the 20 depth views. Holds a resource (perhaps a GL context): use as a context manager or call `close`.

    An instance is for one thread; it may be used for any number of meshes.
    """

    @property
    def name(self) -> str:
        """Which implementation this is, for logs and provenance: "gl" or "raycast"."""

    def depth_views(self, mesh: TriMesh) -> Float32[np.ndarray, "20 144 144"]:
        """Nearness images, (20, 144, 144) float32 in [0, 1]: see `nearness`. Row 0 is the top. Back faces are drawn.

        Raises
        ------
        DegenerateMeshError : all vertices that faces use coincide.
        """

    def close(self) -> None:
        """Free what is held. May be called twice; the renderer cannot be used afterwards."""

    def __enter__(self) -> Self: ...

    def __exit__(
        self, exc_type: type[BaseException] | None, exc: BaseException | None, traceback: TracebackType | None
    ) -> None: ...


def view_frames() -> Float[np.ndarray, "20 3 3"]:
    """Camera frames, (20, 3, 3) float64: rows are right, up and towards the camera, orthonormal and right-handed.

    Third rows are the vertices of a regular dodecahedron, in a fixed order; up is the y axis as seen by the camera (no
    vertex lies on that axis).

    Source: Chen, Tian, Shen, Ouhyoung 2003 (views from a dodecahedron). Differs: all 20 vertices, because depth images
    of opposite vertices differ where silhouettes do not.
    """
    towards = _dodecahedron_vertices()
    right = np.cross(np.array([0.0, 1.0, 0.0]), towards)
    right /= np.linalg.norm(right, axis=1, keepdims=True)
    return np.stack([right, np.cross(towards, right), towards], axis=1)


def pixel_centres() -> Float[np.ndarray, " 144"]:
    """Coordinates of pixel centres along an image's side, (144,) float64 ascending in (−1, 1): radii of the sphere."""
    return (np.arange(VIEW_SIZE) + 0.5) * (2.0 / VIEW_SIZE) - 1.0


def fit_unit_sphere(mesh: TriMesh) -> Float[np.ndarray, "n 3"]:
    """Vertices moved and scaled so that those used by faces lie in the unit sphere and at least one touches it.

    Centre: the middle of the axis-aligned bounding box, which inner and duplicate faces cannot move (they would move a
    centroid, so that a shape would look different after it is remeshed).

    Returns
    -------
    (n, 3) float64, radii of the sphere. Rows that no face uses may lie outside.

    Raises
    ------
    DegenerateMeshError : all vertices that faces use coincide.
    """
    used = mesh.vertices[np.unique(mesh.faces)]
    centre = (used.min(axis=0) + used.max(axis=0)) / 2.0
    radius = float(np.linalg.norm(used - centre, axis=1).max())
    if not radius > 0:
        raise DegenerateMeshError(
            f"a mesh must have extent to be drawn but all its vertices lie at {centre.tolist()}; "
            "check the export's scale"
        )
    return (mesh.vertices - centre) / radius


def nearness(height: Float[np.ndarray, "*shape"]) -> Float32[np.ndarray, "*shape"]:
    """Depth value of surface points: 1 where the sphere is nearest to the camera, 1/255 where farthest; linear between.

    Parameters
    ----------
    height : coordinate along the axis towards the camera, in radii of the sphere, −1 (far) to 1 (near); clipped.

    Returns
    -------
    same shape, float32 in [1/255, 1]. Background is 0, which no surface point takes.
    """
    fraction = np.clip((np.asarray(height, dtype=np.float64) + 1.0) / 2.0, 0.0, 1.0)
    return (FARTHEST_NEARNESS + (1.0 - FARTHEST_NEARNESS) * fraction).astype(np.float32)


def _dodecahedron_vertices() -> np.ndarray:
    golden = (1.0 + np.sqrt(5.0)) / 2.0
    corners = [(x, y, z) for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)]
    planes = [(s / golden, t * golden) for s in (-1, 1) for t in (-1, 1)]
    rectangles = [(0.0, a, b) for a, b in planes] + [(a, b, 0.0) for a, b in planes] + [(b, 0.0, a) for a, b in planes]
    return np.array(corners + rectangles, dtype=np.float64) / np.sqrt(3.0)
