"""Accuracy on labellings whose share is known."""

import numpy as np
import pytest

from partwise.errors import LabelError, NotEnoughDataError
from partwise.metrics.accuracy import accuracy, accuracy_by_area

TRUTH = np.array([0, 0, 1, 1, -1])
AREAS = np.array([1.0, 2.0, 3.0, 4.0, 100.0])


def test_all_right():
    assert accuracy(TRUTH, TRUTH) == 1.0


def test_all_wrong():
    assert accuracy(1 - TRUTH, TRUTH) == 0.0


def test_faces_count_alike():
    assert accuracy(np.array([0, 0, 1, 0, 0]), TRUTH) == 3 / 4


def test_area_counts():
    assert accuracy_by_area(np.array([0, 0, 1, 0, 0]), TRUTH, AREAS) == 6 / 10


def test_unlabelled_truth_does_not_count():
    changed = TRUTH.copy()
    changed[4] = 1
    assert accuracy_by_area(changed, TRUTH, AREAS) == 1.0


def test_an_unlabelled_prediction_is_wrong():
    assert accuracy(np.full(5, -1), TRUTH) == 0.0


def test_splitting_a_face_leaves_accuracy_by_area():
    predicted = np.array([0, 1, 1, 0, 0])
    pieces = np.array([1, 3, 2, 5, 1])
    split = [np.repeat(values, pieces) for values in (predicted, TRUTH, AREAS / pieces)]
    assert accuracy_by_area(*split) == pytest.approx(accuracy_by_area(predicted, TRUTH, AREAS))


@pytest.mark.parametrize(
    ("predicted", "truth", "areas", "message"),
    [
        (TRUTH[:4], TRUTH, AREAS, "one value a face"),
        (TRUTH, TRUTH[:4], AREAS, "one value a face"),
        (TRUTH, TRUTH, AREAS[:4], "one value a face"),
        (TRUTH.reshape(1, -1), TRUTH.reshape(1, -1), AREAS.reshape(1, -1), "one value a face"),
        (TRUTH, TRUTH, -AREAS, "finite and ≥ 0"),
        (TRUTH, TRUTH, AREAS * np.nan, "finite and ≥ 0"),
    ],
)
def test_refuses(predicted, truth, areas, message):
    with pytest.raises(LabelError, match=message):
        accuracy_by_area(predicted, truth, areas)


@pytest.mark.parametrize(("truth", "areas"), [(np.full(5, -1), AREAS), (TRUTH, np.zeros(5))])
def test_nothing_to_compare_with(truth, areas):
    with pytest.raises(NotEnoughDataError, match="true label and area"):
        accuracy_by_area(TRUTH, truth, areas)
