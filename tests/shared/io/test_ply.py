"""PLY: three encodings, any properties, mixed polygons in order."""

import struct

import numpy as np
import pytest

from partwise.errors import FileFormatError
from partwise.io.limits import ReadLimits
from partwise.io.ply import parse_ply, parse_ply_face_property
from partwise.io.ply_elements import parse_elements, parse_header

POINTS = [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]]
HEADER = (
    "ply\nformat {encoding} 1.0\ncomment made by hand\nelement note 2\nproperty list uchar short words\n"
    "element vertex 4\nproperty uchar flag\nproperty double x\nproperty float y\nproperty float z\n"
    "element face {n}\nproperty short label\nproperty list uchar uint vertex_indices\nproperty list int float uv\n"
    "end_header\n"
)


def ply(encoding, polygons, uv=(0.5, 0.25)):
    """The same content in any encoding: an element to skip, extra properties on both sides of what matters."""
    header = HEADER.format(encoding=encoding, n=len(polygons)).encode()
    if encoding == "ascii":
        lines = ["1 7", "2 8 9", *(f"5 {x} {y} {z}" for x, y, z in POINTS)]
        lines += [
            f"{k} {len(p)} {' '.join(map(str, p))} {len(uv)} {' '.join(map(str, uv))}" for k, p in enumerate(polygons)
        ]
        return header + "\n".join(lines).encode()
    order = "<" if encoding.endswith("little_endian") else ">"
    body = struct.pack(f"{order}BhBhh", 1, 7, 2, 8, 9)
    body += b"".join(struct.pack(f"{order}Bdff", 5, *point) for point in POINTS)
    for k, p in enumerate(polygons):
        body += struct.pack(f"{order}hB{len(p)}Ii{len(uv)}f", k, len(p), *p, len(uv), *uv)
    return header + body


ENCODINGS = ["ascii", "binary_little_endian", "binary_big_endian"]


@pytest.mark.parametrize("encoding", ENCODINGS)
def test_triangles(encoding):
    mesh = parse_ply(ply(encoding, [[0, 1, 2], [0, 2, 3]]), ReadLimits())
    np.testing.assert_array_equal(mesh.vertices, POINTS)
    np.testing.assert_array_equal(mesh.faces, [[0, 1, 2], [0, 2, 3]])


@pytest.mark.parametrize("encoding", ENCODINGS)
def test_mixed_polygons_stay_in_file_order(encoding):
    mesh = parse_ply(ply(encoding, [[0, 1, 2, 3], [0, 2, 3], [3, 2, 1, 0], [1, 2, 3]]), ReadLimits())
    np.testing.assert_array_equal(mesh.faces, [[0, 1, 2], [0, 2, 3], [0, 2, 3], [3, 2, 1], [3, 1, 0], [1, 2, 3]])


@pytest.mark.parametrize("encoding", ENCODINGS)
@pytest.mark.parametrize("polygons", [[[0, 1, 2], [0, 2, 3]], [[0, 1, 2, 3], [0, 2, 3]]])
def test_face_property(encoding, polygons):
    np.testing.assert_array_equal(parse_ply_face_property(ply(encoding, polygons), "label"), [0, 1])


@pytest.mark.parametrize("name", ["missing", "vertex_indices"])
def test_face_property_must_be_a_number(name):
    with pytest.raises(FileFormatError, match=f"number '{name}'"):
        parse_ply_face_property(ply("ascii", [[0, 1, 2]]), name)


@pytest.mark.parametrize("encoding", ENCODINGS)
def test_empty_lists(encoding):
    assert parse_ply(ply(encoding, [[0, 1, 2]], uv=()), ReadLimits()).n_faces == 1


@pytest.mark.parametrize("encoding", ENCODINGS)
def test_cut_anywhere(encoding):
    whole = ply(encoding, [[0, 1, 2, 3], [0, 2, 3]])
    for n_bytes in range(0, len(whole) - 4):
        with pytest.raises(FileFormatError):
            parse_ply(whole[:n_bytes], ReadLimits())


def test_header_with_windows_line_ends():
    data = ply("binary_little_endian", [[0, 1, 2]])
    header, _, body = data.partition(b"end_header\n")
    data = (header + b"end_header\n").replace(b"\n", b"\r\n") + body
    np.testing.assert_array_equal(parse_ply(data, ReadLimits()).faces, [[0, 1, 2]])


def test_element_without_records():
    data = ply("binary_little_endian", [])
    assert len(parse_elements(data, parse_header(data), ReadLimits())["face"]["label"]) == 0


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        (b"ply\n", b"plyx\n", "must start with a line ply"),
        (b"end_header", b"", "end_header"),
        (b"format ascii 1.0\n", b"", "format line"),
        (b"format ascii 1.0", b"format ascii 2.0", "known lines"),
        (b"element vertex 4", b"element vertex four", "known lines"),
        (b"element vertex 4", b"element vertex -4", "known lines"),
        (b"property double x", b"property quad x", "known lines"),
        (b"property double x", b"property double w", "x, y and z"),
        (b"element face 1", b"element tristrips 1", "expand the strips"),
        (b"element vertex", b"element points", "vertex and face"),
        (b"vertex_indices", b"corners", "list vertex_indices"),
        (b"\n0 3 0 1 2", b"\n0 3 0 1 2.5", "whole numbers"),
        (b"\n0 3 0 1 2", b"\n0 3 0 1 two", "must be numbers"),
        (b"\n0 3 0 1 2", b"\n0 -3 0 1 2", "truncated"),
        (b"\n0 3 0 1 2 2 0.5 0.25", b"\n0 3 0 1 2", "truncated"),
        (b"\n0 3 0 1 2", b"\n0 2 0 1", "at least 3 corners"),
    ],
)
def test_refuses(old, new, message):
    data = ply("ascii", [[0, 1, 2]])
    assert old in data
    with pytest.raises(FileFormatError, match=message):
        parse_ply(data.replace(old, new), ReadLimits())


def test_negative_length_in_binary():
    data = ply("binary_little_endian", [[0, 1, 2]])
    length = struct.pack("<i", 2) + struct.pack("<f", 0.5)
    with pytest.raises(FileFormatError, match="length ≥ 0"):
        parse_ply(data.replace(length, struct.pack("<if", -2, 0.5)), ReadLimits())


def test_a_count_that_is_a_lie_takes_no_memory():
    data = ply("binary_little_endian", [[0, 1, 2]]).replace(b"element vertex 4", b"element vertex 4000000")
    with pytest.raises(FileFormatError, match="truncated"):
        parse_ply(data, ReadLimits())


def test_a_list_length_that_is_a_lie_takes_no_memory():
    data = ply("binary_little_endian", [[0, 1, 2]])
    length = struct.pack("<i", 2) + struct.pack("<f", 0.5)
    with pytest.raises(FileFormatError, match="truncated"):
        parse_ply(data.replace(length, struct.pack("<if", 2**31 - 1, 0.5)), ReadLimits())
