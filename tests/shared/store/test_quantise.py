"""Quantised histograms: the bound of the error, and what is refused."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from partwise.errors import ParameterError
from partwise.store.quantise import dequantise, quantise

_histograms = arrays(
    np.float32, st.tuples(st.integers(1, 8), st.just(256)), elements=st.floats(0, 1e6, width=32, allow_subnormal=False)
)


@settings(max_examples=40, deadline=None)
@given(_histograms)
def test_error_is_at_most_half_a_step(h: np.ndarray) -> None:
    quantised = quantise(h)
    error = np.abs(dequantise(quantised.codes, quantised.scale) - np.sqrt(h, dtype=np.float64))
    assert error.max() <= float(quantised.scale) / 2 * (1 + 1e-4)  # the rest is float32's own rounding


def test_the_largest_value_takes_the_last_code() -> None:
    assert quantise(np.array([[0.0, 1.0, 9.0]], np.float32)).codes.tolist() == [[0, 85, 255]]


def test_zeros_stay_zeros() -> None:
    quantised = quantise(np.zeros((3, 256), np.float32))
    assert quantised.scale == 0
    assert not dequantise(quantised.codes, quantised.scale).any()


def test_types_are_as_stored() -> None:
    quantised = quantise(np.ones((2, 256), np.float32))
    assert (quantised.codes.dtype, quantised.scale.dtype) == (np.uint8, np.float32)
    assert dequantise(quantised.codes, quantised.scale).dtype == np.float32


@pytest.mark.parametrize("bad", [-1.0, np.nan, np.inf])
def test_what_is_no_histogram_is_refused(bad: float) -> None:
    h = np.ones((2, 256), np.float32)
    h[1, 7] = bad
    with pytest.raises(ParameterError, match="finite and at least 0"):
        quantise(h)


def test_another_shape_is_refused() -> None:
    with pytest.raises(ParameterError, match="shape"):
        quantise(np.ones(256, np.float32))
