"""OBJ: `v` and `f` lines. Texture coordinates, normals, groups and materials are read over, so they split nothing."""

import re
from array import array

import numpy as np
from jaxtyping import Int

from partwise.errors import FileFormatError
from partwise.io.limits import ReadLimits
from partwise.io.polygons import PolygonRows, fan_triangles
from partwise.io.text import format_rows, parse_points
from partwise.mesh import TriMesh

_LINE = re.compile(rb"(?:^|(?<=\r))[^\S\r\n]*([vf])(?![^\s#])([^\r\n#]*)", re.MULTILINE)


def parse_obj(data: bytes, limits: ReadLimits) -> TriMesh:
    """Mesh of an OBJ file: all vertices and all faces in file order. Polygons become fans.

    Negative indices count back from the last vertex before the face's line.

    Raises
    ------
    FileFormatError : no vertex or face lines, a line that does not fit, an index 0 or before the first vertex, too many
        vertices or faces.
    """
    if b"\x00" in data[:4096]:
        raise FileFormatError("an OBJ file must be text but has zero bytes; is the suffix right?")
    text = data.replace(b"\\\r\n", b" ").replace(b"\\\n", b" ")  # lines that go on
    points: list[bytes] = []
    polygons = PolygonRows(limits, "vertex indices of `f` lines")
    n_before, starts = array("q"), array("q")
    for line in _LINE.finditer(text):
        if line[1] == b"v":
            points.append(line[2])
            limits.check_vertices(len(points))
        else:
            polygons.take(_corner_tokens(line[2], polygons.n_allowed))
            n_before.append(len(points))
            starts.append(line.start())
    if not points or not polygons:
        raise FileFormatError(
            f"an OBJ file must have `v` and `f` lines but has {len(points)} and {len(polygons)}; "
            "is it empty, truncated or a point cloud?"
        )
    n_corners = polygons.n_corners()
    corners = _from_zero(polygons.corners(), np.repeat(n_before, n_corners))
    if len(bad := np.flatnonzero(corners < 0)):
        face = int(np.searchsorted(np.cumsum(n_corners), bad[0], side="right"))
        index, line_number = int(polygons.corners()[bad[0]]), _line_number(text, starts[face])
        raise FileFormatError(
            "an index must name a vertex counted from 1, or back from the line with a minus sign, but line "
            f"{line_number} has {index} after {n_before[face]} vertices; was the file edited?"
        )
    return TriMesh(parse_points(points, "`v` lines"), fan_triangles(n_corners, corners))


def format_obj(mesh: TriMesh) -> bytes:
    """`v` and `f` lines only, float64 exact."""
    return (format_rows("v ", mesh.vertices) + format_rows("f ", mesh.faces + 1)).encode("ascii")


def _corner_tokens(row: bytes, n_allowed: int) -> list[bytes]:
    """A face's vertex indices, without what follows them after a slash; of too many, one more than are allowed."""
    tokens = row.split(None, n_allowed + 1)[: n_allowed + 1]
    return [index for token in tokens if (index := token.partition(b"/")[0])] if b"/" in row else tokens


def _from_zero(corners: Int[np.ndarray, " c"], n_before: Int[np.ndarray, " c"]) -> Int[np.ndarray, " c"]:
    """OBJ's 1-based or negative indices to 0-based ones, −1 or less if they name no vertex.

    n_before : vertices above each corner's line.
    """
    return np.where(corners > 0, corners - 1, np.where(corners < 0, n_before + corners, -1))


def _line_number(text: bytes, start: int) -> int:
    """Which line, from 1, begins at this place."""
    return 1 + text.count(b"\n", 0, start) + text.count(b"\r", 0, start) - text.count(b"\r\n", 0, start)
