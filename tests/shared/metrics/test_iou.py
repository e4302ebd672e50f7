"""IoU on labellings whose overlap is known."""

import numpy as np
import pytest

from partwise.errors import LabelError, NotEnoughDataError
from partwise.metrics.iou import mean_iou, mean_iou_absent_as_one, part_iou

PARTS = np.array([3, 5, 9])
TRUTH = np.array([3, 3, 3, 5, -1])
PREDICTED = np.array([3, 3, 5, 5, 9])
ONES = np.ones(5)


def test_counted_by_faces():
    np.testing.assert_array_equal(part_iou(PREDICTED, TRUTH, PARTS, ONES), [2 / 3, 1 / 2, np.nan])


def test_counted_by_area():
    areas = np.array([1.0, 1, 8, 2, 50])
    np.testing.assert_array_equal(part_iou(PREDICTED, TRUTH, PARTS, areas), [2 / 10, 2 / 10, np.nan])


def test_perfect():
    np.testing.assert_array_equal(part_iou(TRUTH, TRUTH, PARTS, ONES), [1, 1, np.nan])


def test_a_part_that_only_one_names_scores_zero():
    predicted = np.array([3, 3, 3, 9, 3])
    np.testing.assert_array_equal(part_iou(predicted, TRUTH, PARTS, ONES), [1, 0, 0])


def test_an_unlabelled_prediction_loses_the_face():
    predicted = np.array([3, 3, -1, 5, 5])
    np.testing.assert_array_equal(part_iou(predicted, TRUTH, PARTS, ONES), [2 / 3, 1, np.nan])


def test_swapping_truth_and_prediction_changes_nothing_where_all_is_labelled():
    truth = np.array([3, 3, 3, 5, 9])
    np.testing.assert_array_equal(part_iou(PREDICTED, truth, PARTS, ONES), part_iou(truth, PREDICTED, PARTS, ONES))


def test_mean_leaves_absent_parts_out():
    assert mean_iou(np.array([1.0, 0.5, np.nan])) == 0.75


def test_mean_with_absent_parts_as_one():
    assert mean_iou_absent_as_one(np.array([1.0, 0.5, np.nan])) == pytest.approx(2.5 / 3)


@pytest.mark.parametrize("iou", [np.array([np.nan]), np.zeros(0)])
def test_mean_of_nothing(iou):
    with pytest.raises(NotEnoughDataError, match="present"):
        mean_iou(iou)


def test_mean_with_absent_parts_as_one_of_no_parts():
    with pytest.raises(NotEnoughDataError, match="no"):
        mean_iou_absent_as_one(np.zeros(0))


@pytest.mark.parametrize(
    ("predicted", "truth", "weights", "message"),
    [
        (np.full(5, 4), TRUTH, ONES, "predicted labels must be among .* but hold 4"),
        (TRUTH, np.full(5, 4), ONES, "truth labels must be among .* but hold 4"),
        (TRUTH[:4], TRUTH, ONES, "one value a face"),
        (TRUTH, TRUTH, -ONES, "finite and ≥ 0"),
    ],
)
def test_refuses(predicted, truth, weights, message):
    with pytest.raises(LabelError, match=message):
        part_iou(predicted, truth, PARTS, weights)
