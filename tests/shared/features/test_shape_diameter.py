import numba
import numpy as np
import pytest
import trimesh
from hypothesis import given, settings
from scipy.spatial.transform import Rotation

from partwise.errors import ParameterError
from partwise.features import shape_diameter as module
from partwise.features.parameters import ShapeDiameterParameters
from partwise.features.shape_diameter import ray_diameter, shape_diameter
from partwise.geometry.faces import face_centroids
from partwise.mesh import TriMesh
from partwise.testing.meshes import meshes


def _sphere(subdivisions: int) -> TriMesh:
    ball = trimesh.creation.icosphere(subdivisions=subdivisions)
    return TriMesh(ball.vertices, ball.faces)


def _box(extents: tuple[float, float, float], subdivisions: int = 3) -> TriMesh:
    box = trimesh.creation.box(extents=extents)
    for _ in range(subdivisions):
        box = box.subdivide()
    return TriMesh(box.vertices, box.faces)


def _dumbbell() -> TriMesh:
    """A capsule, thin in the middle."""
    ball = _sphere(4)
    x = ball.vertices[:, 0]
    return TriMesh(ball.vertices * np.stack([2 + 0 * x, 0.2 + x**2, 0.2 + x**2], axis=1), ball.faces)


def _tangents(n_rays: int = 25, cone_degrees: float = 120) -> np.ndarray:
    """Of the rays' angles with the axis, on a Vogel disk."""
    return np.tan(np.radians(cone_degrees / 2)) * np.sqrt((np.arange(n_rays) + 0.5) / n_rays)


def _robust_mean(lengths: np.ndarray) -> float:
    median = np.median(lengths)
    deviation = np.abs(lengths - median)
    return float(lengths[deviation <= 1.5 * np.median(deviation)].mean())


def test_diameter_of_a_sphere_is_the_mean_of_its_chords() -> None:
    chords = 2 / np.sqrt(1 + _tangents() ** 2)
    facing = chords > np.sqrt(2)  # beyond 45° the far side no longer faces away from the near one
    diameter = ray_diameter(_sphere(5))
    np.testing.assert_allclose(np.median(diameter), _robust_mean(chords[facing]), rtol=1e-3)
    # Where facets decide otherwise about the ray at 45°, one ray more or less changes the mean.
    np.testing.assert_allclose(diameter, np.median(diameter), rtol=0.06)


def test_diameter_of_a_slab_is_that_of_its_slanted_rays() -> None:
    mesh = _box((20, 20, 0.1))
    centroids = face_centroids(mesh)
    is_inner = np.abs(centroids[:, :2]).max(axis=1) < 9
    expected = _robust_mean(0.1 * np.sqrt(1 + _tangents() ** 2))
    np.testing.assert_allclose(ray_diameter(mesh)[is_inner], expected, rtol=1e-3)


def test_a_slab_is_thinner_than_a_cube() -> None:
    slab, cube = _box((1, 1, 0.05)), _box((1, 1, 1))
    is_lid = np.abs(face_centroids(slab)[:, 2]) > 0.024
    assert np.median(ray_diameter(slab)[is_lid]) < 0.1 * np.median(ray_diameter(cube))


def test_the_thin_middle_of_a_dumbbell_has_the_least_values() -> None:
    mesh = _dumbbell()
    values = shape_diameter(mesh)
    x = np.abs(face_centroids(mesh)[:, 0])
    assert values[x < 0.2].max() < values[(x > 1.2) & (x < 1.6)].min()


def test_values_span_zero_to_one() -> None:
    values = shape_diameter(_dumbbell())
    assert values.dtype == np.float32
    assert (values.min(), values.max()) == (0, 1)


def test_alpha_only_bends_the_scale() -> None:
    four, five = (shape_diameter(_dumbbell(), ShapeDiameterParameters(alpha=alpha)) for alpha in (4.0, 5.0))
    np.testing.assert_allclose(np.expm1(four * np.log(5)) / 4, np.expm1(five * np.log(6)) / 5, atol=1e-5)


def test_turning_moving_and_scaling_make_no_difference() -> None:
    mesh = _dumbbell()
    turn = Rotation.from_euler("xyz", [0.4, 1.1, -2.0]).as_matrix()
    moved = TriMesh(mesh.vertices @ turn.T * 30 + [1000, -500, 20], mesh.faces)
    same = np.isclose(ray_diameter(moved), 30 * ray_diameter(mesh), rtol=1e-3)
    assert same.mean() > 0.98  # a ray that grazes an edge may fall to either side
    assert np.abs(shape_diameter(moved) - shape_diameter(mesh)).max() < 0.05


def test_smoothing_keeps_a_constant() -> None:
    slab = _box((20, 20, 0.1), subdivisions=1)
    top = TriMesh(slab.vertices, slab.faces[np.abs(face_centroids(slab)[:, 2]) > 0.04])
    np.testing.assert_array_equal(shape_diameter(top, ShapeDiameterParameters(n_rays=1, cone_degrees=1)), 0)


def test_casting_few_rays_at_a_time_makes_no_difference(monkeypatch: pytest.MonkeyPatch) -> None:
    mesh = _dumbbell()
    at_once = ray_diameter(mesh)
    monkeypatch.setattr(module, "RAYS_PER_BATCH", 1000)
    np.testing.assert_array_equal(ray_diameter(mesh), at_once)


def test_any_number_of_threads_gives_the_same_bits() -> None:
    mesh = _dumbbell()
    before = numba.get_num_threads()
    try:
        numba.set_num_threads(1)
        alone = shape_diameter(mesh)
    finally:
        numba.set_num_threads(before)
    np.testing.assert_array_equal(shape_diameter(mesh), alone)


def test_where_no_ray_counts_there_is_no_diameter() -> None:
    sheet = TriMesh(np.array([[0.0, 0, 0], [1, 0, 0], [0, 1, 0], [1, 1, 0]]), np.array([[0, 1, 2], [2, 1, 3]]))
    assert np.isnan(ray_diameter(sheet)).all()
    np.testing.assert_array_equal(shape_diameter(sheet), 0)


def test_a_missing_diameter_becomes_the_neighbours_mean() -> None:
    ball = _dumbbell()
    widest = int(np.argmax(shape_diameter(ball)))
    a, b, _ = ball.faces[widest]
    mesh = TriMesh(ball.vertices, np.vstack([ball.faces, [[a, b, b]]]))
    assert np.isnan(ray_diameter(mesh)[-1])
    assert shape_diameter(mesh)[-1] > 0.9


def test_a_missing_diameter_without_neighbours_becomes_the_least() -> None:
    ball = _dumbbell()
    far = np.array([[9.0, 9, 9], [10, 9, 9], [9, 10, 9]])
    mesh = TriMesh(np.vstack([ball.vertices, far]), np.vstack([ball.faces, np.arange(3) + ball.n_vertices]))
    # Smoothing lifts the least of the ball's own faces a little, and leaves the lone face alone.
    assert shape_diameter(mesh)[-1] == 0


def test_a_double_sided_wall_does_not_hide_what_is_behind() -> None:
    box = _box((1, 1, 1))
    doubled = TriMesh(box.vertices, np.vstack([box.faces, box.faces[:, ::-1]]))
    assert np.isfinite(shape_diameter(doubled)).all()


@settings(max_examples=60, deadline=None)
@given(meshes())
def test_any_mesh_gives_values_between_zero_and_one(mesh: TriMesh) -> None:
    values = shape_diameter(mesh)
    assert values.shape == (mesh.n_faces,)
    assert ((values >= 0) & (values <= 1)).all()


@pytest.mark.parametrize(
    ("name", "value"),
    [("alpha", 0.0), ("alpha", np.inf), ("n_rays", 0), ("cone_degrees", 0.0), ("cone_degrees", 180.0)],
)
def test_a_parameter_out_of_range_is_refused(name: str, value: float) -> None:
    with pytest.raises(ParameterError, match=f"{name} must"):
        ShapeDiameterParameters(**{name: value})  # type: ignore[arg-type]
