"""OFF as it is found in the wild."""

import numpy as np
import pytest

from partwise.errors import FileFormatError
from partwise.io.limits import ReadLimits
from partwise.io.off import format_off, parse_off
from partwise.mesh import TriMesh

POINTS = b"0 0 0\n1 0 0\n1 1 0\n0 1 0\n"
SQUARE = [[0, 1, 2], [0, 2, 3]]


@pytest.mark.parametrize(
    "data",
    [
        b"OFF\n4 2 0\n" + POINTS + b"3 0 1 2\n3 0 2 3\n",
        b"OFF 4 2 5\n" + POINTS + b"3 0 1 2\n3 0 2 3",
        b"OFF4 2 0\n" + POINTS + b"3 0 1 2\n3 0 2 3",
        b"OFF\n4 2\n" + POINTS + b"3 0 1 2\n3 0 2 3",
        b"OFF\n4 1 0\n" + POINTS + b"4 0 1 2 3\n",
        b"# made by hand\nOFF # yes\n\n4 2 0\n# points\n" + POINTS + b"\n3 0 1 2 # one\n3 0 2 3",
        b"OFF\r\n4 2 0\r\n" + POINTS.replace(b"\n", b"\r\n") + b"3 0 1 2\r\n3 0 2 3\r\n",
        b"OFF\n4 2 0\n" + POINTS + b"3 0 1 2 255 0 0\n3  0\t2 3 0.5 0.5 0.5 1\n",
        b"COFF\n4 2 0\n" + POINTS.replace(b"\n", b" 9 9 9 255\n") + b"3 0 1 2\n3 0 2 3\n",
        b"NOFF\n4 2 0\n" + POINTS.replace(b"\n", b" 0 0 1\n") + b"3 0 1 2\n3 0 2 3\n",
    ],
)
def test_reads(data):
    mesh = parse_off(data, ReadLimits())
    np.testing.assert_array_equal(mesh.faces, SQUARE)
    np.testing.assert_array_equal(mesh.vertices, [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]])


@pytest.mark.parametrize(
    ("data", "message"),
    [
        (b"PLY\n", "must start with OFF"),
        (b"# nothing\n", "must start with OFF"),
        (b"OFF\n", "truncated"),
        (b"OFF BINARY\n", "whole numbers"),
        (b"OFF\n4\n", "two or three numbers"),
        (b"OFF\n-4 2 0\n", "two or three numbers"),
        (b"OFF\n4 2 0\n" + POINTS + b"3 0 1 2\n", "promises 4 vertices and 2 faces"),
        (b"OFF\n4 1 0\n0 0\n" + POINTS + b"3 0 1 2\n", "vertex lines"),
        (b"OFF\n4 1 0\n0 0 x\n" + POINTS + b"3 0 1 2\n", "vertex lines"),
        (b"OFF\n4 1 0\n" + POINTS + b"3 0 1\n", "line 7 promises 3 corners but has 2"),
        (b"OFF\n4 1 0\n" + POINTS + b"3 0 1 2.5\n", "whole numbers"),
        (b"OFF\n4 1 0\n" + POINTS + b"x 0 1 2\n", "corner counts"),
        (b"OFF\n4 1 0\n" + POINTS + b"2 0 1\n", "at least 3 corners but face 1 has 2"),
        (b"OFF\n4 1 0\n" + POINTS + b"-3 0 1 2\n", "at least 3 corners"),
        (b"OFF\n4 1 0\n" + POINTS + b"3 0 1 99999999999999999999999\n", "whole numbers"),
    ],
)
def test_refuses(data, message):
    with pytest.raises(FileFormatError, match=message):
        parse_off(data, ReadLimits())


def test_a_promise_of_too_many_faces_is_refused_before_they_are_looked_for():
    with pytest.raises(FileFormatError, match="max_faces"):
        parse_off(b"OFF\n3 9999999999 0\n", ReadLimits())


def test_polygons_count_against_the_limit_as_triangles():
    with pytest.raises(FileFormatError, match="max_faces"):
        parse_off(b"OFF\n4 1 0\n" + POINTS + b"4 0 1 2 3\n", ReadLimits(max_faces=1))


def test_colours_follow_the_corners():
    mesh = TriMesh(np.eye(3), np.array([[0, 1, 2]]))
    assert format_off(mesh, np.array([[255, 128, 0]], dtype=np.uint8)).splitlines()[-1] == b"3 0 1 2 255 128 0"
