import numpy as np
from hypothesis import given, settings

from partwise.geometry.manifold import ManifoldReport, manifold_report
from partwise.mesh import TriMesh
from partwise.testing.meshes import closed_meshes, soups

POINTS = np.array([[0.0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1], [2, 2, 2], [3, 2, 2], [2, 3, 2], [1, 1, 3]])
TETRAHEDRON = [[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]]


def _report(faces: list[list[int]]) -> ManifoldReport:
    return manifold_report(TriMesh(POINTS, np.array(faces)))


@settings(max_examples=30)
@given(closed_meshes())
def test_a_closed_oriented_mesh_in_one_piece_is_clean(mesh: TriMesh) -> None:
    assert manifold_report(mesh).is_clean


@settings(max_examples=50)
@given(soups())
def test_any_mesh_gets_a_report(mesh: TriMesh) -> None:
    report = manifold_report(mesh)
    assert 1 <= report.n_components <= mesh.n_faces
    assert report.n_duplicate_faces < mesh.n_faces


def test_a_missing_face_opens_three_edges() -> None:
    report = _report(TETRAHEDRON[1:])
    assert report.n_boundary_edges == 3
    assert not report.is_closed
    assert report.is_manifold
    assert not report.is_clean


def test_a_third_face_on_an_edge_is_not_manifold() -> None:
    report = _report([*TETRAHEDRON, [0, 1, 4]])
    assert report.n_nonmanifold_edges == 1
    assert not report.is_manifold


def test_two_fans_at_a_vertex_are_not_manifold() -> None:
    report = _report([[0, 1, 2], [0, 4, 5]])
    assert (report.n_nonmanifold_vertices, report.n_nonmanifold_edges) == (1, 0)
    assert not report.is_manifold
    assert report.n_components == 2


def test_a_face_turned_over_disagrees_along_its_edges() -> None:
    report = _report([TETRAHEDRON[0][::-1], *TETRAHEDRON[1:]])
    assert report.n_misoriented_edges == 3
    assert not report.is_clean


def test_duplicates_count_whatever_their_first_corner_and_direction() -> None:
    assert _report([*TETRAHEDRON, [1, 0, 2], [1, 2, 0]]).n_duplicate_faces == 2


def test_separate_bodies_are_components() -> None:
    report = _report([*TETRAHEDRON, [4, 6, 5], [4, 5, 7], [5, 6, 7], [6, 4, 7]])
    assert report.n_components == 2
    assert report.is_closed
    assert report.is_manifold
    assert not report.is_clean


def test_a_degenerate_faces_loop_is_no_open_edge() -> None:
    report = _report([*TETRAHEDRON, [1, 1, 1]])
    assert report.n_degenerate_faces == 1
    assert report.is_closed
    assert not report.is_clean
