"""OBJ: `v` and `f` lines. Texture coordinates, normals, groups and materials are read over, so they split nothing."""

import re
from itertools import chain

import numpy as np
from jaxtyping import Int

from partwise.errors import FileFormatError
from partwise.io.limits import ReadLimits
from partwise.io.polygons import fan_triangles
from partwise.io.text import format_rows, numbered_lines, parse_integers, parse_points
from partwise.mesh import TriMesh

_CONTINUATION = re.compile(rb"\\\r?\n")
_NORMAL_AND_TEXTURE = re.compile(rb"/\S*")


def parse_obj(data: bytes, limits: ReadLimits) -> TriMesh:
    """Mesh of an OBJ file: all vertices and all faces in file order. Polygons become fans.

    Negative indices count back from the last vertex before the face's line.

    Raises
    ------
    FileFormatError : no vertex or face lines, a line that does not fit, an index 0 or before the first vertex.
    """
    if b"\x00" in data[:4096]:
        raise FileFormatError("an OBJ file must be text but has zero bytes; is the suffix right?")
    lines, numbers = numbered_lines(_CONTINUATION.sub(b" ", data))
    kind = np.array([_KINDS.get(line.split(None, 1)[0], 0) for line in lines], dtype=np.int8)
    is_vertex, is_face = kind == 1, kind == 2
    if not is_vertex.any() or not is_face.any():
        raise FileFormatError(
            f"an OBJ file must have `v` and `f` lines but has {int(is_vertex.sum())} and {int(is_face.sum())}; "
            "is it empty, truncated or a point cloud?"
        )
    vertices = parse_points([lines[k][1:] for k in np.flatnonzero(is_vertex)], "`v` lines")
    face_rows = np.flatnonzero(is_face)
    text = _NORMAL_AND_TEXTURE.sub(b"", b"\n".join([lines[k][1:] for k in face_rows]))
    rows = [row.split() for row in text.split(b"\n")]
    n_corners = np.fromiter(map(len, rows), dtype=np.int64, count=len(rows))
    limits.check_faces(int(np.maximum(n_corners - 2, 0).sum()))
    corners = parse_integers(list(chain.from_iterable(rows)), "vertex indices of `f` lines")
    n_before = np.cumsum(is_vertex)[face_rows]
    line_of_corner = np.repeat([numbers[k] for k in face_rows], n_corners)
    corners = _from_zero(corners, np.repeat(n_before, n_corners), line_of_corner)
    return TriMesh(vertices, fan_triangles(n_corners, corners))


def format_obj(mesh: TriMesh) -> bytes:
    """`v` and `f` lines only, float64 exact."""
    return (format_rows("v ", mesh.vertices) + format_rows("f ", mesh.faces + 1)).encode("ascii")


_KINDS = {b"v": 1, b"f": 2}


def _from_zero(
    corners: Int[np.ndarray, " c"], n_before: Int[np.ndarray, " c"], lines: Int[np.ndarray, " c"]
) -> Int[np.ndarray, " c"]:
    """OBJ's 1-based or negative indices to 0-based ones; `n_before` counts the vertices above each corner's line."""
    from_zero = np.where(corners > 0, corners - 1, n_before + corners)
    bad = (corners == 0) | (from_zero < 0)
    if bad.any():
        first = int(np.argmax(bad))
        raise FileFormatError(
            f"an index must name a vertex counted from 1, or back from the line with a minus sign, but line "
            f"{int(lines[first])} has {int(corners[first])} after {int(n_before[first])} vertices; was the file edited?"
        )
    return from_zero
