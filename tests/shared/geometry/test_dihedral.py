import numpy as np
import pytest
import trimesh
from hypothesis import given, settings

from partwise.geometry.adjacency import edge_adjacency
from partwise.geometry.dihedral import is_concave, normal_angles
from partwise.mesh import TriMesh
from partwise.testing.meshes import meshes


def _hinge(height: float) -> TriMesh:
    """Two faces joined along the y axis; the far corner of the second at `height`."""
    vertices = np.array([[0.0, 0, 0], [0, 1, 0], [-1, 0, 0], [1, 0, height]])
    return TriMesh(vertices, np.array([[0, 1, 2], [1, 0, 3]]))


@pytest.mark.parametrize(("height", "degrees"), [(0.0, 0), (1.0, 45), (-1.0, 45), (np.sqrt(3), 60)])
def test_angle_between_normals_is_that_of_the_fold(height: float, degrees: float) -> None:
    mesh = _hinge(height)
    np.testing.assert_allclose(np.degrees(normal_angles(mesh, edge_adjacency(mesh))), [degrees], atol=1e-5)


@pytest.mark.parametrize(("height", "concave"), [(0.0, False), (1.0, True), (-1.0, False)])
def test_only_a_fold_towards_the_normal_is_concave(height: float, concave: bool) -> None:
    mesh = _hinge(height)
    assert is_concave(mesh, edge_adjacency(mesh)).tolist() == [concave]


def test_box_edges_are_flat_or_right_and_never_concave() -> None:
    box = trimesh.creation.box()
    mesh = TriMesh(box.vertices, box.faces)
    adjacency = edge_adjacency(mesh)
    degrees = np.degrees(normal_angles(mesh, adjacency)).round(6)
    assert sorted(degrees) == [0] * 6 + [90] * 12
    assert not is_concave(mesh, adjacency).any()


def test_a_fold_with_a_degenerate_face_counts_as_a_right_angle() -> None:
    mesh = TriMesh(np.array([[0.0, 0, 0], [0, 1, 0], [1, 0, 0], [0, 2, 0]]), np.array([[0, 1, 2], [1, 0, 3]]))
    np.testing.assert_allclose(normal_angles(mesh, edge_adjacency(mesh)), [np.pi / 2])


@settings(max_examples=30)
@given(meshes())
def test_turning_every_face_over_keeps_the_angles(mesh: TriMesh) -> None:
    turned = TriMesh(mesh.vertices, mesh.faces[:, ::-1])
    adjacency = edge_adjacency(mesh)
    np.testing.assert_allclose(normal_angles(turned, adjacency), normal_angles(mesh, adjacency), atol=1e-6)
