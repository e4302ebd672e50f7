import numpy as np
import trimesh
from hypothesis import given, settings

from partwise.geometry.faces import bounding_box_diagonal, face_areas, face_centroids, face_normals
from partwise.mesh import TriMesh
from partwise.testing.meshes import closed_meshes, meshes

RIGHT_TRIANGLE = TriMesh(np.array([[0.0, 0, 0], [3, 0, 0], [0, 4, 0], [9, 9, 9]]), np.array([[0, 1, 2], [1, 1, 2]]))


def test_area_of_a_right_triangle_and_of_a_degenerate_face() -> None:
    np.testing.assert_allclose(face_areas(RIGHT_TRIANGLE), [6, 0])


def test_normal_follows_the_right_hand_and_is_zero_without_area() -> None:
    np.testing.assert_allclose(face_normals(RIGHT_TRIANGLE), [[0, 0, 1], [0, 0, 0]])


def test_centroid_is_the_corners_mean() -> None:
    np.testing.assert_allclose(face_centroids(RIGHT_TRIANGLE)[0], [1, 4 / 3, 0])


def test_diagonal_leaves_out_vertices_without_faces() -> None:
    assert bounding_box_diagonal(RIGHT_TRIANGLE) == 5


def test_box_areas_add_up_to_its_surface() -> None:
    box = trimesh.creation.box(extents=(1, 2, 3))
    assert np.isclose(face_areas(TriMesh(box.vertices, box.faces)).sum(), 22)


@settings(max_examples=30)
@given(closed_meshes())
def test_normals_of_a_closed_mesh_cancel_out_by_area(mesh: TriMesh) -> None:
    total = face_areas(mesh) @ face_normals(mesh)
    np.testing.assert_allclose(total / face_areas(mesh).sum(), 0, atol=1e-9)


@settings(max_examples=50)
@given(meshes())
def test_normals_are_of_unit_length_or_zero(mesh: TriMesh) -> None:
    length = np.linalg.norm(face_normals(mesh), axis=1)
    assert np.all(np.isclose(length, 1) | (length == 0))
