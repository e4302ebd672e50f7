import numpy as np
import pytest
from hypothesis import given, settings

from partwise.errors import DegenerateMeshError
from partwise.geometry.faces import face_areas, face_centroids
from partwise.geometry.normalise import normalise
from partwise.mesh import TriMesh
from partwise.testing.meshes import closed_meshes


@settings(max_examples=30)
@given(closed_meshes())
def test_centre_is_the_origin_and_a_third_lies_within_half(mesh: TriMesh) -> None:
    normal = normalise(mesh)
    areas = face_areas(normal)
    np.testing.assert_allclose(areas @ face_centroids(normal) / areas.sum(), 0, atol=1e-8)
    distance = np.percentile(np.linalg.norm(face_centroids(normal), axis=1), 33)
    np.testing.assert_allclose(distance, 0.5)


@settings(max_examples=30)
@given(closed_meshes())
def test_doing_it_twice_changes_nothing(mesh: TriMesh) -> None:
    once = normalise(mesh)
    np.testing.assert_allclose(normalise(once).vertices, once.vertices, atol=1e-8)


@settings(max_examples=30)
@given(closed_meshes())
def test_place_and_size_make_no_difference(mesh: TriMesh) -> None:
    moved = TriMesh(mesh.vertices * 7 + [1, -2, 3], mesh.faces)
    np.testing.assert_allclose(normalise(moved).vertices, normalise(mesh).vertices, atol=1e-7)


def test_a_mesh_without_area_is_refused() -> None:
    line = TriMesh(np.array([[0.0, 0, 0], [1, 0, 0], [2, 0, 0]]), np.array([[0, 1, 2]]))
    with pytest.raises(DegenerateMeshError, match="all its faces are degenerate"):
        normalise(line)


def test_a_mesh_at_one_point_is_refused() -> None:
    triangle = TriMesh(np.array([[1.0, 0, 0], [-1, 1, 0], [0, -1, 0]]), np.array([[0, 1, 2]]))
    with pytest.raises(DegenerateMeshError, match="lie at one point"):
        normalise(triangle)
