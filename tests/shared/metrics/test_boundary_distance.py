"""Boundary distance: 0 for equal boundaries, an analytic value for shifted ones, and the cases without a boundary."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from partwise.errors import DegenerateMeshError, LabelError
from partwise.geometry.adjacency import edge_adjacency
from partwise.geometry.faces import bounding_box_diagonal
from partwise.mesh import TriMesh
from partwise.metrics.boundary_distance import boundary_distance
from partwise.testing.meshes import meshes


def strip(n: int) -> TriMesh:
    """n unit squares in a row, two triangles each: faces 2 i and 2 i + 1 are square i."""
    x = np.arange(n + 1.0)
    vertices = np.concatenate([np.stack([x, np.full(n + 1, y), np.zeros(n + 1)], axis=1) for y in (0.0, 1.0)])
    i = np.arange(n)
    lower, upper = np.stack([i, i + 1, i + n + 2], axis=1), np.stack([i, i + n + 2, i + n + 1], axis=1)
    return TriMesh(vertices, np.stack([lower, upper], axis=1).reshape(-1, 3))


def split_at(mesh: TriMesh, square: int) -> np.ndarray:
    return (np.arange(mesh.n_faces) >= 2 * square).astype(np.int64)


@pytest.mark.parametrize("shift", [0, 1, 3])
def test_parallel_cuts_lie_their_shift_apart(shift):
    mesh = strip(9)
    reached = boundary_distance(mesh, split_at(mesh, 4), split_at(mesh, 4 + shift))
    assert reached == pytest.approx(shift / bounding_box_diagonal(mesh))


def test_directions_are_averaged_and_edges_weighted_by_length():
    mesh = strip(9)
    truth, predicted = split_at(mesh, 2), split_at(mesh, 2)
    predicted[2 * 6 :] = 2  # a second cut, four squares from the only true one
    assert boundary_distance(mesh, predicted, truth) == pytest.approx((2 + 0) / 2 / bounding_box_diagonal(mesh))


def test_the_nearest_point_may_be_inside_an_edge():
    # The diagonal of square 4 from (4, 0) to (5, 1), against the cut x = 4: midpoint (4.5, 0.5) is 0.5 away from it,
    # and its midpoint (4, 0.5) is 0.5/√2 from the diagonal, whose own midpoint is farther.
    mesh = strip(9)
    diagonal_cut = split_at(mesh, 5)
    diagonal_cut[8] = 1
    expected = (0.5 + 0.5 / np.sqrt(2)) / 2 / bounding_box_diagonal(mesh)
    assert boundary_distance(mesh, diagonal_cut, split_at(mesh, 4)) == pytest.approx(expected)


def test_no_boundary_in_either_is_no_distance():
    mesh = strip(3)
    assert boundary_distance(mesh, np.zeros(6, dtype=np.int64), np.ones(6, dtype=np.int64)) == 0.0


@pytest.mark.parametrize("swap", [False, True])
def test_a_boundary_in_one_only_is_a_diagonal_away(swap):
    mesh = strip(3)
    pair = (np.zeros(6, dtype=np.int64), split_at(mesh, 1))
    assert boundary_distance(mesh, *(pair[::-1] if swap else pair)) == 1.0


def test_edges_of_unlabelled_truth_do_not_count():
    mesh = strip(9)
    truth = split_at(mesh, 2)
    truth[2 * 5 :] = -1
    predicted = split_at(mesh, 2)
    predicted[2 * 7 :] = 2
    assert boundary_distance(mesh, predicted, truth) == 0.0


@given(meshes(), st.integers(0, 2**32 - 1))
@settings(max_examples=60, deadline=None)
def test_symmetric_bounded_and_zero_for_renamed_labels(mesh, seed):
    if not bounding_box_diagonal(mesh) > 0:
        return
    rng = np.random.default_rng(seed)
    a, b = rng.integers(0, 3, (2, mesh.n_faces))
    assert boundary_distance(mesh, a, (a + 1) % 3) == pytest.approx(0.0, abs=1e-7)
    assert 0.0 <= boundary_distance(mesh, a, b) <= 1.0
    assert boundary_distance(mesh, a, b) == pytest.approx(boundary_distance(mesh, b, a))


@given(meshes(), st.integers(0, 2**32 - 1))
@settings(max_examples=40, deadline=None)
def test_agrees_with_comparing_every_pair_of_edges(mesh, seed):
    if not bounding_box_diagonal(mesh) > 0:
        return
    a, b = np.random.default_rng(seed).integers(0, 3, (2, mesh.n_faces))
    adjacency = edge_adjacency(mesh)

    def cuts(labels):
        is_cut = (labels[adjacency.faces[:, 0]] != labels[adjacency.faces[:, 1]]) & (adjacency.lengths > 0)
        return mesh.vertices[adjacency.edges[is_cut]]

    def directed(source, target):
        total = 0.0
        for p, q in source:
            middle, nearest = (p + q) / 2, np.inf
            for s, e in target:
                t = np.clip((middle - s) @ (e - s) / ((e - s) @ (e - s)), 0, 1)
                nearest = min(nearest, np.linalg.norm(middle - s - t * (e - s)))
            total += nearest * np.linalg.norm(q - p)
        return total / np.linalg.norm(source[:, 1] - source[:, 0], axis=1).sum()

    first, second = cuts(a), cuts(b)
    if len(first) and len(second):
        expected = (directed(first, second) + directed(second, first)) / 2 / bounding_box_diagonal(mesh)
        assert boundary_distance(mesh, a, b) == pytest.approx(expected, rel=1e-6, abs=1e-9)


@pytest.mark.parametrize("which", [0, 1])
def test_refuses_labels_of_another_mesh(which):
    mesh = strip(3)
    given_labels = [split_at(mesh, 1), split_at(mesh, 1)]
    given_labels[which] = np.zeros(5, dtype=np.int64)
    with pytest.raises(LabelError, match="another mesh"):
        boundary_distance(mesh, *given_labels)


def test_refuses_a_point():
    mesh = TriMesh(np.zeros((3, 3)), np.array([[0, 1, 2]]))
    with pytest.raises(DegenerateMeshError, match="single point"):
        boundary_distance(mesh, np.array([0]), np.array([0]))
