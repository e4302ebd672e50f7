"""Whether a remeshed surface still is the shape: a clean manifold that looks like the original from 20 sides."""

from dataclasses import dataclass

import numpy as np
from jaxtyping import UInt8

from partwise.features.light_field import light_field, light_field_distance
from partwise.mesh import TriMesh
from partwise.remesh.accept_as_is import defects_of
from partwise.render.views import DepthRenderer


@dataclass(frozen=True, slots=True)
class Verdict:
    """distance : light-field distance to the original, None where the surface was not clean enough to be compared.

    refused : why, in words; None where the surface is accepted.
    """

    distance: float | None
    refused: str | None

    @property
    def is_accepted(self) -> bool:
        return self.refused is None


def judge(
    candidate: TriMesh, original: UInt8[np.ndarray, " 208080"], renderer: DepthRenderer, max_distance: float
) -> Verdict:
    """Accepts a closed, oriented manifold in one piece within `max_distance` of the original's light field.

    Source: George, Xie, Lai, Tam 2018. Differs: the threshold is calibrated, see docs/remeshing.md.
    """
    defects = defects_of(candidate)
    if defects is not None:
        return Verdict(None, defects)
    distance = light_field_distance(light_field(candidate, renderer), original)
    if distance > max_distance:
        return Verdict(distance, f"light-field distance {distance:.3f} where at most {max_distance:.3f} is accepted")
    return Verdict(distance, None)
