"""All four descriptors of a mesh at once, with the core-seconds and memory each took."""

import time
from collections.abc import Callable
from dataclasses import dataclass
from typing import Self, TypeVar

import numpy as np
from jaxtyping import Float32, UInt8

from partwise.features.light_field import light_field
from partwise.features.parameters import DescribeParameters
from partwise.features.shape_context import shape_context
from partwise.features.shape_diameter import shape_diameter
from partwise.features.spin_image import spin_image
from partwise.geometry.normalise import normalise
from partwise.mesh import TriMesh
from partwise.render.probe import open_depth_renderer


@dataclass(frozen=True, slots=True, eq=False)
class Description:
    """Descriptors of one mesh.

    shape_context, spin_image : (m, 256) float32 histograms. shape_diameter : (m,) float32 in [0, 1].
    light_field : (208080,) uint8. core_s : descriptor → seconds of processor time, all threads.
    """

    shape_context: Float32[np.ndarray, "m 256"]
    spin_image: Float32[np.ndarray, "m 256"]
    shape_diameter: Float32[np.ndarray, " m"]
    light_field: UInt8[np.ndarray, " 208080"]
    core_s: dict[str, float]


class Describer:
    """Describes meshes one after the other with one renderer, which it owns: use as a context, or `close`."""

    def __init__(self, parameters: DescribeParameters) -> None:
        self._parameters = parameters
        self._renderer = open_depth_renderer(parameters.light_field.renderer)

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    @property
    def renderer(self) -> str:
        """Which depth renderer the probe chose: gl or raycast."""
        return self._renderer.name

    def close(self) -> None:
        self._renderer.close()

    def describe(self, mesh: TriMesh) -> Description:
        """Normalises the mesh and describes it. DegenerateMeshError if it has no area or extent."""
        normalised = normalise(mesh)
        p = self._parameters
        core_s: dict[str, float] = {}
        return Description(
            _timed(core_s, "shape_context", lambda: shape_context(normalised, p.shape_context)),
            _timed(core_s, "spin_image", lambda: spin_image(normalised, p.spin_image)),
            _timed(core_s, "shape_diameter", lambda: shape_diameter(normalised, p.shape_diameter)),
            _timed(core_s, "light_field", lambda: light_field(normalised, self._renderer)),
            core_s,
        )


T = TypeVar("T")


def _timed(core_s: dict[str, float], name: str, compute: Callable[[], T]) -> T:
    started = time.process_time()
    result = compute()
    core_s[name] = time.process_time() - started
    return result
