"""SC and SI as stored: the square root of a histogram in 8 bits, with one scale per shape.

The network sees sqrt(h), so that is what the error bound is about: at most half a step, scale / 2, per value.
"""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float32, UInt8

from partwise.errors import ParameterError

_STEPS = 255


@dataclass(frozen=True, slots=True, eq=False)
class Quantised:
    """codes (m, bins) uint8; sqrt(h) ≈ codes · scale. `scale` is max sqrt(h) / 255, and 0 where all of h is."""

    codes: UInt8[np.ndarray, "m bins"]
    scale: np.float32


def quantise(h: Float32[np.ndarray, "m bins"]) -> Quantised:
    """Histograms (m, bins) float32, ≥ 0, to 8-bit codes of their square roots.

    Raises
    ------
    ParameterError : not two-dimensional, negative, NaN or infinite.
    """
    if h.ndim != 2:
        raise ParameterError(f"histograms must be (faces, bins) but have shape {h.shape}")
    largest = float(h.max(initial=0.0))
    if not np.isfinite(largest) or (h.size and not h.min() >= 0):  # NaN fails the comparison too
        raise ParameterError(
            "histograms must be finite and at least 0 but some are not; was a degenerate face described?"
        )
    scale = np.float32(np.sqrt(largest) / _STEPS)
    if scale == 0:
        return Quantised(np.zeros(h.shape, np.uint8), np.float32(0))
    codes = np.rint(np.sqrt(h) / scale)
    return Quantised(np.minimum(codes, _STEPS).astype(np.uint8), scale)


def dequantise(codes: UInt8[np.ndarray, "m bins"], scale: float | np.floating) -> Float32[np.ndarray, "m bins"]:
    """sqrt(h) (m, bins) float32, within scale / 2 of what was quantised."""
    return codes.astype(np.float32) * np.float32(scale)
