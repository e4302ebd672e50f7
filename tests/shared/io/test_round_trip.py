"""What is written is what is read, for every format and any mesh the format can hold."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra import numpy as arrays

from partwise.io.limits import ReadLimits
from partwise.io.read import MESH_SUFFIXES, read_mesh
from partwise.io.write import write_mesh
from partwise.mesh import TriMesh

EXACT = [".obj", ".off"]
FLOAT32 = [".glb", ".ply", ".stl"]
WELDED = [".glb", ".stl"]


@st.composite
def meshes(draw, width=64):
    """Any mesh: degenerate, duplicate, non-manifold faces, unused and repeated vertices."""
    n, m = draw(st.integers(1, 12)), draw(st.integers(1, 20))
    bound = 1e30 if width == 32 else 1e300
    element = st.floats(-bound, bound, width=width) if width == 64 else st.floats(-(2.0**99), 2.0**99, width=32)
    vertices = draw(arrays.arrays(np.float64, (n, 3), elements=element))
    faces = draw(arrays.arrays(np.int64, (m, 3), elements=st.integers(0, n - 1)))
    return TriMesh(vertices, faces)


@st.composite
def soups(draw):
    """Meshes whose vertices differ and are numbered by first use, as a welded soup's are."""
    mesh = draw(meshes(width=32))
    used, first, inverse = np.unique(mesh.faces, return_index=True, return_inverse=True)
    order = np.argsort(first)
    rank = np.argsort(order)
    vertices = np.stack([np.arange(len(used)), draw(st.floats(-1, 1, width=32)) * np.arange(len(used)) ** 2] * 2, 1)
    return TriMesh(vertices[:, :3].astype(np.float32), rank[inverse.reshape(mesh.faces.shape)])


def written_and_read(mesh, suffix, tmp_path_factory):
    path = tmp_path_factory.mktemp("mesh") / f"shape{suffix}"
    write_mesh(mesh, path)
    return read_mesh(path)


def test_every_format_is_covered():
    assert set(EXACT) | set(FLOAT32) == MESH_SUFFIXES


@pytest.mark.parametrize("suffix", EXACT)
@given(mesh=meshes())
@settings(max_examples=40, deadline=None)
def test_text_formats_keep_every_bit(mesh, suffix, tmp_path_factory):
    again = written_and_read(mesh, suffix, tmp_path_factory)
    np.testing.assert_array_equal(again.vertices, mesh.vertices)
    np.testing.assert_array_equal(again.faces, mesh.faces)


@given(mesh=meshes(width=32))
@settings(max_examples=40, deadline=None)
def test_ply_keeps_float32_and_all_faces(mesh, tmp_path_factory):
    again = written_and_read(mesh, ".ply", tmp_path_factory)
    np.testing.assert_array_equal(again.vertices, mesh.vertices)
    np.testing.assert_array_equal(again.faces, mesh.faces)


@pytest.mark.parametrize("suffix", WELDED)
@given(mesh=soups())
@settings(max_examples=40, deadline=None)
def test_welding_formats_keep_meshes_of_distinct_vertices(mesh, suffix, tmp_path_factory):
    again = written_and_read(mesh, suffix, tmp_path_factory)
    np.testing.assert_array_equal(again.vertices, mesh.vertices)
    np.testing.assert_array_equal(again.faces, mesh.faces)


@pytest.mark.parametrize("suffix", WELDED)
@given(mesh=meshes(width=32))
@settings(max_examples=40, deadline=None)
def test_welding_formats_keep_every_corners_position(mesh, suffix, tmp_path_factory):
    again = written_and_read(mesh, suffix, tmp_path_factory)
    np.testing.assert_array_equal(again.vertices[again.faces], mesh.vertices[mesh.faces])


@pytest.mark.parametrize("suffix", FLOAT32)
def test_binary_formats_round_to_float32(suffix, tmp_path):
    mesh = TriMesh(np.array([[1 / 3, 0, 0], [0, 2 / 3, 0], [0, 0, 1e-9]]), np.array([[0, 1, 2]]))
    write_mesh(mesh, tmp_path / f"shape{suffix}")
    assert read_mesh(tmp_path / f"shape{suffix}").content_hash() == mesh.content_hash()


@pytest.mark.parametrize("suffix", [".off", ".ply", ".glb"])
def test_face_colours_leave_the_mesh_as_it_is(suffix, tmp_path):
    mesh = TriMesh(np.eye(4)[:, :3] * [1, 2, 3], np.array([[0, 1, 2], [0, 3, 1], [2, 1, 3]]))
    write_mesh(mesh, tmp_path / f"shape{suffix}", np.array([[255, 0, 0], [0, 9, 0], [1, 2, 3]], dtype=np.uint8))
    assert read_mesh(tmp_path / f"shape{suffix}").content_hash() == mesh.content_hash()


@pytest.mark.parametrize("suffix", sorted(MESH_SUFFIXES))
def test_bytes_read_as_the_file_does(suffix, tmp_path):
    mesh = TriMesh(np.eye(3), np.array([[0, 1, 2]]))
    path = tmp_path / f"shape{suffix}"
    write_mesh(mesh, path)
    again = read_mesh(f"s3://bucket/folder/other{suffix.upper()}", path.read_bytes())
    assert again.content_hash() == mesh.content_hash()


@pytest.mark.parametrize("suffix", sorted(MESH_SUFFIXES))
def test_a_mesh_at_the_limit_is_read(suffix, tmp_path):
    path = tmp_path / f"shape{suffix}"
    write_mesh(TriMesh(np.eye(3), np.array([[0, 1, 2], [0, 2, 1]])), path)
    assert read_mesh(path, limits=ReadLimits(max_bytes=path.stat().st_size, max_faces=2)).n_faces == 2
