"""OFF: a header, vertex lines, face lines. Vertex extras (COFF, NOFF) and face colours are read over."""

import re

import numpy as np
from jaxtyping import Int, UInt8

from partwise.errors import FileFormatError
from partwise.io.limits import ReadLimits
from partwise.io.polygons import fan_triangles
from partwise.io.text import format_rows, numbered_lines, parse_integers, parse_points
from partwise.mesh import TriMesh

# ModelNet glues the first count to the magic word ("OFF490 518 0"), so no space is asked for.
_MAGIC = re.compile(rb"(ST)?C?N?OFF\s*")


def parse_off(data: bytes, limits: ReadLimits) -> TriMesh:
    """Mesh of an ASCII OFF file, one vertex and one face a line. Polygons become fans.

    Raises
    ------
    FileFormatError : wrong magic, truncated, or a line that does not fit.
    """
    lines, numbers = numbered_lines(data)
    magic = _MAGIC.match(lines[0]) if lines else None
    if magic is None:
        start = lines[0][:20].decode("latin-1") if lines else ""
        raise FileFormatError(f"an ASCII OFF file must start with OFF but starts with {start!r}; is the suffix right?")
    rest = lines[0][magic.end() :]
    skip = 0 if rest else 1
    if len(lines) <= skip:
        raise FileFormatError("an OFF file must state its counts after OFF but ends there; is it truncated?")
    n_vertices, n_faces = _counts(rest or lines[1])
    limits.check_faces(n_faces)
    body, body_numbers = lines[1 + skip :], numbers[1 + skip :]
    if len(body) < n_vertices + n_faces:
        raise FileFormatError(
            f"the header promises {n_vertices} vertices and {n_faces} faces, a line each, "
            f"but {len(body)} lines follow; is the file truncated?"
        )
    vertices = parse_points(body[:n_vertices], "vertex lines")
    face_lines = slice(n_vertices, n_vertices + n_faces)
    faces = _parse_faces(body[face_lines], body_numbers[face_lines])
    limits.check_faces(len(faces))
    return TriMesh(vertices, faces)


def format_off(mesh: TriMesh, face_colours: UInt8[np.ndarray, "m 3"] | None = None) -> bytes:
    """ASCII OFF, float64 exact; colours, if any, as three integers after each face's corners."""
    header = f"OFF\n{mesh.n_vertices} {mesh.n_faces} 0\n"
    columns = mesh.faces if face_colours is None else np.concatenate([mesh.faces, face_colours], axis=1)
    return (header + format_rows("", mesh.vertices) + format_rows("3 ", columns)).encode("ascii")


def _counts(line: bytes) -> tuple[int, int]:
    counts = parse_integers(line.split(), "the counts of vertices, faces and edges")
    if len(counts) < 2 or int(counts.min()) < 0:
        raise FileFormatError(
            f"the counts must be two or three numbers ≥ 0 but are {counts.tolist()}; is the header damaged?"
        )
    return int(counts[0]), int(counts[1])


def _parse_faces(lines: list[bytes], numbers: list[int]) -> Int[np.ndarray, "m 3"]:
    """Triangles of face lines: a corner count, that many indices, and whatever colour follows."""
    rows = [line.split() for line in lines]
    n_corners = parse_integers([row[0] for row in rows], "corner counts of faces")
    n_columns = np.fromiter(map(len, rows), dtype=np.int64, count=len(rows))
    short = n_columns < n_corners + 1
    if short.any():
        row = int(np.argmax(short))
        raise FileFormatError(
            f"line {numbers[row]} promises {int(n_corners[row])} corners but has {int(n_columns[row]) - 1}; "
            "is the file truncated?"
        )
    tokens = [token for row, n in zip(rows, n_corners.tolist(), strict=True) for token in row[1 : n + 1]]
    return fan_triangles(n_corners, parse_integers(tokens, "face corners"))
