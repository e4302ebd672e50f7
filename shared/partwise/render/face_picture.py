"""What a camera sees of a mesh, once for all labels: which face, and how bright. For `partwise.render.thumbnail`."""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Int32, UInt8

from partwise.mesh import TriMesh
from partwise.render.shaded import GAMMA, UpAxis, shade
from partwise.render.thumbnail import PICTURE_SIZE


@dataclass(frozen=True, slots=True, eq=False)
class FacePicture:
    """face_ids : (h, w) int32, −1 for background. shading : (h, w) uint8, sRGB of a white face there; 0 outside."""

    face_ids: Int32[np.ndarray, "h w"]
    shading: UInt8[np.ndarray, "h w"]


def face_id_image(mesh: TriMesh, up: UpAxis = "y", size: int = PICTURE_SIZE) -> FacePicture:
    """The mesh from the front right, a little from above, by ray casting.

    Parameters
    ----------
    up : which axis of the mesh points up. size : pixels along each side, ≥ 1.

    Raises
    ------
    DegenerateMeshError : all vertices that faces use coincide. ParameterError : size or up out of range.
    """
    seen = shade(mesh, (size, size), up=up, supersampling=1)
    bright = np.clip(seen.light[..., 0], 0.0, 1.0) ** (1.0 / GAMMA)
    return FacePicture(seen.face_ids[..., 0], np.rint(bright * 255.0).astype(np.uint8))
