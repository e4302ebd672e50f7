"""STL: ASCII or binary by content, soup to mesh by exact position."""

import numpy as np
import pytest

from partwise.errors import FileFormatError
from partwise.io.limits import ReadLimits
from partwise.io.stl import format_stl, parse_stl
from partwise.mesh import TriMesh

SQUARE = TriMesh(np.array([[0.0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]]), np.array([[0, 1, 2], [0, 2, 3]]))


def facet(*points):
    lines = "\n".join(f"   VERTEX {x} {y} {z}" for x, y, z in points)
    return f" facet normal 0 0 1\n  outer loop\n{lines}\n  endloop\n endfacet\n"


ASCII = "solid square\n" + "".join(facet(*SQUARE.vertices[face]) for face in SQUARE.faces) + "endsolid square\n"


def test_ascii():
    mesh = parse_stl(ASCII.encode(), ReadLimits())
    np.testing.assert_array_equal(mesh.vertices, SQUARE.vertices)
    np.testing.assert_array_equal(mesh.faces, SQUARE.faces)


def test_several_solids_are_read_in_order():
    first, second = (f"solid {k}\n{facet(*SQUARE.vertices[face])}endsolid {k}\n" for k, face in enumerate(SQUARE.faces))
    np.testing.assert_array_equal(parse_stl((first + second).encode(), ReadLimits()).faces, SQUARE.faces)


def test_a_vertex_at_minus_zero_is_welded_to_zero():
    text = ASCII.replace("VERTEX 0.0 0.0 0.0", "VERTEX -0.0 0.0 0.0", 1)
    assert parse_stl(text.encode(), ReadLimits()).n_vertices == 4


def test_close_vertices_are_not_welded():
    text = ASCII.replace("VERTEX 0.0 0.0 0.0", "VERTEX 1e-300 0.0 0.0", 1)
    assert parse_stl(text.encode(), ReadLimits()).n_vertices == 5


def test_binary_that_starts_with_solid():
    data = b"solid as exporters like it".ljust(80) + format_stl(SQUARE)[80:]
    np.testing.assert_array_equal(parse_stl(data, ReadLimits()).faces, SQUARE.faces)


def test_padding_after_binary_facets():
    np.testing.assert_array_equal(parse_stl(format_stl(SQUARE) + b"\0" * 7, ReadLimits()).faces, SQUARE.faces)


def test_written_normals_are_unit_or_zero():
    mesh = TriMesh(SQUARE.vertices, np.array([[0, 1, 2], [0, 0, 1]]))
    data = format_stl(mesh)
    normals = [np.frombuffer(data, "<f4", 3, 84 + 50 * k).tolist() for k in range(2)]
    assert normals == [[0, 0, 1], [0, 0, 0]]


@pytest.mark.parametrize(
    ("data", "message"),
    [
        (ASCII.replace("endsolid", "").encode(), "endsolid"),
        (ASCII.replace("VERTEX 1.0 1.0 0.0\n", "\n", 1).encode(), "2 facets have 5"),
        (ASCII.replace("VERTEX 1.0 1.0 0.0", "VERTEX 1.0 one 0.0", 1).encode(), "vertex lines"),
        (ASCII.replace("VERTEX 1.0 1.0 0.0", "VERTEX 1.0 1.0", 1).encode(), "vertex lines"),
        (format_stl(SQUARE)[:-1], "truncated"),
        (b"no stl at all", "truncated or not STL"),
        (b"solid nothing\nendsolid nothing\n", "has? facets but has 0|must have facets but has 0"),
    ],
)
def test_refuses(data, message):
    with pytest.raises(FileFormatError, match=message):
        parse_stl(data, ReadLimits())
