"""Distances from boundaries along the surface: analytic values on a strip, and an oracle."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from partwise.geometry.adjacency import edge_adjacency, vertex_neighbours
from partwise.geometry.faces import face_centroids
from partwise.mesh import TriMesh
from partwise.segmentation.boundary_distances import SurfaceGraph, boundary_distances
from partwise.testing.meshes import meshes


def strip(n: int) -> TriMesh:
    """n unit squares in a row, two triangles each."""
    x = np.arange(n + 1.0)
    vertices = np.concatenate([np.stack([x, np.full(n + 1, y), np.zeros(n + 1)], axis=1) for y in (0.0, 1.0)])
    i = np.arange(n)
    lower, upper = np.stack([i, i + 1, i + n + 2], axis=1), np.stack([i, i + n + 2, i + n + 1], axis=1)
    return TriMesh(vertices, np.stack([lower, upper], axis=1).reshape(-1, 3))


def graph_of(mesh: TriMesh) -> SurfaceGraph:
    return SurfaceGraph.build(mesh, edge_adjacency(mesh))


def test_faces_beside_the_boundary_are_as_far_as_the_edges_midpoint():
    mesh = strip(6)
    classes = (np.arange(12) >= 6).astype(np.int64)
    distances = boundary_distances(graph_of(mesh), classes, 2)
    midpoint = np.array([3.0, 0.5, 0.0])
    beside = [4, 7]  # the triangles with an edge on x = 3
    expected = np.linalg.norm(face_centroids(mesh)[beside] - midpoint, axis=1)
    np.testing.assert_allclose(distances[beside], np.stack([expected, expected], axis=1))


def test_beyond_the_limit_is_infinite_and_within_unchanged():
    mesh = strip(20)
    classes = (np.arange(40) >= 20).astype(np.int64)
    whole, limited = (boundary_distances(graph_of(mesh), classes, 2, limit) for limit in (np.inf, 3.0))
    np.testing.assert_array_equal(limited, np.where(whole <= 3.0, whole, np.inf))
    assert np.isinf(limited).any()


def test_a_class_without_boundary_is_nowhere_near():
    assert np.isinf(boundary_distances(graph_of(strip(3)), np.zeros(6, dtype=np.int64), 2)).all()


def test_unlabelled_faces_bound_a_class():
    classes = np.array([0, 0, -1, -1])
    assert np.isfinite(boundary_distances(graph_of(strip(2)), classes, 1)).all()


@given(meshes(), st.integers(0, 2**32 - 1))
@settings(max_examples=40, deadline=None)
def test_agrees_with_relaxing_until_nothing_changes(mesh, seed):
    chosen = np.random.default_rng(seed).random(mesh.n_faces) < 0.3
    C, neighbours = face_centroids(mesh), vertex_neighbours(mesh).tocoo()
    expected = np.where(chosen, 0.0, np.inf)
    for _ in range(mesh.n_faces):
        through = expected[neighbours.row] + np.linalg.norm(C[neighbours.row] - C[neighbours.col], axis=1)
        np.minimum.at(expected, neighbours.col, through)
    np.testing.assert_allclose(graph_of(mesh).from_faces(chosen), expected, rtol=1e-9, atol=1e-200)


@pytest.mark.parametrize("method", ["from_edges", "from_faces"])
def test_without_sources_everything_is_out_of_reach(method):
    graph = graph_of(strip(3))
    n = len(graph.pairs) if method == "from_edges" else 6
    assert np.isinf(getattr(graph, method)(np.zeros(n, dtype=bool))).all()
