"""STL, binary and ASCII: a soup of triangles, welded on reading where positions are exactly equal."""

import re

import numpy as np

from partwise.errors import FileFormatError
from partwise.io.limits import ReadLimits
from partwise.io.text import parse_points
from partwise.io.weld import weld_equal_vertices
from partwise.mesh import TriMesh

_FACET = np.dtype([("normal", "<f4", (3,)), ("corners", "<f4", (3, 3)), ("attribute", "<u2")])
_HEADER_BYTES = 84
# A line each, without blanks that could be shared out between two repetitions in more ways than one.
_VERTEX_LINE = re.compile(rb"^[^\S\n]*vertex[^\S\n]([^\n]*)", re.MULTILINE | re.IGNORECASE)
_FACET_WORD = re.compile(rb"^[^\S\n]*facet\b", re.MULTILINE | re.IGNORECASE)


def parse_stl(data: bytes, limits: ReadLimits) -> TriMesh:
    """Mesh of an STL file, faces in file order. Stored normals are not used.

    The size decides between binary and ASCII, because binary files often start with "solid" too.

    Raises
    ------
    FileFormatError : truncated, or neither binary nor ASCII STL.
    """
    declared = int.from_bytes(data[80:84], "little") if len(data) >= _HEADER_BYTES else -1
    expected = _HEADER_BYTES + declared * _FACET.itemsize
    # Some exporters pad the end; ASCII files are told apart by their first word.
    if declared >= 0 and (len(data) == expected or (len(data) > expected and not _looks_ascii(data))):
        limits.check_faces(declared)
        soup = np.frombuffer(data, dtype=_FACET, count=declared, offset=_HEADER_BYTES)["corners"].astype(np.float64)
    elif _looks_ascii(data):
        soup = _parse_ascii(data, limits)
    else:
        raise FileFormatError(
            f"a binary STL must have 84 bytes and 50 per facet, here {max(expected, _HEADER_BYTES)}, "
            f"but has {len(data)}; is it truncated or not STL?"
        )
    if not len(soup):
        raise FileFormatError("an STL file must have facets but has 0; export it again")
    corners = soup.reshape(-1, 3)
    return TriMesh(*weld_equal_vertices(corners, np.arange(len(corners)).reshape(-1, 3)))


def format_stl(mesh: TriMesh) -> bytes:
    """Binary STL, float32. Vertices that no face uses are lost: the format has no place for them."""
    facets = np.zeros(mesh.n_faces, dtype=_FACET)
    corners = mesh.vertices[mesh.faces]
    cross = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    length = np.linalg.norm(cross, axis=1, keepdims=True)
    facets["normal"] = np.divide(cross, length, out=np.zeros_like(cross), where=length > 0)
    facets["corners"] = corners
    return b"partwise".ljust(80, b" ") + mesh.n_faces.to_bytes(4, "little") + facets.tobytes()


def _looks_ascii(data: bytes) -> bool:
    return data[:512].lstrip().lower().startswith(b"solid") and b"\x00" not in data[:512]


def _parse_ascii(data: bytes, limits: ReadLimits) -> np.ndarray:
    """Corners of each facet, (m, 3, 3) float64."""
    if b"endsolid" not in data[-4096:].lower():
        raise FileFormatError("an ASCII STL must end with endsolid but does not; is it truncated?")
    n_facets = sum(1 for _ in _FACET_WORD.finditer(data))
    n_vertices = sum(1 for _ in _VERTEX_LINE.finditer(data))
    limits.check_faces(n_facets)
    if n_vertices != 3 * n_facets:
        raise FileFormatError(
            f"each facet must have 3 vertices but {n_facets} facets have {n_vertices} in all; is the file damaged?"
        )
    return parse_points((line[1] for line in _VERTEX_LINE.finditer(data)), "vertex lines").reshape(-1, 3, 3)
