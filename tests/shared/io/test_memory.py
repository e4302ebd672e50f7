"""A file that is over a limit is refused before it takes many times its bytes."""

import tracemalloc

import numpy as np
import pytest

from partwise.errors import FileFormatError
from partwise.io.glb import pack_glb
from partwise.io.limits import ReadLimits
from partwise.io.read import read_mesh

LIMITS = ReadLimits(max_faces=1_000)
PLY = (
    b"ply\nformat ascii 1.0\nelement vertex %d\nproperty float x\nproperty float y\nproperty float z\n"
    b"element face %d\nproperty list int int vertex_index\nend_header\n"
)
POINTS = b"0 0 0\n1 0 0\n0 1 0\n"
N = 300_000
MANY_CORNERS = b" 0" * N
FILES = {
    "faces.obj": b"v 0 0 0\n" + b"f 1 1 1\n" * N,
    "vertices.obj": b"v 0 0 0\n" * N + b"f 1 1 1\n",
    "polygon.obj": b"v 0 0 0\nf" + MANY_CORNERS,
    "slashes.obj": b"v 0 0 0\nf" + b" 1/1" * N,
    "continued.obj": b"v 0 0 0\nf" + b" 1\\\n" * N,
    "polygon.off": b"OFF\n3 1 0\n" + POINTS + b"%d" % N + MANY_CORNERS,
    "vertices.off": b"OFF\n%d 1 0\n" % N + b"0 0 0\n" * N + b"3 0 1 2\n",
    "columns.off": b"OFF\n3 1 0\n0 0\n" + MANY_CORNERS + POINTS + b"3 0 1 2\n",
    "polygon.ply": PLY % (3, 1) + POINTS + b"%d" % N + MANY_CORNERS,
    "vertices.ply": PLY % (N, 1) + b"0 0 0\n" * N + b"3 0 1 2\n",
    "columns.ply": PLY % (3, 1) + MANY_CORNERS + b"\n" + POINTS + b"3 0 1 2\n",
    "facets.stl": b"solid\n" + b"facet\n" * N + b"vertex 0 0 0\n" * N + b"endsolid",
    "columns.stl": b"solid\nfacet\nvertex 0 0\nvertex" + MANY_CORNERS + b"\nvertex 0 0 0\nendsolid",
    "json.glb": pack_glb({"a": [0] * 5_000_001}, b""),
}


@pytest.mark.parametrize("name", FILES)
def test_growth(name):
    """Files that were refused only once they had taken up to sixty times their bytes."""
    data = FILES[name]
    tracemalloc.start()
    try:
        with pytest.raises(FileFormatError):
            read_mesh(name, data, LIMITS)
        assert tracemalloc.get_traced_memory()[1] < 5 * len(data)
    finally:
        tracemalloc.stop()


def test_what_is_read_over_takes_none():
    data = b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n" + b"vn 0\n" * N + b"x\n" * N
    tracemalloc.start()
    try:
        np.testing.assert_array_equal(read_mesh("a.obj", data, LIMITS).faces, [[0, 1, 2]])
        assert tracemalloc.get_traced_memory()[1] < 2 * len(data)
    finally:
        tracemalloc.stop()


def test_a_binary_ply_of_many_records_is_refused_before_they_are_walked():
    header = PLY.replace(b"ascii", b"binary_little_endian") % (3, 1)
    header = header.replace(b"end_header", b"element foo %d\nproperty list uchar uchar bar\nend_header" % N)
    with pytest.raises(FileFormatError, match=r"'foo' has 300000"):
        read_mesh("a.ply", header + bytes(N), LIMITS)


def test_an_stl_of_blank_lines_is_read_in_one_go():
    """Where two repetitions may share out blanks, the time grows with their square: this would take hours."""
    with pytest.raises(FileFormatError, match="must have facets"):
        read_mesh("a.stl", b"solid\n" + b"\n" * (1 << 21) + b" " * (1 << 21) + b"endsolid")
