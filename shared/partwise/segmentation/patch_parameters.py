"""Parameters of over-segmentation, and the names of its methods."""

import math
from dataclasses import dataclass
from typing import Literal

from partwise.errors import ParameterError

PatchMethod = Literal["random_walks", "k_means"]


@dataclass(frozen=True, slots=True)
class RandomWalkParameters:
    """How walks move over the surface, and what a patch has in common.

    convex_factor : η in (0, 1], how much of a convex crease counts; concave ones count fully.
    crease_scale : σ > 0, how many times the mean crease a crease must be to let e times less through.
    reach : > 0, how far a walk comes before it stops on a flat surface: √time, as a share of the diagonal.
    thickness_weight : ≥ 0, what a difference of 1 in shape diameter counts, as a share of the diagonal.

    Raises
    ------
    ParameterError : a value outside its range.
    """

    convex_factor: float = 0.1
    crease_scale: float = 1.0
    reach: float = 0.17
    thickness_weight: float = 0.5

    def __post_init__(self) -> None:
        if not 0 < self.convex_factor <= 1:
            raise ParameterError(f"convex_factor must be in (0, 1] but is {self.convex_factor}; 0.1 is usual")
        for name, usual in (("crease_scale", 1.0), ("reach", 0.17)):
            value = getattr(self, name)
            if not (value > 0 and math.isfinite(value)):
                raise ParameterError(f"{name} must be positive and finite but is {value}; {usual} is usual")
        if not (self.thickness_weight >= 0 and math.isfinite(self.thickness_weight)):
            raise ParameterError(
                f"thickness_weight must be ≥ 0 and finite but is {self.thickness_weight}; 0.5 is usual"
            )


@dataclass(frozen=True, slots=True)
class KMeansParameters:
    """What k-means compares, and how long.

    normal_weight : ≥ 0, what a difference of 1 in the unit normal counts, as a share of the diagonal.
    max_iterations : ≥ 1, bound on Lloyd's rounds; they stop earlier once nothing changes.

    Raises
    ------
    ParameterError : a value outside its range.
    """

    normal_weight: float = 0.2
    max_iterations: int = 20

    def __post_init__(self) -> None:
        if not (self.normal_weight >= 0 and math.isfinite(self.normal_weight)):
            raise ParameterError(f"normal_weight must be ≥ 0 and finite but is {self.normal_weight}; 0.2 is usual")
        if self.max_iterations < 1:
            raise ParameterError(f"max_iterations must be at least 1 but is {self.max_iterations}; 20 is usual")
