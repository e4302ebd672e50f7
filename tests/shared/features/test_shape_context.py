import os
from pathlib import Path

import numba
import numpy as np
import pytest
import trimesh
from hypothesis import given, settings
from scipy.integrate import quad
from scipy.spatial.transform import Rotation

from partwise.errors import ParameterError
from partwise.features import shape_context as module
from partwise.features.parameters import ShapeContextParameters
from partwise.features.shape_context import distance_bin_edges, shape_context
from partwise.geometry.faces import face_areas, face_centroids, face_normals
from partwise.geometry.geodesics import face_geodesics
from partwise.io.read import read_mesh
from partwise.mesh import TriMesh
from partwise.testing.meshes import meshes

DATA = os.environ.get("PARTWISE_DATA")
PRINTED_EDGES = [0, 0.038, 0.072, 0.108, 0.144, 0.182, 0.222, 0.266, 0.313, 0.364, 0.422, 0.488, 0.564, 0.655, 0.772]
PRINTED_EDGES += [0.932, 1.2]


def _sphere(subdivisions: int) -> TriMesh:
    ball = trimesh.creation.icosphere(subdivisions=subdivisions)
    return TriMesh(ball.vertices, ball.faces)


def _bumpy(subdivisions: int) -> TriMesh:
    """A sphere with smooth bumps and a little noise: no symmetry, so hardly a value on a bin's edge."""
    ball = _sphere(subdivisions)
    x, y, z = ball.vertices.T
    noise = np.random.default_rng(5).normal(scale=0.005, size=len(x))
    radius = 1 + 0.3 * np.sin(3 * x + y) + 0.2 * np.cos(4 * z - x) + noise
    return TriMesh(ball.vertices * radius[:, None] * [1, 0.7, 1.9], ball.faces)


def _by_definition(mesh: TriMesh) -> np.ndarray:
    m = mesh.n_faces
    geodesics = face_geodesics(mesh, np.arange(m)).astype(np.float64)
    others = ~np.eye(m, dtype=bool)
    relative = geodesics / np.quantile(geodesics[others & np.isfinite(geodesics)], 0.95, method="inverted_cdf")
    areas, centroids, normals = face_areas(mesh), face_centroids(mesh), face_normals(mesh)
    histograms = np.zeros((m, 16, 16))
    for i in range(m):
        k = np.flatnonzero(others[i] & (relative[i] < 1.2))
        direction = centroids[k] - centroids[i]
        direction /= np.linalg.norm(direction, axis=1, keepdims=True)
        degrees = np.degrees(np.arccos(np.clip(-(direction * normals[k]).sum(axis=1), -1, 1))) - 90
        angle = np.minimum((degrees + 90) * 16 // 180, 15).astype(int)
        distance = np.searchsorted(distance_bin_edges(16), relative[i, k], side="right") - 1
        np.add.at(histograms[i], (angle, distance), areas[k] / areas.sum() / (relative[i, k] + 0.1))
    return histograms.reshape(m, 256)


def _correlation(first: np.ndarray, second: np.ndarray) -> float:
    return float(np.corrcoef(np.sqrt(first).ravel(), np.sqrt(second).ravel())[0, 1])


def _difference(first: np.ndarray, second: np.ndarray) -> float:
    """Share of the mass that is elsewhere."""
    return float(np.abs(first - second).sum() / first.sum())


def test_bin_edges_are_the_printed_ones() -> None:
    np.testing.assert_allclose(distance_bin_edges(16), PRINTED_EDGES, atol=5e-4)


def test_histograms_follow_the_definition() -> None:
    mesh = _bumpy(3)
    assert _difference(_by_definition(mesh), shape_context(mesh)) < 1e-4


def test_on_a_sphere_the_angle_is_half_the_way_round() -> None:
    histograms = shape_context(_sphere(4), ShapeContextParameters(all_pairs_below=10_000)).reshape(-1, 16, 16)
    by_angle = histograms.sum(axis=2).mean(axis=0)
    np.testing.assert_allclose(by_angle[:8], 0, atol=1e-3)
    g95 = np.arccos(-0.9)  # within it lie 95 % of a sphere's area
    width = 2 * np.pi / 16
    expected = [quad(lambda g: np.sin(g) / 2 / (g / g95 + 0.1), j * width, (j + 1) * width)[0] for j in range(8)]
    np.testing.assert_allclose(by_angle[8:], expected, rtol=0.05)


def test_faces_of_a_sphere_are_alike() -> None:
    totals = shape_context(_sphere(3)).sum(axis=1)
    assert totals.std() < 0.02 * totals.mean()


def test_turning_moving_and_scaling_make_no_difference() -> None:
    mesh = _bumpy(3)
    turn = Rotation.from_euler("xyz", [0.4, 1.1, -2.0]).as_matrix()
    moved = TriMesh(mesh.vertices @ turn.T * 30 + [1000, -500, 20], mesh.faces)
    assert _difference(shape_context(mesh), shape_context(moved)) < 1e-3


def test_another_component_only_takes_its_share_of_the_area() -> None:
    mesh = _bumpy(2)
    twice = TriMesh(
        np.vstack([mesh.vertices, mesh.vertices + 9]), np.vstack([mesh.faces, mesh.faces + mesh.n_vertices])
    )
    one = shape_context(mesh)
    assert _difference(np.vstack([one, one]) / 2, shape_context(twice)) < 1e-4


def test_sampled_targets_stand_for_all() -> None:
    mesh = _bumpy(4)
    full = shape_context(mesh, ShapeContextParameters(all_pairs_below=mesh.n_faces))
    sampled = shape_context(mesh, ShapeContextParameters(all_pairs_below=0, n_targets=2000))
    assert _correlation(full, sampled) > 0.99
    np.testing.assert_allclose(sampled.sum(axis=1), full.sum(axis=1), rtol=0.1)


def test_sampling_every_face_is_all_pairs() -> None:
    mesh = _bumpy(2)
    sampled = shape_context(mesh, ShapeContextParameters(all_pairs_below=0, n_targets=mesh.n_faces))
    np.testing.assert_array_equal(sampled, shape_context(mesh))


def test_holding_few_distances_at_a_time_hardly_matters(monkeypatch: pytest.MonkeyPatch) -> None:
    mesh = _bumpy(3)
    full = shape_context(mesh)
    monkeypatch.setattr(module, "VALUES_HELD", 5 * 32 * mesh.n_faces)
    assert _correlation(full, shape_context(mesh)) > 0.995


def test_any_number_of_threads_gives_the_same_bits() -> None:
    mesh = _bumpy(3)
    before = numba.get_num_threads()
    try:
        numba.set_num_threads(1)
        alone = shape_context(mesh)
    finally:
        numba.set_num_threads(before)
    np.testing.assert_array_equal(shape_context(mesh), alone)


def test_other_numbers_of_bins_add_up_to_the_same() -> None:
    mesh = _bumpy(2)
    coarse = shape_context(mesh, ShapeContextParameters(n_angle_bins=4, n_distance_bins=1))
    fine = shape_context(mesh, ShapeContextParameters(n_angle_bins=40, n_distance_bins=20))
    assert (coarse.shape[1], fine.shape[1]) == (4, 800)
    np.testing.assert_allclose(coarse, fine.reshape(-1, 4, 200).sum(axis=2), rtol=1e-4, atol=1e-5)


@settings(max_examples=60, deadline=None)
@given(meshes())
def test_any_mesh_gives_finite_values(mesh: TriMesh) -> None:
    histograms = shape_context(mesh)
    assert histograms.shape == (mesh.n_faces, 256)
    assert np.isfinite(histograms).all()
    assert (histograms >= 0).all()


@pytest.mark.parametrize("faces", [[[0, 1, 2]], [[0, 1, 2], [3, 4, 5]], [[0, 0, 1], [0, 1, 1]], [[0, 1, 2], [0, 1, 2]]])
def test_without_another_place_to_reach_there_is_nothing(faces: list[list[int]]) -> None:
    points = np.array([[0.0, 0, 0], [1, 0, 0], [0, 1, 0], [5, 5, 5], [6, 5, 5], [5, 6, 5]])
    np.testing.assert_array_equal(shape_context(TriMesh(points, np.array(faces))), 0)


@pytest.mark.parametrize(
    ("name", "value"), [("n_angle_bins", 0), ("n_distance_bins", 0), ("all_pairs_below", -1), ("n_targets", 0)]
)
def test_a_parameter_out_of_range_is_refused(name: str, value: int) -> None:
    with pytest.raises(ParameterError, match=f"{name} must be at least"):
        ShapeContextParameters(**{name: value})


@pytest.mark.skipif(not DATA, reason="PARTWISE_DATA is not set: no real meshes at hand")
def test_default_sampling_of_a_real_shape_correlates_with_all_pairs() -> None:
    mesh = read_mesh(Path(str(DATA)) / "lpsb" / "Airplane" / "72.off")
    full = shape_context(mesh, ShapeContextParameters(all_pairs_below=mesh.n_faces))
    assert _correlation(full, shape_context(mesh)) >= 0.99
