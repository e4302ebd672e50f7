import numpy as np
import pytest

from partwise.errors import DegenerateMeshError
from partwise.mesh import TriMesh
from partwise.render.views import N_VIEWS, VIEW_SIZE, fit_unit_sphere, nearness, pixel_centres, view_frames


def test_frames_are_orthonormal_and_right_handed() -> None:
    frames = view_frames()
    np.testing.assert_allclose(frames @ frames.transpose(0, 2, 1), np.broadcast_to(np.eye(3), (20, 3, 3)), atol=1e-12)
    np.testing.assert_allclose(np.linalg.det(frames), 1.0)


def test_cameras_stand_at_the_vertices_of_a_regular_dodecahedron() -> None:
    towards = view_frames()[:, 2]
    cosines = np.sort(towards @ towards.T, axis=1)[:, ::-1]
    # Each vertex of a dodecahedron has itself, 3 neighbours, 6 + 6 further ones, 3, and its opposite.
    root5 = np.sqrt(5)
    expected = np.repeat([1.0, root5 / 3, 1 / 3, -1 / 3, -root5 / 3, -1.0], [1, 3, 6, 6, 3, 1])
    np.testing.assert_allclose(cosines, np.broadcast_to(expected, (N_VIEWS, N_VIEWS)), atol=1e-12)


def test_pixel_centres_are_symmetric_about_the_optical_axis() -> None:
    centres = pixel_centres()
    np.testing.assert_allclose(centres, -centres[::-1], atol=1e-15)
    assert len(centres) == VIEW_SIZE
    assert centres[-1] == pytest.approx(1 - 1 / VIEW_SIZE)


def test_fitted_vertices_touch_the_unit_sphere(meshes: dict[str, TriMesh]) -> None:
    for mesh in meshes.values():
        used = fit_unit_sphere(mesh)[np.unique(mesh.faces)]
        assert np.linalg.norm(used, axis=1).max() == pytest.approx(1.0)


def test_fit_ignores_vertices_without_faces() -> None:
    vertices = np.array([[0.0, 0, 0], [2, 0, 0], [0, 2, 0], [99, 99, 99]])
    fitted = fit_unit_sphere(TriMesh(vertices, np.array([[0, 1, 2]])))
    np.testing.assert_allclose(fitted[:3], np.array([[-1, -1, 0], [1, -1, 0], [-1, 1, 0]]) / np.sqrt(2))


def test_fit_undoes_scale_and_place(meshes: dict[str, TriMesh]) -> None:
    mesh = meshes["open bowl"]
    moved = TriMesh(mesh.vertices * 37.0 + [1.0, -2.0, 3.0], mesh.faces)
    np.testing.assert_allclose(fit_unit_sphere(moved), fit_unit_sphere(mesh), atol=1e-12)


def test_a_mesh_without_extent_is_refused() -> None:
    with pytest.raises(DegenerateMeshError, match=r"extent .*\[1\.0, 2\.0, 3\.0\]"):
        fit_unit_sphere(TriMesh(np.array([[1.0, 2.0, 3.0]] * 3), np.array([[0, 1, 2]])))


def test_nearness_is_linear_clipped_and_never_background() -> None:
    values = nearness(np.array([-2.0, -1.0, 0.0, 1.0, 2.0]))
    np.testing.assert_allclose(values, [1 / 255, 1 / 255, 128 / 255, 1.0, 1.0], rtol=1e-6)
    assert values.dtype == np.float32
