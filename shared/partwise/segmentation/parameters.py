"""Parameters of model refinement, as the configuration file has them, and of boundary refinement."""

import math
from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType
from typing import Literal, get_args

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


BoundaryForm = Literal["crease", "paper"]


@dataclass(frozen=True, slots=True)
class BoundaryParameters:
    """How the boundaries of given labels are drawn to nearby creases. `PAPER_BOUNDARY` is the paper's preset.

    form : crease, the default, or paper. Costs of both are in `partwise.segmentation.boundary_costs`.
    angle_weight : ω in [0, 1], the angles' weight against the change of shape diameter; 1 leaves the diameter out.
    band : σ > 0, how far from a boundary its labels are in doubt, as a fraction of the bounding box's diagonal.
    smoothness : λ ≥ 0, weight of cuts against staying.
    max_sweeps : at most this many rounds over the labels.

    Of the crease form:
    least_move_cost : in [0, 1], cost of a face's change right at the boundary, growing linearly to 1 at σ. Above 0, a
        boundary that has little to gain stays where it is, so that repeated passes do not wear parts away.
    flatness : how unlikely a boundary is where there is no sign of a crease; the logit of that, negative.
    concave_gain, convex_gain : ≥ 0, evidence per radian for and against a boundary.
    diameter_gain : ≥ 0, evidence per change of shape diameter across 2 % of the diagonal.

    Of the paper's form:
    angle_floor : in (0, 1), the least share of its range a crease is given; bounds the cost of a flat cut.

    Raises
    ------
    ParameterError : a value outside these ranges.
    """

    form: BoundaryForm = "crease"
    angle_weight: float = 0.5
    band: float = 0.04
    smoothness: float = 0.18
    max_sweeps: int = 20
    least_move_cost: float = 0.4
    flatness: float = 1.0
    concave_gain: float = 1.5
    convex_gain: float = 2.5
    diameter_gain: float = 4.5
    angle_floor: float = 1e-3

    def __post_init__(self) -> None:
        if self.form not in get_args(BoundaryForm):
            choices = ", ".join(get_args(BoundaryForm))
            raise ParameterError(f"form must be one of {choices} but is {self.form!r}; correct it")
        check_smoothness(self.smoothness)
        if not 0 < self.band < math.inf:
            raise ParameterError(f"band must be positive and finite but is {self.band}; 0.04 is usual")
        if self.max_sweeps < 1:
            raise ParameterError(f"max_sweeps must be at least 1 but is {self.max_sweeps}; use about 20")
        for name in ("angle_weight", "least_move_cost"):
            if not 0 <= getattr(self, name) <= 1:
                raise ParameterError(f"{name} must be in [0, 1] but is {getattr(self, name)}; leave it out")
        for name in ("concave_gain", "convex_gain", "diameter_gain"):
            if not 0 <= getattr(self, name) < math.inf:
                raise ParameterError(f"{name} must be finite and ≥ 0 but is {getattr(self, name)}; leave it out")
        if not -math.inf < self.flatness < math.inf:
            raise ParameterError(f"flatness must be finite but is {self.flatness}; 1 is usual")
        if not 0 < self.angle_floor < 1:
            raise ParameterError(f"angle_floor must be in (0, 1) but is {self.angle_floor}; use a small number")


PAPER_BOUNDARY = BoundaryParameters(form="paper", angle_weight=0.2, band=0.01, smoothness=1.0)
BOUNDARY_PRESETS: Mapping[str, BoundaryParameters] = MappingProxyType(
    {"default": BoundaryParameters(), "paper": PAPER_BOUNDARY}
)
"""What the command line and the annotation client offer by name."""
