"""Random damage ends in a mesh or a FileFormatError, never in another exception or a warning."""

import warnings

import numpy as np
import pytest

from partwise.errors import FileFormatError
from partwise.io.limits import ReadLimits
from partwise.io.read import MESH_SUFFIXES, read_mesh
from partwise.io.write import write_mesh
from partwise.mesh import TriMesh

MESH = TriMesh(np.random.default_rng(0).normal(size=(6, 3)), np.array([[0, 1, 2], [1, 2, 3], [3, 4, 5]]))
ASCII_PLY = (
    b"ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
    b"element face 2\nproperty list uchar int vertex_index\nend_header\n0 0 0\n1 2e3 0\n0 1 0\n3 0 1 2\n3 0 2 1\n"
)
ASCII_STL = (
    b"solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\nendsolid"
)


def damaged(data, rng):
    """A few bytes changed, dropped or repeated."""
    array = bytearray(data)
    for _ in range(rng.integers(1, 4)):
        at = int(rng.integers(len(array)))
        match rng.integers(4):
            case 0:
                array[at] = int(rng.integers(256))
            case 1:
                array[at] = int(rng.choice(list(b"0123456789-. \nen")))
            case 2:
                del array[at : at + int(rng.integers(1, 9))]
            case _:
                array[at:at] = array[at : at + int(rng.integers(1, 9))]
        if not array:
            break
    return bytes(array)


def survives(name, data, rng):
    outcomes = set()
    for _ in range(400):
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            try:
                outcomes.add(type(read_mesh(name, damaged(data, rng), ReadLimits(max_faces=1000))))
            except FileFormatError:
                outcomes.add(FileFormatError)
    return outcomes


@pytest.mark.parametrize("suffix", sorted(MESH_SUFFIXES))
def test_written_files(suffix, tmp_path):
    write_mesh(MESH, tmp_path / f"shape{suffix}")
    data = (tmp_path / f"shape{suffix}").read_bytes()
    assert survives(f"shape{suffix}", data, np.random.default_rng(1)) == {TriMesh, FileFormatError}


@pytest.mark.parametrize(("name", "data"), [("shape.ply", ASCII_PLY), ("shape.stl", ASCII_STL)])
def test_text_variants(name, data):
    assert survives(name, data, np.random.default_rng(2)) == {TriMesh, FileFormatError}
