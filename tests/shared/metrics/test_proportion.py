"""Intervals of shares: published values, and that they hold the share."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from partwise.errors import ParameterError
from partwise.metrics.proportion import share_interval


@pytest.mark.parametrize(
    ("n_hits", "n_tried", "expected"),
    [  # Newcombe 1998, table I, method 3
        (81, 263, (0.2553, 0.3662)),
        (15, 148, (0.0624, 0.1605)),
        (0, 20, (0.0, 0.1611)),
        (1, 29, (0.0061, 0.1718)),
    ],
)
def test_intervals_are_the_published_ones(n_hits: int, n_tried: int, expected: tuple[float, float]) -> None:
    assert share_interval(n_hits, n_tried) == pytest.approx(expected, abs=1e-4)


@given(st.integers(0, 500).flatmap(lambda n: st.tuples(st.integers(0, n), st.just(n))))
def test_an_interval_holds_the_share_and_is_a_share(counts: tuple[int, int]) -> None:
    n_hits, n_tried = counts
    low, high = share_interval(n_hits, n_tried)
    assert 0 <= low <= (n_hits / n_tried if n_tried else 0.5) <= high <= 1


def test_nothing_tried_says_nothing() -> None:
    assert share_interval(0, 0) == (0, 1)


@pytest.mark.parametrize(("n_hits", "n_tried"), [(2, 1), (-1, 3)])
def test_counts_that_cannot_be_are_refused(n_hits: int, n_tried: int) -> None:
    with pytest.raises(ParameterError, match="hits"):
        share_interval(n_hits, n_tried)
