"""Alpha expansion: never worse than its start, near the optimum, blind to label names."""

import itertools

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra import numpy as arrays

from partwise.errors import LabelError
from partwise.segmentation.alpha_expansion import alpha_expansion
from partwise.segmentation.energy import LabelProblem, energy


@st.composite
def problems(draw, max_nodes=6, max_labels=4):
    m, n_labels = draw(st.integers(1, max_nodes)), draw(st.integers(1, max_labels))
    cost = st.floats(0, 10, width=32)
    unary = draw(arrays.arrays(np.float64, (m, n_labels), elements=cost))
    pairs = np.array(list(itertools.combinations(range(m), 2)), dtype=np.int64).reshape(-1, 2)
    chosen = draw(arrays.arrays(np.bool_, len(pairs)))
    edges = pairs[chosen]
    weights = draw(arrays.arrays(np.float64, len(edges), elements=cost))
    return LabelProblem(unary, edges, weights)


@st.composite
def problems_with_labels(draw):
    problem = draw(problems(max_nodes=12))
    labels = draw(arrays.arrays(np.int64, problem.n_nodes, elements=st.integers(0, problem.n_labels - 1)))
    return problem, labels


def random_problem(seed, m=60, n_labels=5):
    rng = np.random.default_rng(seed)
    edges = np.unique(np.sort(rng.integers(0, m, (150, 2)), axis=1), axis=0)
    edges = edges[edges[:, 0] < edges[:, 1]]
    return LabelProblem(rng.uniform(0, 3, (m, n_labels)), edges, rng.uniform(0, 1, len(edges)))


def least_energy(problem):
    labellings = itertools.product(range(problem.n_labels), repeat=problem.n_nodes)
    return min(energy(problem, np.array(labels)) for labels in labellings)


@given(problems_with_labels())
@settings(max_examples=100, deadline=None)
def test_energy_never_rises(problem_and_labels):
    problem, initial = problem_and_labels
    assert energy(problem, alpha_expansion(problem, initial)) <= energy(problem, initial)


@given(problems(max_nodes=5, max_labels=3))
@settings(max_examples=60, deadline=None)
def test_within_twice_the_optimum_of_any_start(problem):
    best = least_energy(problem)
    for start in range(problem.n_labels):
        reached = energy(problem, alpha_expansion(problem, np.full(problem.n_nodes, start)))
        assert reached <= 2 * best + 1e-9


@given(problems(max_nodes=6, max_labels=2))
@settings(max_examples=60, deadline=None)
def test_two_labels_are_solved_exactly(problem):
    reached = energy(problem, alpha_expansion(problem, np.zeros(problem.n_nodes, dtype=np.int64)))
    assert reached == pytest.approx(least_energy(problem), abs=1e-9)


@pytest.mark.parametrize("seed", range(5))
def test_no_single_change_improves_the_result(seed):
    problem = random_problem(seed)
    labels = alpha_expansion(problem, np.argmin(problem.unary, axis=1))
    reached = energy(problem, labels)
    for node, label in itertools.product(range(problem.n_nodes), range(problem.n_labels)):
        changed = labels.copy()
        changed[node] = label
        assert energy(problem, changed) >= reached - 1e-9


@pytest.mark.parametrize("seed", range(5))
def test_renaming_labels_renames_the_result(seed):
    problem = random_problem(seed)
    initial = np.argmin(problem.unary, axis=1)
    new_name = np.random.default_rng(seed).permutation(problem.n_labels)
    renamed = LabelProblem(problem.unary[:, np.argsort(new_name)], problem.edges, problem.weights)
    np.testing.assert_array_equal(
        alpha_expansion(renamed, new_name[initial]), new_name[alpha_expansion(problem, initial)]
    )


@pytest.mark.parametrize("seed", range(3))
def test_turning_edges_around_keeps_the_energy(seed):
    problem = random_problem(seed)
    initial = np.argmin(problem.unary, axis=1)
    turned = LabelProblem(problem.unary, problem.edges[:, ::-1], problem.weights)
    first, second = (energy(problem, alpha_expansion(p, initial)) for p in (problem, turned))
    assert first == pytest.approx(second)


def test_indifferent_nodes_keep_their_label():
    problem = LabelProblem(np.zeros((3, 2)), np.zeros((0, 2), dtype=np.int64), np.zeros(0))
    np.testing.assert_array_equal(alpha_expansion(problem, np.array([1, 0, 1])), [1, 0, 1])


def test_a_strong_edge_joins_and_a_weak_one_does_not():
    unary = np.array([[0.0, 3.0], [2.0, 0.0]])
    for weight, expected in ((1.9, [0, 1]), (2.1, [0, 0])):
        problem = LabelProblem(unary, np.array([[0, 1]]), np.array([weight]))
        np.testing.assert_array_equal(alpha_expansion(problem, np.array([0, 1])), expected)


def test_negative_costs_are_allowed():
    problem = LabelProblem(np.array([[-5.0, -6.0]]), np.zeros((0, 2), dtype=np.int64), np.zeros(0))
    np.testing.assert_array_equal(alpha_expansion(problem, np.array([0])), [1])


def test_the_start_is_not_changed_in_place():
    initial = np.array([0, 0])
    problem = LabelProblem(np.array([[1.0, 0.0], [1.0, 0.0]]), np.array([[0, 1]]), np.array([1.0]))
    alpha_expansion(problem, initial)
    np.testing.assert_array_equal(initial, [0, 0])


def test_refuses_a_start_that_does_not_fit():
    with pytest.raises(LabelError, match="labels must be"):
        alpha_expansion(random_problem(0), np.zeros(3, dtype=np.int64))
