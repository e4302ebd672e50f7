"""Parameters of model refinement, as the configuration file has them."""

import math
from dataclasses import dataclass

from partwise.errors import ParameterError

# "λ tuned on training folds over {0.05 … 5}": a factor of about two a step.
SMOOTHNESS_CANDIDATES = (0.05, 0.1, 0.2, 0.5, 1.0, 2.0, 5.0)


@dataclass(frozen=True, slots=True)
class RefinementParameters:
    """How a model's probabilities become labels by graph cut.

    smoothness : λ ≥ 0, weight of boundaries against the model's word; 0 keeps the model's first choice everywhere.
    weight_by_area : whether a face's word counts in proportion to its area (else every face counts the same).
    convex_factor : in (0, 1], how much of a convex edge's angle counts, so that cuts prefer concave edges.
    probability_floor : in (0, 1), the least probability a label is given.
    angle_floor : in (0, 1), the least share of π an angle is given; bounds the cost of a cut through a flat region.
    max_sweeps : at most this many rounds over the labels; two or three suffice in practice.
    """

    smoothness: float = 1.0
    weight_by_area: bool = True
    convex_factor: float = 0.08
    probability_floor: float = 1e-6
    angle_floor: float = 1e-3
    max_sweeps: int = 20

    def __post_init__(self) -> None:
        check_smoothness(self.smoothness)
        if not 0 < self.convex_factor <= 1:
            raise ParameterError(f"convex_factor must be in (0, 1] but is {self.convex_factor}; the paper uses 0.08")
        for name in ("probability_floor", "angle_floor"):
            if not 0 < getattr(self, name) < 1:
                raise ParameterError(f"{name} must be in (0, 1) but is {getattr(self, name)}; use a small number")
        if self.max_sweeps < 1:
            raise ParameterError(f"max_sweeps must be at least 1 but is {self.max_sweeps}; use about 20")


def check_smoothness(smoothness: float) -> None:
    """Raises ParameterError unless 0 ≤ smoothness < ∞."""
    if not 0 <= smoothness < math.inf:
        raise ParameterError(f"smoothness must be finite and ≥ 0 but is {smoothness}; try {SMOOTHNESS_CANDIDATES}")
