"""OFF: a header, vertex lines, face lines. Vertex extras (COFF, NOFF) and face colours are read over."""

import re
from itertools import islice

import numpy as np
from jaxtyping import UInt8

from partwise.errors import FileFormatError
from partwise.io.limits import ReadLimits
from partwise.io.polygons import PolygonRows, fan_triangles
from partwise.io.text import format_rows, parse_integers, parse_points, text_lines, whole_numbers
from partwise.mesh import TriMesh

# ModelNet glues the first count to the magic word ("OFF490 518 0"), so no space is asked for.
_MAGIC = re.compile(rb"(ST)?C?N?OFF\s*")


def parse_off(data: bytes, limits: ReadLimits) -> TriMesh:
    """Mesh of an ASCII OFF file, one vertex and one face a line. Polygons become fans.

    Raises
    ------
    FileFormatError : wrong magic, truncated, a line that does not fit, too many vertices or faces.
    """
    lines = text_lines(data)
    _, first = next(lines, (0, b""))
    magic = _MAGIC.match(first)
    if magic is None:
        start = first[:20].decode("latin-1")
        raise FileFormatError(f"an ASCII OFF file must start with OFF but starts with {start!r}; is the suffix right?")
    _, counts = (0, first[magic.end() :]) if first[magic.end() :] else next(lines, (0, b""))
    if not counts:
        raise FileFormatError("an OFF file must state its counts after OFF but ends there; is it truncated?")
    n_vertices, n_faces = _counts(counts)
    limits.check_faces(n_faces)
    limits.check_vertices(n_vertices)
    vertices = parse_points((line for _, line in islice(lines, n_vertices)), "vertex lines")
    polygons = PolygonRows(limits, "face corners")
    for number, line in islice(lines, n_faces):
        polygons.take(_corner_tokens(line, number, polygons))
    if len(vertices) + len(polygons) < n_vertices + n_faces:
        raise FileFormatError(
            f"the header promises {n_vertices} vertices and {n_faces} faces, a line each, "
            f"but {len(vertices) + len(polygons)} lines follow; is the file truncated?"
        )
    return TriMesh(vertices, fan_triangles(polygons.n_corners(), polygons.corners()))


def format_off(mesh: TriMesh, face_colours: UInt8[np.ndarray, "m 3"] | None = None) -> bytes:
    """ASCII OFF, float64 exact; colours, if any, as three integers after each face's corners."""
    header = f"OFF\n{mesh.n_vertices} {mesh.n_faces} 0\n"
    columns = mesh.faces if face_colours is None else np.concatenate([mesh.faces, face_colours], axis=1)
    return (header + format_rows("", mesh.vertices) + format_rows("3 ", columns)).encode("ascii")


def _counts(line: bytes) -> tuple[int, int]:
    counts = parse_integers(line.split(None, 3)[:3], "the counts of vertices, faces and edges")
    if len(counts) < 2 or int(counts.min()) < 0:
        raise FileFormatError(
            f"the counts must be two or three numbers ≥ 0 but are {counts.tolist()}; is the header damaged?"
        )
    return int(counts[0]), int(counts[1])


def _corner_tokens(line: bytes, number: int, polygons: PolygonRows) -> list[bytes]:
    """Corners of a face line: their number, that many indices, and whatever colour follows."""
    stated, *tokens = line.split(None, polygons.n_allowed + 1)  # the last piece may be all the rest of the line
    n_corners = whole_numbers([stated], "corner counts of faces")[0]
    polygons.check(n_corners)
    if len(tokens) < n_corners:
        raise FileFormatError(
            f"line {number} promises {n_corners} corners but has {len(tokens)}; is the file truncated?"
        )
    return tokens[: max(n_corners, 0)]
