"""Two ways of doing the same, compared shape by shape."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from partwise.errors import NotEnoughDataError

N_RESAMPLES = 4_000
COVERAGE = 0.95


@dataclass(frozen=True, slots=True)
class PairedDifference:
    """First less second, over shapes that both were measured on.

    median_first, median_second : of each. median, mean : of the differences, interval : of the mean, by bootstrap
    over shapes, 95 %. less, equal, more : in how many shapes the first is.
    """

    n: int
    median_first: float
    median_second: float
    median: float
    mean: float
    interval: tuple[float, float]
    less: int
    equal: int
    more: int

    @property
    def is_less(self) -> bool:
        """Whether the whole interval is below 0."""
        return self.interval[1] < 0


def paired_difference(first: Sequence[float], second: Sequence[float], rng: np.random.Generator) -> PairedDifference:
    """Of values in the same order of shapes.

    Raises
    ------
    NotEnoughDataError : no values, or not as many of one as of the other.
    """
    if not len(first) or len(first) != len(second):
        raise NotEnoughDataError(
            f"a comparison needs values of the same shapes but has {len(first)} and {len(second)}; measure both"
        )
    difference = np.asarray(first, dtype=np.float64) - np.asarray(second, dtype=np.float64)
    resampled = difference[rng.integers(0, len(difference), (N_RESAMPLES, len(difference)))].mean(axis=1)
    low, high = np.quantile(resampled, [(1 - COVERAGE) / 2, (1 + COVERAGE) / 2])
    return PairedDifference(
        n=len(difference),
        median_first=float(np.median(first)),
        median_second=float(np.median(second)),
        median=float(np.median(difference)),
        mean=float(difference.mean()),
        interval=(float(low), float(high)),
        less=int((difference < 0).sum()),
        equal=int((difference == 0).sum()),
        more=int((difference > 0).sum()),
    )
