import numpy as np
import pytest
import trimesh
from hypothesis import given, settings
from scipy import sparse

from partwise.errors import ParameterError
from partwise.geometry.adjacency import vertex_neighbours
from partwise.geometry.faces import face_centroids
from partwise.geometry.geodesics import HUB_VALENCE, face_geodesics, face_graph
from partwise.geometry.kernels.geodesics import LANES, geodesic_batches
from partwise.mesh import TriMesh
from partwise.testing.meshes import meshes


def _sphere(subdivisions: int = 3) -> TriMesh:
    ball = trimesh.creation.icosphere(subdivisions=subdivisions)
    return TriMesh(ball.vertices, ball.faces)


def _scipy_geodesics(mesh: TriMesh, sources: np.ndarray) -> np.ndarray:
    neighbours = vertex_neighbours(mesh).tocoo()
    centroids = face_centroids(mesh)
    lengths = np.linalg.norm(centroids[neighbours.row] - centroids[neighbours.col], axis=1)
    graph = sparse.csr_array((lengths, (neighbours.row, neighbours.col)), shape=(mesh.n_faces,) * 2)
    result: np.ndarray = sparse.csgraph.dijkstra(graph, indices=sources)
    return result


@settings(max_examples=60, deadline=None)
@given(meshes())
def test_distances_are_scipys(mesh: TriMesh) -> None:
    sources = np.arange(mesh.n_faces)
    expected = _scipy_geodesics(mesh, sources)
    np.testing.assert_allclose(face_geodesics(mesh, sources), expected, rtol=1e-5, atol=1e-30)


def test_distances_on_a_sphere_are_scipys() -> None:
    mesh, sources = _sphere(), np.array([0, 7, 1000])
    np.testing.assert_allclose(face_geodesics(mesh, sources), _scipy_geodesics(mesh, sources), rtol=1e-5)


def test_distances_on_a_sphere_are_close_to_great_circles() -> None:
    mesh = _sphere(4)
    centroids = face_centroids(mesh)
    directions = centroids / np.linalg.norm(centroids, axis=1, keepdims=True)
    exact = np.arccos(np.clip(directions @ directions[0], -1, 1))
    far = exact > 0.5
    ratio = face_geodesics(mesh, np.array([0]))[0][far] / exact[far]
    assert 1 < np.median(ratio) < 1.06


def test_beyond_the_limit_is_infinite_and_the_rest_unchanged() -> None:
    mesh = _sphere()
    full = face_geodesics(mesh, np.array([3]))
    limited = face_geodesics(mesh, np.array([3]), limit=1.0)
    np.testing.assert_array_equal(limited, np.where(full <= np.float32(1.0), full, np.inf))


def test_no_sources_give_no_rows() -> None:
    assert face_geodesics(_sphere(1), np.zeros(0, dtype=np.int64)).shape == (0, 80)


@pytest.mark.parametrize("sources", [np.array([-1]), np.array([80]), np.array([[0]])])
def test_sources_that_are_no_faces_are_refused(sources: np.ndarray) -> None:
    with pytest.raises(ParameterError, match=r"in 0\.\.79"):
        face_geodesics(_sphere(1), sources)


@pytest.mark.parametrize("limit", [-1.0, np.nan])
def test_a_limit_that_is_no_distance_is_refused(limit: float) -> None:
    with pytest.raises(ParameterError, match="limit must be a distance"):
        face_geodesics(_sphere(1), np.array([0]), limit)


@settings(max_examples=60, deadline=None)
@given(meshes())
def test_the_graph_links_faces_with_a_common_vertex(mesh: TriMesh) -> None:
    graph = face_graph(mesh)
    expected = vertex_neighbours(mesh)
    np.testing.assert_array_equal(graph.starts, expected.indptr)
    np.testing.assert_array_equal(graph.neighbours, expected.indices)
    n, component = sparse.csgraph.connected_components(expected, directed=False)
    assert len(np.unique(graph.component * n + component)) == n == graph.component.max() + 1


def _fan(n: int) -> TriMesh:
    angle = np.linspace(0, 2 * np.pi, n, endpoint=False)
    rim = np.stack([np.cos(angle), np.sin(angle), np.zeros(n)], axis=1)
    step = np.arange(n)
    return TriMesh(np.vstack([rim, [[0, 0, 1]]]), np.stack([step, (step + 1) % n, np.full(n, n)], axis=1))


def test_a_vertex_of_very_many_faces_costs_links_in_proportion() -> None:
    n = 20_000
    graph = face_graph(_fan(n))
    assert graph.n_nodes == n + 1
    assert len(graph.neighbours) == 4 * n  # two across the rim's vertices, one to the hub, one back


def test_paths_across_a_hub_run_through_its_vertex() -> None:
    mesh = _fan(HUB_VALENCE + 2)
    across = face_geodesics(mesh, np.array([0]))[0, mesh.n_faces // 2]
    apex = mesh.vertices[-1]
    np.testing.assert_allclose(across, 2 * np.linalg.norm(face_centroids(mesh)[0] - apex), rtol=1e-5)


@settings(max_examples=30, deadline=None)
@given(meshes())
def test_fields_advanced_together_equal_dijkstra_bit_for_bit(mesh: TriMesh) -> None:
    graph = face_graph(mesh)
    order = np.argsort(graph.component, kind="stable")
    starts = np.append(0, np.cumsum(np.bincount(graph.component)))
    n_batches = -(-int(np.diff(starts).max()) // LANES)
    fields = np.empty((n_batches, graph.n_nodes, LANES), dtype=np.float32)
    geodesic_batches(graph.starts, graph.neighbours, graph.lengths, order, starts, np.arange(n_batches), fields)
    expected = face_geodesics(mesh, order)
    for target, distances in zip(range(len(order)), expected, strict=True):
        component = graph.component[order[target]]
        batch, lane = divmod(target - int(starts[component]), LANES)
        own = graph.component == component
        np.testing.assert_array_equal(fields[batch, : mesh.n_faces, lane][own], distances[own])
