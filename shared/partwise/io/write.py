"""`write_mesh`: one door to all mesh formats, whole files only."""

from pathlib import Path

import numpy as np
from jaxtyping import UInt8

from partwise.errors import ParameterError
from partwise.io.atomic import write_atomically
from partwise.io.glb import format_glb
from partwise.io.obj import format_obj
from partwise.io.off import format_off
from partwise.io.ply import format_ply
from partwise.io.stl import format_stl
from partwise.mesh import TriMesh

_COLOURLESS = {".obj": format_obj, ".stl": format_stl}
_COLOURED = {".off": format_off, ".ply": format_ply, ".glb": format_glb}
_FLOAT32_SUFFIXES = (".ply", ".stl", ".glb")


def write_mesh(mesh: TriMesh, path: Path | str, face_colours: UInt8[np.ndarray, "m 3"] | None = None) -> None:
    """Writes a mesh, format by suffix, faces in order. OFF and OBJ keep float64 exactly; the others hold float32.

    Reading gives the same mesh again, save that STL and GLB weld vertices at one position and number them by first use.

    Parameters
    ----------
    face_colours : (m, 3) uint8 RGB; for OFF, PLY and GLB.

    Raises
    ------
    ParameterError : unknown suffix, colours for OBJ or STL, colours of another length, coordinates beyond float32.
    StoreError : the file cannot be written; nothing is left half-written.
    """
    suffix = Path(path).suffix.lower()
    if suffix not in _COLOURLESS and suffix not in _COLOURED:
        known = sorted([*_COLOURLESS, *_COLOURED])
        raise ParameterError(f"{path}: the suffix must be one of {known} but is {suffix!r}; choose one of them")
    if suffix in _FLOAT32_SUFFIXES and np.abs(mesh.vertices).max() > np.finfo(np.float32).max:
        raise ParameterError(
            f"{path}: coordinates must fit float32 but reach {np.abs(mesh.vertices).max():.3g}; use OFF or OBJ"
        )
    if face_colours is None:
        write_atomically(path, {**_COLOURLESS, **_COLOURED}[suffix](mesh))
        return
    if suffix in _COLOURLESS:
        raise ParameterError(f"{path}: {suffix} cannot hold face colours; use one of {sorted(_COLOURED)}")
    if face_colours.shape != (mesh.n_faces, 3) or face_colours.dtype != np.uint8:
        raise ParameterError(
            f"{path}: face_colours must be ({mesh.n_faces}, 3) uint8 but are {face_colours.shape} "
            f"{face_colours.dtype}; one RGB row a face"
        )
    write_atomically(path, _COLOURED[suffix](mesh, face_colours))
