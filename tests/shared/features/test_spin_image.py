import numba
import numpy as np
import pytest
import trimesh
from hypothesis import given, settings
from scipy.spatial.transform import Rotation

from partwise.errors import ParameterError
from partwise.features.parameters import SpinImageParameters
from partwise.features.spin_image import spin_image
from partwise.geometry.faces import face_centroids, face_normals
from partwise.geometry.normalise import normalise
from partwise.geometry.vertices import vertex_areas, vertex_normals
from partwise.mesh import TriMesh
from partwise.testing.meshes import meshes


def _sphere(subdivisions: int) -> TriMesh:
    ball = trimesh.creation.icosphere(subdivisions=subdivisions)
    return normalise(TriMesh(ball.vertices, ball.faces))


def _bumpy() -> TriMesh:
    """Wide enough to reach beyond the support along and around some axes."""
    ball = trimesh.creation.icosphere(subdivisions=3)
    x, y, z = np.asarray(ball.vertices).T
    radius = 1 + 0.3 * np.sin(3 * x + y) + 0.2 * np.cos(4 * z - x)
    return normalise(TriMesh(ball.vertices * radius[:, None] * [1, 0.5, 4], ball.faces))


def _by_definition(mesh: TriMesh, support: float, n_bins: int) -> np.ndarray:
    width, centres = support / n_bins, np.arange(n_bins) + 0.5
    normals, areas = vertex_normals(mesh), vertex_areas(mesh)
    images = np.zeros((mesh.n_faces, n_bins, n_bins))
    for face, (origin, axis) in enumerate(zip(face_centroids(mesh), face_normals(mesh), strict=True)):
        offset = mesh.vertices - origin
        beta = offset @ axis
        alpha = np.linalg.norm(offset - beta[:, None] * axis, axis=1)
        counts = (normals @ axis >= 0) & (alpha < support)
        line = (np.clip(beta[counts], -support / 2, support / 2) + support / 2) / width
        column = alpha[counts] / width
        square = (line[:, None, None] - centres[:, None]) ** 2 + (column[:, None, None] - centres) ** 2
        weights = np.exp(-square / 0.2)
        weights[weights < 0.02] = 0
        weights *= (areas[counts] / areas.sum() / weights.sum(axis=(1, 2)))[:, None, None]
        images[face] = weights.sum(axis=0)
    return images.reshape(mesh.n_faces, -1)


@pytest.mark.parametrize(("support", "n_bins"), [(2.0, 16), (1.0, 5), (8.0, 1)])
def test_images_follow_the_definition(support: float, n_bins: int) -> None:
    mesh = _bumpy()
    images = spin_image(mesh, SpinImageParameters(support, n_bins))
    np.testing.assert_allclose(images, _by_definition(mesh, support, n_bins), atol=1e-5)


def test_a_face_of_a_sphere_sees_its_half() -> None:
    np.testing.assert_allclose(spin_image(_sphere(4)).sum(axis=1), 0.5, atol=0.02)


def test_faces_of_a_sphere_are_alike() -> None:
    images = spin_image(_sphere(4))
    assert np.corrcoef(images)[0].min() > 0.97


def test_a_sphere_lies_below_each_of_its_faces() -> None:
    images = spin_image(_sphere(4)).reshape(-1, 16, 16)
    # Radius 0.5 in bins of 0.125: the visible half reaches 4 bins down and, with soft bins, one more each way.
    assert images[:, 3:9, :5].sum(axis=(1, 2)).min() > 0.99 * images.sum(axis=(1, 2)).max() * 0.95
    np.testing.assert_array_equal(images[:, :3], 0)
    np.testing.assert_array_equal(images[:, 9:], 0)
    np.testing.assert_array_equal(images[:, :, 5:], 0)


def test_turning_makes_no_difference() -> None:
    mesh = _bumpy()
    turn = Rotation.from_euler("xyz", [0.4, 1.1, -2.0]).as_matrix()
    turned = spin_image(TriMesh(mesh.vertices @ turn.T, mesh.faces))
    assert np.abs(turned - spin_image(mesh)).sum() < 1e-3 * turned.sum()


def test_place_and_size_make_no_difference_once_normalised() -> None:
    mesh = _bumpy()
    moved = normalise(TriMesh(mesh.vertices * 30 + [100, -50, 20], mesh.faces))
    assert np.abs(spin_image(moved) - spin_image(mesh)).sum() < 1e-3 * spin_image(mesh).sum()


def test_vertices_without_faces_do_not_count() -> None:
    mesh = _bumpy()
    more = TriMesh(np.vstack([mesh.vertices, np.zeros((50, 3))]), mesh.faces)
    np.testing.assert_array_equal(spin_image(more), spin_image(mesh))


def test_any_number_of_threads_gives_the_same_bits() -> None:
    mesh = _bumpy()
    before = numba.get_num_threads()
    try:
        numba.set_num_threads(1)
        alone = spin_image(mesh)
    finally:
        numba.set_num_threads(before)
    np.testing.assert_array_equal(spin_image(mesh), alone)


@settings(max_examples=60, deadline=None)
@given(meshes())
def test_any_mesh_gives_shares_of_its_area(mesh: TriMesh) -> None:
    images = spin_image(mesh)
    assert images.shape == (mesh.n_faces, 256)
    assert np.isfinite(images).all()
    assert (images >= 0).all()
    assert (images.sum(axis=1) <= 1 + 1e-5).all()


@pytest.mark.parametrize("support", [0.0, -1.0, np.inf, np.nan])
def test_a_support_without_extent_is_refused(support: float) -> None:
    with pytest.raises(ParameterError, match="support must be positive"):
        SpinImageParameters(support=support)


def test_no_bins_are_refused() -> None:
    with pytest.raises(ParameterError, match="n_bins must be at least 1"):
        SpinImageParameters(n_bins=0)
