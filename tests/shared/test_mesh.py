"""TriMesh: what it refuses, that it cannot change, and that its hash is the mesh's identity."""

import dataclasses

import numpy as np
import pytest

from partwise.errors import MeshError
from partwise.mesh import TriMesh

VERTICES = np.array([[0.0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]])
FACES = np.array([[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]])
TETRAHEDRON_HASH = "38905dd5791f773e9c91c1a18bb51ac2a0c5320834859d470bb55300522f8281"


@pytest.mark.parametrize(
    ("vertices", "faces", "message"),
    [
        (np.zeros((0, 3)), FACES, "non-empty"),
        (np.zeros((4, 2)), FACES, r"\(4, 2\)"),
        (np.zeros(12), FACES, r"\(12,\)"),
        (VERTICES, np.zeros((0, 3), dtype=int), "point cloud"),
        (VERTICES, np.zeros((2, 4), dtype=int), "triangulated"),
        (VERTICES, np.zeros(3, dtype=int), r"\(3,\)"),
        (VERTICES * [[1], [np.nan], [1], [1]], FACES, "row 1"),
        (VERTICES + np.array([[0], [0], [np.inf], [0]]), FACES, "row 2"),
        (VERTICES, FACES + 1, "index 4 but there are 4 vertices"),
        (VERTICES, FACES - 1, "index -1"),
        ([["a", "b", "c"]], FACES, "numeric"),
        ([[0, 0, 0], [1]], FACES, "numeric"),
    ],
)
def test_refuses(vertices, faces, message):
    with pytest.raises(MeshError, match=message):
        TriMesh(vertices, faces)


def test_arrays_are_float64_and_int64():
    mesh = TriMesh(VERTICES.astype(np.float32), FACES.astype(np.uint16))
    assert (mesh.vertices.dtype, mesh.faces.dtype) == (np.float64, np.int64)


def test_counts():
    mesh = TriMesh(VERTICES, FACES)
    assert (mesh.n_vertices, mesh.n_faces) == (4, 4)


def test_degenerate_and_duplicate_faces_are_kept():
    faces = np.array([[0, 0, 1], [0, 1, 2], [0, 1, 2]])
    np.testing.assert_array_equal(TriMesh(VERTICES, faces).faces, faces)


@pytest.mark.parametrize("name", ["vertices", "faces"])
def test_arrays_cannot_be_written(name):
    with pytest.raises(ValueError, match="read-only"):
        getattr(TriMesh(VERTICES, FACES), name)[0, 0] = 7


def test_fields_cannot_be_replaced():
    with pytest.raises(dataclasses.FrozenInstanceError):
        TriMesh(VERTICES, FACES).faces = FACES


def test_later_changes_of_the_callers_arrays_do_not_reach_the_mesh():
    vertices, faces = VERTICES.copy(), FACES.copy()
    mesh = TriMesh(vertices, faces)
    vertices[:] = 5.0
    faces[:] = 0
    np.testing.assert_array_equal(mesh.vertices, VERTICES)
    np.testing.assert_array_equal(mesh.faces, FACES)


def test_callers_arrays_stay_writable():
    vertices = VERTICES.copy()
    TriMesh(vertices, FACES)
    assert vertices.flags.writeable


def test_hash_is_that_of_every_release():
    assert TriMesh(VERTICES, FACES).content_hash() == TETRAHEDRON_HASH


def test_hash_takes_minus_zero_for_zero():
    assert TriMesh(np.where(VERTICES == 0, -0.0, VERTICES), FACES).content_hash() == TETRAHEDRON_HASH


def test_hash_survives_float32():
    vertices = VERTICES / 3.0
    stored = vertices.astype(np.float32)
    assert TriMesh(vertices, FACES).content_hash() == TriMesh(stored, FACES.astype(np.uint32)).content_hash()


def test_hash_sees_the_next_float32():
    vertices = VERTICES.copy()
    vertices[0, 0] = np.nextafter(np.float32(0), np.float32(1))
    assert TriMesh(vertices, FACES).content_hash() != TETRAHEDRON_HASH


@pytest.mark.parametrize("faces", [FACES[::-1], FACES[:, [1, 2, 0]], FACES[:3]])
def test_hash_sees_face_order_corner_order_and_count(faces):
    assert TriMesh(VERTICES, faces).content_hash() != TETRAHEDRON_HASH


def test_hash_sees_unused_vertices():
    assert TriMesh(np.concatenate([VERTICES, [[9, 9, 9]]]), FACES).content_hash() != TETRAHEDRON_HASH
