"""Every way a file can be bad ends in one line that names file, rule, value and remedy."""

from functools import reduce
from operator import getitem

import numpy as np
import pytest

from partwise.errors import FileFormatError, ParameterError, StoreError
from partwise.io.atomic import write_atomically
from partwise.io.glb import pack_glb, unpack_glb
from partwise.io.limits import ReadLimits
from partwise.io.read import _PARSERS, MESH_SUFFIXES, read_mesh
from partwise.io.write import write_mesh
from partwise.mesh import TriMesh

SUFFIXES = sorted(MESH_SUFFIXES)
TWO_FACES = TriMesh(np.eye(4)[:, :3], np.array([[0, 1, 2], [1, 2, 3]]))


def refusal(name, data=None, limits=None):
    with pytest.raises(FileFormatError) as caught:
        read_mesh(name, data, limits or ReadLimits())
    message = str(caught.value)
    assert message.startswith(f"{name}: ")
    assert "\n" not in message
    assert ";" in message or "?" in message  # the remedy
    return message


@pytest.fixture
def file_bytes(tmp_path):
    def write(suffix):
        write_mesh(TWO_FACES, tmp_path / f"good{suffix}")
        return (tmp_path / f"good{suffix}").read_bytes()

    return write


@pytest.mark.parametrize("suffix", SUFFIXES)
def test_missing(suffix, tmp_path):
    assert "No such file" in refusal(tmp_path / f"missing{suffix}")


@pytest.mark.parametrize("suffix", SUFFIXES)
def test_a_folder(suffix, tmp_path):
    (tmp_path / f"folder{suffix}").mkdir()
    refusal(tmp_path / f"folder{suffix}")


@pytest.mark.parametrize("suffix", SUFFIXES)
@pytest.mark.parametrize("data", [b"", b"  \n\n"])
def test_empty(suffix, data):
    assert "empty" in refusal(f"shape{suffix}", data)


@pytest.mark.parametrize("suffix", SUFFIXES)
def test_noise(suffix):
    noise = np.random.default_rng(7).integers(0, 256, 3000, dtype=np.uint8).tobytes()
    refusal(f"shape{suffix}", noise)


@pytest.mark.parametrize("suffix", SUFFIXES)
def test_another_formats_file(suffix, file_bytes):
    for other in set(SUFFIXES) - {suffix}:
        refusal(f"shape{suffix}", file_bytes(other))


@pytest.mark.parametrize("suffix", [".off", ".ply", ".stl", ".glb"])
def test_cut_anywhere(suffix, file_bytes):
    whole = file_bytes(suffix).rstrip()
    for n_bytes in range(1, len(whole) - 1):  # the last digit of a text file is not missed
        refusal(f"shape{suffix}", whole[:n_bytes])


def test_obj_cut_before_its_faces(file_bytes):
    whole = file_bytes(".obj")
    assert "truncated" in refusal("shape.obj", whole[: whole.index(b"f")])


@pytest.mark.parametrize("suffix", SUFFIXES)
def test_too_many_bytes(suffix, file_bytes):
    assert "10 bytes" in refusal(f"shape{suffix}", file_bytes(suffix), ReadLimits(max_bytes=10))


def test_too_many_bytes_on_disk_is_known_before_reading(tmp_path):
    write_mesh(TWO_FACES, tmp_path / "shape.off")
    assert "10 bytes" in refusal(tmp_path / "shape.off", None, ReadLimits(max_bytes=10))


@pytest.mark.parametrize("suffix", SUFFIXES)
def test_too_many_faces(suffix, tmp_path):
    path = tmp_path / f"a{suffix}"
    write_mesh(TriMesh(np.eye(3), np.array([[0, 1, 2], [0, 2, 1]])), path)
    assert "may have 1 faces but this one has 2" in refusal(path, limits=ReadLimits(max_faces=1))


@pytest.mark.parametrize(
    ("name", "data"),
    [
        ("shape.off", b"OFF\n3 1 0\n0 0 0\n1 nan 0\n0 1 0\n3 0 1 2\n"),
        ("shape.obj", b"v 0 0 0\nv 1 nan 0\nv 0 1 0\nf 1 2 3\n"),
        ("shape.stl", b"solid\nfacet\nvertex 0 0 0\nvertex 1 nan 0\nvertex 0 1 0\nendfacet\nendsolid"),
        (
            "shape.ply",
            b"ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
            b"element face 1\nproperty list uchar int vertex_index\nend_header\n0 0 0\n1 nan 0\n0 1 0\n3 0 1 2\n",
        ),
    ],
)
def test_nan_in_text(name, data):
    assert "finite" in refusal(name, data)


@pytest.mark.parametrize("suffix", [".ply", ".stl", ".glb"])
def test_nan_in_binary(suffix, file_bytes):
    one, nan = np.float32(1).tobytes(), np.float32(np.nan).tobytes()
    assert "finite" in refusal(f"shape{suffix}", file_bytes(suffix).replace(one, nan))


@pytest.mark.parametrize(
    ("suffix", "old", "new"),
    [
        (".off", b"3 1 2 3", b"3 1 2 9"),
        (".off", b"3 1 2 3", b"3 1 2 -1"),
        (".obj", b"f 2 3 4", b"f 2 3 9"),
        (".obj", b"f 2 3 4", b"f 2 3 0"),
        (".obj", b"f 2 3 4", b"f 2 3 -5"),
        (".ply", b"\x03\x01\0\0\0\x02\0\0\0\x03\0\0\0", b"\x03\x01\0\0\0\x02\0\0\0\x09\0\0\0"),
        (".ply", b"\x03\x01\0\0\0\x02\0\0\0\x03\0\0\0", b"\x03\x01\0\0\0\x02\0\0\0\xff\xff\xff\xff"),
        (".glb", b"\x01\0\0\0\x02\0\0\0\x03\0\0\0", b"\x01\0\0\0\x02\0\0\0\x09\0\0\0"),
    ],
)
def test_index_out_of_range(suffix, old, new, file_bytes):
    data = file_bytes(suffix)
    assert old in data
    assert "index" in refusal(f"shape{suffix}", data.replace(old, new))


@pytest.mark.parametrize(
    ("name", "data"),
    [
        ("shape.off", b"OFF\n1 0 0\n0 0 0\n"),
        ("shape.obj", b"v 0 0 0\n"),
        ("shape.stl", b"solid\nendsolid\n"),
        ("shape.stl", b"\0" * 84),
        (
            "shape.ply",
            b"ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\nproperty float z\n"
            b"element face 0\nproperty list uchar int vertex_index\nend_header\n0 0 0\n",
        ),
    ],
)
def test_no_faces(name, data):
    refusal(name, data)


PLY_OF_FOO = b"ply\nformat ascii 1.0\nelement foo %b\nend_header\n"


@pytest.mark.parametrize(
    ("name", "data"),
    [
        ("shape.ply", PLY_OF_FOO % (b"9" * 5_000)),
        ("shape.ply", PLY_OF_FOO % (b"9" * 18)),
        ("shape.off", b"OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n%d 0 1 2\n" % (2**63 - 1)),
        ("shape.off", b"OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n%b 0 1 2\n" % (b"9" * 5_000)),
        ("shape.off", b"OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 %b\n" % (b"9" * 5_000)),
        ("shape.obj", b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 %b\n" % (b"9" * 5_000)),
    ],
)
def test_numbers_of_absurd_size(name, data):
    refusal(name, data)


@pytest.mark.parametrize(
    ("path", "value"),
    [
        (("accessors", 0, "count"), "abc"),
        (("accessors", 0, "count"), float("nan")),
        (("accessors", 0, "count"), float("inf")),
        (("bufferViews", 0, "byteStride"), "x"),
        (("bufferViews", 0, "byteOffset"), "q"),
        (("buffers", 0, "uri"), "data:;base64,\u00e4"),
    ],
)
def test_values_of_a_glb_that_are_none(path, value, file_bytes):
    document, binary = unpack_glb(file_bytes(".glb"))
    *steps, last = path
    reduce(getitem, steps, document)[last] = value
    refusal("shape.glb", pack_glb(document, binary))


@pytest.mark.parametrize("stumble", [ValueError("so\nand so"), OverflowError(), RecursionError(), MemoryError()])
def test_what_no_parser_foresaw(stumble, monkeypatch):
    def stumbles(_data, _limits):
        raise stumble

    monkeypatch.setitem(_PARSERS, ".off", stumbles)
    assert type(stumble).__name__ in refusal("shape.off", b"OFF")


def test_unknown_suffix():
    assert ".fbx" in refusal("shape.fbx", b"content")


@pytest.mark.parametrize("name", ["max_bytes", "max_faces"])
def test_limits_are_positive(name):
    with pytest.raises(ParameterError, match=name):
        ReadLimits(**{name: 0})


@pytest.mark.parametrize(
    ("name", "mesh", "colours", "message"),
    [
        ("a.fbx", TWO_FACES, None, "suffix"),
        ("a.obj", TWO_FACES, np.zeros((2, 3), dtype=np.uint8), "cannot hold face colours"),
        ("a.stl", TWO_FACES, np.zeros((2, 3), dtype=np.uint8), "cannot hold face colours"),
        ("a.ply", TWO_FACES, np.zeros((1, 3), dtype=np.uint8), r"\(2, 3\) uint8"),
        ("a.ply", TriMesh(TWO_FACES.vertices * 1e39, TWO_FACES.faces), None, "float32"),
    ],
)
def test_writing_refuses_and_leaves_nothing(name, mesh, colours, message, tmp_path):
    with pytest.raises(ParameterError, match=message):
        write_mesh(mesh, tmp_path / name, colours)
    assert not list(tmp_path.iterdir())


def test_colours_must_be_bytes(tmp_path):
    with pytest.raises(ParameterError, match="uint8"):
        write_mesh(TWO_FACES, tmp_path / "a.ply", np.zeros((2, 3)))


def test_a_write_that_fails_keeps_the_old_file(tmp_path, monkeypatch):
    target = tmp_path / "shape.off"
    target.write_bytes(b"old")

    def full_disk(_):
        raise OSError(28, "No space left on device")

    monkeypatch.setattr("os.fsync", full_disk)
    with pytest.raises(StoreError, match="No space left on device"):
        write_atomically(target, b"new")
    assert [path.read_bytes() for path in tmp_path.iterdir()] == [b"old"]


def test_a_folder_is_not_overwritten(tmp_path):
    (tmp_path / "shape.off").mkdir()
    with pytest.raises(StoreError, match=r"shape\.off"):
        write_atomically(tmp_path / "shape.off", b"new")
    assert [path.name for path in tmp_path.iterdir()] == ["shape.off"]


def test_missing_folders_are_made(tmp_path):
    write_atomically(tmp_path / "a" / "b" / "file", b"content")
    assert (tmp_path / "a" / "b" / "file").read_bytes() == b"content"


def test_a_file_in_the_place_of_the_folder_is_named(tmp_path):
    (tmp_path / "folder").write_bytes(b"")
    with pytest.raises(StoreError, match=r"shape\.off: cannot be written: .*; free space or choose another folder"):
        write_atomically(tmp_path / "folder" / "shape.off", b"new")
