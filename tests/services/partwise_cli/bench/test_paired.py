"""Comparison shape by shape."""

import numpy as np
import pytest

from partwise.errors import NotEnoughDataError
from partwise_cli.bench.paired import paired_difference


def test_differences_are_counted_by_sign():
    pair = paired_difference([1, 2, 3, 9], [2, 2, 5, 3], np.random.default_rng(0))
    assert (pair.n, pair.less, pair.equal, pair.more) == (4, 2, 1, 1)
    assert (pair.median_first, pair.median_second, pair.median, pair.mean) == (2.5, 2.5, -0.5, 0.75)
    assert pair.interval[0] < pair.mean < pair.interval[1]
    assert not pair.is_less


def test_a_constant_difference_is_sure():
    pair = paired_difference([1, 5, 7], [3, 7, 9], np.random.default_rng(0))
    assert pair.interval == (-2.0, -2.0)
    assert pair.is_less


def test_the_interval_is_that_of_a_mean():
    values = np.random.default_rng(1).normal(0.0, 1.0, 400)
    pair = paired_difference(values.tolist(), [0.0] * 400, np.random.default_rng(0))
    half = (pair.interval[1] - pair.interval[0]) / 2
    assert half == pytest.approx(1.96 * values.std() / 20, rel=0.1)


@pytest.mark.parametrize("second", [[], [1.0, 2.0]])
def test_refuses_values_of_other_shapes(second):
    with pytest.raises(NotEnoughDataError, match="same shapes"):
        paired_difference(second and [1.0], second, np.random.default_rng(0))
