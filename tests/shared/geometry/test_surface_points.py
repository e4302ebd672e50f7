"""Points lie on their faces and are shared out by area."""

import numpy as np
import pytest
from hypothesis import given, settings

from partwise.errors import ParameterError
from partwise.geometry.faces import face_centroids
from partwise.geometry.surface_points import surface_points
from partwise.mesh import TriMesh
from partwise.testing.meshes import meshes

UNEQUAL = TriMesh(np.array([[0, 0, 0], [3, 0, 0], [0, 1, 0], [-1, 0, 0.0]]), np.array([[0, 1, 2], [0, 2, 3]]))


@settings(max_examples=30, deadline=None)
@given(mesh=meshes())
def test_every_face_has_a_point_and_the_first_is_its_centroid(mesh: TriMesh) -> None:
    found = surface_points(mesh, 50, 20)
    faces, first = np.unique(found.faces, return_index=True)
    np.testing.assert_array_equal(faces, np.arange(mesh.n_faces))
    scale = np.abs(mesh.vertices).max() + 1e-300
    np.testing.assert_allclose(found.points[first] / scale, face_centroids(mesh) / scale, atol=1e-12)


def test_points_lie_within_their_triangle() -> None:
    found = surface_points(UNEQUAL, 1_000, 1_000)
    x, y, _ = found.points[found.faces == 0].T
    assert ((x >= 0) & (y >= 0) & (x / 3 + y <= 1 + 1e-12)).all()


def test_points_are_shared_out_by_area() -> None:
    counts = np.bincount(surface_points(UNEQUAL, 400, 1_000).faces)
    np.testing.assert_array_equal(counts, [300, 100])


def test_points_are_spread_evenly_over_a_triangle() -> None:
    points = surface_points(UNEQUAL, 4_000, 4_000)
    mean = points.points[points.faces == 0].mean(axis=0)
    np.testing.assert_allclose(mean, [1.0, 1.0 / 3.0, 0.0], atol=0.01)


def test_no_face_has_more_than_is_allowed() -> None:
    assert np.bincount(surface_points(UNEQUAL, 400, 7).faces).tolist() == [7, 7]


@pytest.mark.parametrize(("n_points", "max_per_face"), [(-1, 1), (1, 0)])
def test_a_count_out_of_range_is_refused(n_points: int, max_per_face: int) -> None:
    with pytest.raises(ParameterError, match="raise them"):
        surface_points(UNEQUAL, n_points, max_per_face)
