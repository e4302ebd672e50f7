"""Simulated predictions: as right as asked for, wrong in blobs and at boundaries, better after the cut."""

import numpy as np
import pytest

from partwise.errors import LabelError, ParameterError
from partwise.geometry.adjacency import edge_adjacency
from partwise.geometry.faces import face_areas
from partwise.metrics.accuracy import accuracy_by_area
from partwise.simulate.collection import simulate_shape
from partwise_cli.bench.simulated_predictions import drawn_accuracy, simulate_prediction


@pytest.fixture(scope="module")
def chair():
    shape = simulate_shape("chairs", 0, "chair", n_faces=2500)
    return shape.mesh, np.unique(shape.labels, return_inverse=True)[1]


@pytest.fixture(scope="module")
def made(chair):
    mesh, truth = chair
    return simulate_prediction(mesh, truth, int(truth.max()) + 1, 0.9, np.random.default_rng(0))


def test_it_is_as_right_as_was_asked_for(chair, made):
    mesh, truth = chair
    assert accuracy_by_area(made.predicted, truth, face_areas(mesh)) == pytest.approx(0.9, abs=0.01)


def test_the_cut_makes_it_better(chair, made):
    mesh, truth = chair
    areas = face_areas(mesh)
    assert accuracy_by_area(made.refined, truth, areas) > accuracy_by_area(made.predicted, truth, areas)


def test_probabilities_sum_to_one_and_their_largest_is_predicted(made):
    np.testing.assert_allclose(made.probabilities.sum(axis=1), 1.0)
    np.testing.assert_array_equal(np.argmax(made.probabilities, axis=1), made.predicted)


def test_what_is_wrong_lies_together(chair, made):
    """Neighbours of wrong faces are wrong far more often than faces are."""
    mesh, truth = chair
    wrong = made.predicted != truth
    first, second = wrong[edge_adjacency(mesh).faces].T
    assert (first & second).sum() / (first | second).sum() > 3 * wrong.mean()


def test_all_right_is_possible(chair):
    mesh, truth = chair
    made = simulate_prediction(mesh, truth, int(truth.max()) + 1, 1.0, np.random.default_rng(0))
    np.testing.assert_array_equal(made.predicted, truth)


def test_drawn_accuracies_are_near_the_stated_one():
    rng = np.random.default_rng(0)
    drawn = np.array([drawn_accuracy(rng) for _ in range(2000)])
    assert drawn.mean() == pytest.approx(0.92, abs=0.005)
    assert 0.7 <= drawn.min() < drawn.max() <= 0.99


@pytest.mark.parametrize("accuracy", [0.0, 1.1, np.nan])
def test_refuses_an_accuracy_that_is_none(chair, accuracy):
    with pytest.raises(ParameterError, match="accuracy"):
        simulate_prediction(*chair, 9, accuracy, np.random.default_rng(0))


@pytest.mark.parametrize("change", [lambda t: t[1:], lambda t: t - 1, lambda t: t + 9])
def test_refuses_classes_that_do_not_fit(chair, change):
    mesh, truth = chair
    with pytest.raises(LabelError, match="true classes"):
        simulate_prediction(mesh, change(truth), 9, 0.9, np.random.default_rng(0))
