"""`GlRenderer`: the 20 depth views by pyrender on EGL, on a graphics card or on Mesa's software driver.

Drivers can crash instead of raising: let `partwise.render.probe` try one in a process of its own before using this.
"""

import os
from types import TracebackType
from typing import Any, Self

import numpy as np
from jaxtyping import Float32

from partwise.mesh import TriMesh
from partwise.render.views import VIEW_SIZE, RenderError, fit_unit_sphere, nearness, view_frames

CAMERA_HEIGHT = 2.0  # radii; the near plane is half a radius from the sphere and so is the far plane
Z_NEAR, Z_FAR = 0.5, 3.5


class GlRenderer:
    """A `DepthRenderer` on one GL context, made here and freed by `close`.

    Sets `PYOPENGL_PLATFORM=egl` where the variable is unset, because PyOpenGL reads it when first imported.

    Raises
    ------
    RenderError : no context can be made on this machine; or `depth_views` is called after `close`.
    """

    def __init__(self) -> None:
        os.environ.setdefault("PYOPENGL_PLATFORM", "egl")
        try:
            import pyrender  # here because the variable must be set before PyOpenGL is imported

            offscreen = pyrender.OffscreenRenderer(VIEW_SIZE, VIEW_SIZE)
        except Exception as error:  # drivers, loaders and pyrender's asserts raise anything
            raise RenderError(
                f"a GL context is needed but PYOPENGL_PLATFORM={os.environ['PYOPENGL_PLATFORM']} gives "
                f"{type(error).__name__}: {error}; install libegl1 and a driver, or use ray casting"
            ) from error
        _leave_display_open(offscreen)
        self._offscreen: Any = offscreen  # pyrender ships no types; None once closed
        self._camera = pyrender.OrthographicCamera(1.0, 1.0, znear=Z_NEAR, zfar=Z_FAR)
        self._poses = _camera_poses()

    @property
    def name(self) -> str:
        return "gl"

    def depth_views(self, mesh: TriMesh) -> Float32[np.ndarray, "20 144 144"]:
        """Nearness images, (20, 144, 144) float32; see `DepthRenderer.depth_views`."""
        import pyrender

        if self._offscreen is None:
            raise RenderError("a renderer must be open to draw but this one is closed; open another")
        vertices = fit_unit_sphere(mesh).astype(np.float32)
        # Both windings, because pyrender culls back faces in depth passes whatever its flags say.
        faces = np.concatenate([mesh.faces, mesh.faces[:, ::-1]]).astype(np.uint32)
        surface = pyrender.Mesh([pyrender.Primitive(positions=vertices, indices=faces)])
        scene = pyrender.Scene()
        node = scene.add(surface)
        camera_node = scene.add(self._camera, pose=self._poses[0])
        # SEG switches multisampling off: with it a pixel's depth is that of a sample beside the pixel's centre.
        flags = pyrender.RenderFlags.DEPTH_ONLY | pyrender.RenderFlags.SEG
        views = []
        for pose in self._poses:
            scene.set_pose(camera_node, pose)
            views.append(self._offscreen.render(scene, flags=flags, seg_node_map={node: (255, 255, 255)}))
        return _nearness_of_perspective(np.stack(views))

    def close(self) -> None:
        """Free the GL objects and the context."""
        if self._offscreen is not None:
            self._offscreen.delete()
            self._offscreen = None

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, exc_type: type[BaseException] | None, exc: BaseException | None, traceback: TracebackType | None
    ) -> None:
        self.close()


def _leave_display_open(offscreen: Any) -> None:
    """Make `offscreen.delete` destroy its context only.

    pyrender also terminates the EGL display, which all contexts of a process share: closing one renderer, or the
    garbage collector finding one, would break the others.
    """
    platform = offscreen._platform
    terminate = platform.delete_context

    def destroy_context() -> None:
        if getattr(platform, "_egl_context", None) is None:
            terminate()  # not EGL, or nothing left to destroy
            return
        from OpenGL import EGL

        EGL.eglMakeCurrent(platform._egl_display, EGL.EGL_NO_SURFACE, EGL.EGL_NO_SURFACE, EGL.EGL_NO_CONTEXT)
        EGL.eglDestroyContext(platform._egl_display, platform._egl_context)
        platform._egl_context = platform._egl_display = None

    platform.delete_context = destroy_context


def _camera_poses() -> np.ndarray:
    """Camera to world, (20, 4, 4): columns right, up, towards the camera (GL looks along −z), position."""
    frames = view_frames()
    poses = np.tile(np.eye(4), (len(frames), 1, 1))
    poses[:, :3, :3] = frames.transpose(0, 2, 1)
    poses[:, :3, 3] = CAMERA_HEIGHT * frames[:, 2]
    return poses


def _nearness_of_perspective(values: np.ndarray) -> np.ndarray:
    """Nearness from what pyrender returns: it applies the perspective formula to orthographic cameras too.

    pyrender gives 2nf / (f + n − ndc·(f − n)) with ndc in [−1, 1] linear in depth for an orthographic camera.
    """
    is_surface = values > 0
    perspective = np.where(is_surface, values, 1.0).astype(np.float64)
    ndc = (Z_FAR + Z_NEAR - 2.0 * Z_NEAR * Z_FAR / perspective) / (Z_FAR - Z_NEAR)
    distance = Z_NEAR + (ndc + 1.0) / 2.0 * (Z_FAR - Z_NEAR)
    return np.where(is_surface, nearness(CAMERA_HEIGHT - distance), np.float32(0))
