import numpy as np
import pytest
import trimesh
from hypothesis import given, settings
from hypothesis import strategies as st

from partwise.errors import ParameterError
from partwise.geometry.faces import face_areas
from partwise.geometry.geodesics import face_geodesics, face_graph
from partwise.geometry.sampling import farthest_point_faces
from partwise.mesh import TriMesh
from partwise.testing.meshes import meshes


def _sphere() -> TriMesh:
    ball = trimesh.creation.icosphere(subdivisions=3)
    return TriMesh(ball.vertices, ball.faces)


@settings(max_examples=60, deadline=None)
@given(meshes(), st.integers(1, 40))
def test_samples_are_distinct_faces_with_area_in_their_component(mesh: TriMesh, n: int) -> None:
    graph = face_graph(mesh)
    sample = farthest_point_faces(mesh, graph, n)
    has_area = face_areas(mesh) > 0
    assert len(np.unique(sample.faces)) == len(sample.faces)
    assert has_area[sample.faces].all()
    available = np.bincount(graph.component[has_area], minlength=graph.component.max() + 1)
    np.testing.assert_array_equal(np.diff(sample.component_starts), np.minimum(available, n))
    owner = np.repeat(np.arange(len(available)), np.diff(sample.component_starts))
    np.testing.assert_array_equal(graph.component[sample.faces], owner)


@settings(max_examples=60, deadline=None)
@given(meshes(), st.integers(1, 40))
def test_cells_share_out_the_area(mesh: TriMesh, n: int) -> None:
    sample = farthest_point_faces(mesh, face_graph(mesh), n)
    np.testing.assert_allclose(sample.areas.sum(), face_areas(mesh).sum(), rtol=1e-9)
    assert sample.n_cell_faces.sum() == (sample.cell >= 0).sum()


def test_every_face_belongs_to_its_nearest_sample() -> None:
    mesh = _sphere()
    sample = farthest_point_faces(mesh, face_graph(mesh), 20)
    distances = face_geodesics(mesh, sample.faces)
    np.testing.assert_array_equal(distances[sample.cell, np.arange(mesh.n_faces)], distances.min(axis=0))


def test_no_sample_lies_nearer_to_another_than_any_face_does_to_all() -> None:
    mesh = _sphere()
    sample = farthest_point_faces(mesh, face_graph(mesh), 30)
    distances = face_geodesics(mesh, sample.faces)
    apart = distances[:, sample.faces] + np.diag(np.full(30, np.inf))
    assert apart.min() >= distances.min(axis=0).max()


def test_scraps_do_not_take_the_samples_of_the_body() -> None:
    sphere = _sphere()
    corners = np.arange(300).reshape(100, 3)
    scraps = np.random.default_rng(0).random((300, 3)) + 5
    mesh = TriMesh(np.vstack([sphere.vertices, scraps]), np.vstack([sphere.faces, corners + sphere.n_vertices]))
    sample = farthest_point_faces(mesh, face_graph(mesh), 50)
    assert (sample.faces < sphere.n_faces).sum() == 50
    assert (sample.faces >= sphere.n_faces).sum() == 100


def test_neighbours_in_the_list_lie_close() -> None:
    mesh = _sphere()
    sample = farthest_point_faces(mesh, face_graph(mesh), 200)
    distances = face_geodesics(mesh, sample.faces)[:, sample.faces]
    assert np.diagonal(distances, 1).mean() < distances.mean() / 3


def test_fewer_than_one_sample_is_refused() -> None:
    mesh = _sphere()
    with pytest.raises(ParameterError, match="at least 1 but is 0"):
        farthest_point_faces(mesh, face_graph(mesh), 0)
