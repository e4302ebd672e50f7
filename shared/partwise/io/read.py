"""`read_mesh`: one door for all mesh formats, with limits, and errors that name the file."""

from collections.abc import Callable
from pathlib import Path, PurePosixPath

from partwise.errors import FileFormatError, MeshError
from partwise.io.glb import parse_glb
from partwise.io.limits import ReadLimits
from partwise.io.obj import parse_obj
from partwise.io.off import parse_off
from partwise.io.ply import parse_ply
from partwise.io.stl import parse_stl
from partwise.mesh import TriMesh

_PARSERS: dict[str, Callable[[bytes, ReadLimits], TriMesh]] = {
    ".off": parse_off,
    ".obj": parse_obj,
    ".ply": parse_ply,
    ".stl": parse_stl,
    ".glb": parse_glb,
}
MESH_SUFFIXES = frozenset(_PARSERS)
_STUMBLES = (ValueError, ArithmeticError, LookupError, RecursionError, MemoryError)
"""What a file that no parser foresaw may bring up: it is the file that is refused, and others go on."""
_DEFAULT_LIMITS = ReadLimits()


def read_mesh(path: Path | str, data: bytes | None = None, limits: ReadLimits = _DEFAULT_LIMITS) -> TriMesh:
    """Mesh of a file, format by suffix, faces in the order of the file and as many as it declares.

    Polygons are fanned into triangles in place; a polygon of c corners counts as c − 2 faces. STL and GLB repeat
    vertices, so theirs are welded where positions are exactly equal; no other format's vertices are touched.

    Parameters
    ----------
    path : file to read, or with `data` only the name that gives the suffix and appears in errors (any URL will do).
    data : the file's bytes, when they come from a store.
    limits : largest file and mesh to accept.

    Raises
    ------
    FileFormatError : missing, empty, truncated, not the format of its suffix, NaN, an index out of range, no faces, or
        over a limit. One line: file, rule, value, remedy.
    """
    suffix = PurePosixPath(str(path)).suffix.lower()
    try:
        if suffix not in _PARSERS:
            raise FileFormatError(f"the suffix must be one of {sorted(_PARSERS)} but is {suffix!r}; convert the file")
        if data is None:
            data = read_bytes(Path(path), limits)
        limits.check_bytes(len(data))
        if not data.strip():
            raise FileFormatError("a mesh file must have content but is empty; was the download cut off?")
        return _PARSERS[suffix](data, limits)
    except (FileFormatError, MeshError) as error:
        raise FileFormatError(f"{path}: {error}") from error
    except _STUMBLES as error:
        why = " ".join(f"{type(error).__name__} {error}".split())[:200]
        raise FileFormatError(
            f"{path}: a file must hold a mesh but reading it ended in {why}; export it anew"
        ) from error


def read_bytes(path: Path, limits: ReadLimits = _DEFAULT_LIMITS) -> bytes:
    """Bytes of a file that is not larger than the limit; FileFormatError, without the name, if it cannot be read."""
    try:
        limits.check_bytes(path.stat().st_size)
        return path.read_bytes()
    except OSError as error:
        raise FileFormatError(
            f"the file must be readable but: {error.strerror or error}; check path and rights"
        ) from error
