import numpy as np
import trimesh
from hypothesis import given, settings

from partwise.geometry.faces import face_areas
from partwise.geometry.vertices import vertex_areas, vertex_normals
from partwise.mesh import TriMesh
from partwise.testing.meshes import meshes


@settings(max_examples=50)
@given(meshes())
def test_shares_add_up_to_the_area(mesh: TriMesh) -> None:
    np.testing.assert_allclose(vertex_areas(mesh).sum(), face_areas(mesh).sum(), rtol=1e-9)


@settings(max_examples=50)
@given(meshes())
def test_normals_are_of_unit_length_or_zero(mesh: TriMesh) -> None:
    length = np.linalg.norm(vertex_normals(mesh), axis=1)
    assert np.all(np.isclose(length, 1) | (length == 0))


def test_normals_of_a_sphere_point_outwards() -> None:
    ball = trimesh.creation.icosphere(subdivisions=3)
    np.testing.assert_allclose(vertex_normals(TriMesh(ball.vertices, ball.faces)), ball.vertices, atol=0.02)


def test_two_sides_of_one_face_leave_no_normal() -> None:
    mesh = TriMesh(np.eye(3), np.array([[0, 1, 2], [2, 1, 0]]))
    np.testing.assert_array_equal(vertex_normals(mesh), 0)
