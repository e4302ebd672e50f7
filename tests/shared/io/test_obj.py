"""OBJ as it is found in the wild: nothing in it may split, sort or drop a face."""

import numpy as np
import pytest

from partwise.errors import FileFormatError
from partwise.io.limits import ReadLimits
from partwise.io.obj import parse_obj

POINTS = b"v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n"
SQUARE = [[0, 1, 2], [0, 2, 3]]


@pytest.mark.parametrize(
    "data",
    [
        POINTS + b"f 1 2 3\nf 1 3 4\n",
        POINTS + b"f 1 2 3 4\n",
        POINTS + b"f -4 -3 -2\nf -4 -2 -1\n",
        POINTS + b"vt 0 0\nvn 0 0 1\nf 1/1/1 2/1/1 3/1/1\nf 1//1 3//1 4//1\n",
        POINTS + b"vt 0 0\nf 1/1 2/1 3/1\nf 1 3/1 4\n",
        POINTS + b"vt 0 0\nvt 1 1\nf 1/1 2/1 3/1\nf 1/2 3/2 4/2\n",
        POINTS + b"g left\nusemtl red\nf 1 2 3\ng right\nusemtl blue\ns 1\nf 1 3 4\n",
        POINTS + b"f 1 2 \\\n3\nf 1 \\\r\n3 4\n",
        POINTS.replace(b"\n", b" 1.0 0.5 0.5 0.5 # grey\r\n") + b"  f\t1 2 3\r\nf 1 3 4",
        b"mtllib a.mtl\no a\nv 0 0 0\nv 1 0 0\nv 1 1 0\nf 1 2 3\no b\nv 0 1 0\nf 1 3 4\nl 1 2\np 1\n",
        b"f 1 2 3\nf 1 3 4\n" + POINTS,
    ],
)
def test_reads(data):
    mesh = parse_obj(data, ReadLimits())
    np.testing.assert_array_equal(mesh.faces, SQUARE)
    np.testing.assert_array_equal(mesh.vertices, [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]])


def test_negative_indices_count_from_their_own_line():
    mesh = parse_obj(b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf -3 -2 -1\nv 5 0 0\nf -1 -2 -3\n", ReadLimits())
    np.testing.assert_array_equal(mesh.faces, [[0, 1, 2], [3, 2, 1]])


def test_mixed_polygons_stay_in_file_order():
    mesh = parse_obj(POINTS + b"v 2 2 2\nf 1 2 3 4\nf 3 4 5\nf 1 2 3 4 5\nf 2 3 5\n", ReadLimits())
    expected = [[0, 1, 2], [0, 2, 3], [2, 3, 4], [0, 1, 2], [0, 2, 3], [0, 3, 4], [1, 2, 4]]
    np.testing.assert_array_equal(mesh.faces, expected)


@pytest.mark.parametrize(
    ("data", "message"),
    [
        (POINTS, "point cloud"),
        (b"f 1 2 3\n", "`v` and `f` lines"),
        (b"v 0 0\nf 1 1 1\n", "`v` lines"),
        (b"v 0 0 zero\nf 1 1 1\n", "`v` lines"),
        (POINTS + b"f 1 2\n", "at least 3 corners"),
        (POINTS + b"f 1 2 x\n", "whole numbers"),
        (POINTS + b"f 1 2 /3\n", "at least 3 corners"),
        (POINTS + b"f 1 2 3\nf 1 0 2\n", "line 6 has 0"),
        (POINTS + b"f 1 2 -5\n", "line 5 has -5 after 4 vertices"),
        (b"v 0 0 0\0", "must be text"),
    ],
)
def test_refuses(data, message):
    with pytest.raises(FileFormatError, match=message):
        parse_obj(data, ReadLimits())
