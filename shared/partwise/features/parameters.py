"""Parameters of the descriptors. They load nothing heavy, so that a configuration can be read anywhere."""

from dataclasses import dataclass, field
from typing import Literal, get_args

import numpy as np

from partwise.errors import ParameterError

N_BINS = 16
"""Along each side of the histograms that blocks store and the network reads."""
RendererChoice = Literal["auto", "gl", "raycast"]


@dataclass(frozen=True, slots=True)
class ShapeContextParameters:
    """Size of the histogram and when to sample.

    n_angle_bins, n_distance_bins : bins over [−90°, 90°] and over [0, 1.2·g95].
    all_pairs_below : meshes with at most this many faces use every face as a target.
    n_targets : above that, the number of sampled targets of each connected component.

    Raises
    ------
    ParameterError : a number of bins or targets below 1, or a negative all_pairs_below.
    """

    n_angle_bins: int = 16
    n_distance_bins: int = 16
    all_pairs_below: int = 5000
    n_targets: int = 6000

    def __post_init__(self) -> None:
        for name, least in (("n_angle_bins", 1), ("n_distance_bins", 1), ("all_pairs_below", 0), ("n_targets", 1)):
            if getattr(self, name) < least:
                raise ParameterError(f"{name} must be at least {least} but is {getattr(self, name)}; raise it")


@dataclass(frozen=True, slots=True)
class SpinImageParameters:
    """Size of the image.

    support : greatest distance from the axis, and the extent along it, in normalised units.
    n_bins : bins along each side; one is support / n_bins wide (0.125 by default).

    Raises
    ------
    ParameterError : a support that is not positive and finite, or fewer than one bin.
    """

    support: float = 2.0
    n_bins: int = 16

    def __post_init__(self) -> None:
        if not 0 < self.support < np.inf:
            raise ParameterError(f"support must be positive and finite but is {self.support}; 2.0 is usual")
        if self.n_bins < 1:
            raise ParameterError(f"n_bins must be at least 1 but is {self.n_bins}; 16 is usual")


@dataclass(frozen=True, slots=True)
class ShapeDiameterParameters:
    """The cone of rays and the final scale.

    alpha : of ln(αx + 1)/ln(α + 1), > 0. 4 is Shapira's; CGAL uses 5.
    n_rays : rays per face.
    cone_degrees : opening angle, in (0, 180).

    Raises
    ------
    ParameterError : a value outside these ranges.
    """

    alpha: float = 4.0
    n_rays: int = 25
    cone_degrees: float = 120.0

    def __post_init__(self) -> None:
        if not 0 < self.alpha < np.inf:
            raise ParameterError(f"alpha must be positive and finite but is {self.alpha}; 4 is usual")
        if self.n_rays < 1:
            raise ParameterError(f"n_rays must be at least 1 but is {self.n_rays}; 25 is usual")
        if not 0 < self.cone_degrees < 180:
            raise ParameterError(f"cone_degrees must lie in (0, 180) but is {self.cone_degrees}; 120 is usual")


@dataclass(frozen=True, slots=True)
class LightFieldParameters:
    """How the depth views are made; descriptors are the same either way.

    renderer : gl, raycast, or auto: gl where a probe finds that it works.

    Raises
    ------
    ParameterError : another renderer.
    """

    renderer: RendererChoice = "auto"

    def __post_init__(self) -> None:
        if self.renderer not in get_args(RendererChoice):
            choices = ", ".join(get_args(RendererChoice))
            raise ParameterError(f"renderer must be one of {choices} but is {self.renderer!r}; correct it")


@dataclass(frozen=True, slots=True)
class DescribeParameters:
    """All of a description's parameters.

    Raises
    ------
    ParameterError : histograms of another size than 16 × 16, which blocks and the network could not take.
    """

    shape_context: ShapeContextParameters = field(default_factory=ShapeContextParameters)
    spin_image: SpinImageParameters = field(default_factory=SpinImageParameters)
    shape_diameter: ShapeDiameterParameters = field(default_factory=ShapeDiameterParameters)
    light_field: LightFieldParameters = field(default_factory=LightFieldParameters)

    def __post_init__(self) -> None:
        sizes = {self.shape_context.n_angle_bins, self.shape_context.n_distance_bins, self.spin_image.n_bins}
        if sizes != {N_BINS}:
            raise ParameterError(f"histograms must be {N_BINS} × {N_BINS} but bins are {sorted(sizes)}; leave them out")
