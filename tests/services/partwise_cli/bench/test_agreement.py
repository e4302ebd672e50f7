"""All measures of agreement, of one shape and of several."""

import numpy as np
import pytest

from partwise.errors import NotEnoughDataError
from partwise.simulate.collection import simulate_shape
from partwise_cli.bench.agreement import Agreement, agreement, mean_agreement


@pytest.fixture(scope="module")
def mug():
    shape = simulate_shape("mugs", 0, "mug", n_faces=1000)
    return shape.mesh, np.unique(shape.labels, return_inverse=True)[1]


def test_the_truth_agrees_with_itself(mug):
    mesh, truth = mug
    found = agreement(mesh, truth, truth, ["body", "handle", "lid"])
    assert (found.accuracy, found.mean_iou) == (1.0, 1.0)
    assert found.accuracy_by_area == pytest.approx(1.0)
    assert found.boundary_distance == pytest.approx(0.0, abs=1e-9)
    assert found.iou == {"body": pytest.approx(1.0), "handle": pytest.approx(1.0)}  # nobody names a lid


def test_one_part_over_all_is_right_where_it_belongs(mug):
    mesh, truth = mug
    found = agreement(mesh, np.zeros_like(truth), truth, ["body", "handle"])
    assert found.accuracy == pytest.approx((truth == 0).mean())
    assert found.iou["body"] == pytest.approx(found.accuracy_by_area)
    assert found.iou["handle"] == 0.0
    assert found.boundary_distance == 1.0


def test_a_part_counts_over_the_shapes_that_have_it():
    mean = mean_agreement(
        [Agreement(0.5, 0.6, {"a": 0.2}, 0.2, 0.0), Agreement(0.7, 1.0, {"a": 0.4, "b": 1.0}, 0.7, 0.1)]
    )
    assert mean.iou == {"a": pytest.approx(0.3), "b": 1.0}
    assert (mean.accuracy, mean.accuracy_by_area) == (pytest.approx(0.6), pytest.approx(0.8))
    assert (mean.mean_iou, mean.boundary_distance) == (pytest.approx(0.45), pytest.approx(0.05))


def test_refuses_a_mean_of_nothing():
    with pytest.raises(NotEnoughDataError, match="needs a shape"):
        mean_agreement([])
