"""The printed formula, at points where its value is known."""

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from partwise.errors import ParameterError
from partwise.learning.schedule import cycle_length, learning_rate_at, snapshot_iterations


@pytest.mark.parametrize("start", [1, 1001, 2001, 3001, 4001])
def test_each_cycle_starts_at_the_initial_rate(start: int) -> None:
    assert learning_rate_at(start, 5000, 5, 0.01) == 0.01


@pytest.mark.parametrize("middle", [501, 1501, 4501])
def test_half_way_through_a_cycle_the_rate_is_half(middle: int) -> None:
    assert learning_rate_at(middle, 5000, 5, 0.01) == pytest.approx(0.005, abs=1e-12)


@pytest.mark.parametrize("end", [1000, 5000])
def test_a_cycle_ends_next_to_zero(end: int) -> None:
    expected = 0.005 * (1 - math.cos(math.pi / 1000))
    assert learning_rate_at(end, 5000, 5, 0.01) == pytest.approx(expected, rel=1e-9)


@given(st.integers(1, 6), st.integers(1, 50), st.floats(1e-4, 0.1))
def test_the_rates_of_a_cycle_average_to_just_over_half(n_snapshots: int, length: int, initial: float) -> None:
    # The cosines of 0, π/L … (L−1)π/L sum to 1.
    rates = [learning_rate_at(t, n_snapshots * length, n_snapshots, initial) for t in range(1, length + 1)]
    assert sum(rates) == pytest.approx(initial / 2 * (length + 1))


def test_a_cycle_is_rounded_up() -> None:
    assert cycle_length(10, 3) == 4


def test_snapshots_are_taken_at_the_ends_of_the_cycles() -> None:
    assert snapshot_iterations(5000, 5) == (1000, 2000, 3000, 4000, 5000)


@pytest.mark.parametrize("iteration", [0, 5001])
def test_iterations_outside_the_schedule_are_refused(iteration: int) -> None:
    with pytest.raises(ParameterError, match=r"must be in 1 … 5000"):
        learning_rate_at(iteration, 5000, 5, 0.01)


@pytest.mark.parametrize(("n_iterations", "n_snapshots"), [(0, 1), (10, 0), (10, 3), (2, 5)])
def test_a_cycle_that_would_be_cut_is_refused(n_iterations: int, n_snapshots: int) -> None:
    with pytest.raises(ParameterError, match="multiple of n_snapshots"):
        snapshot_iterations(n_iterations, n_snapshots)
