"""The shapes of the acceptance threshold's experiment: docs/remeshing.md has its table."""

from dataclasses import replace
from math import sqrt

from partwise.remesh.calibration import Calibration, KnownShape, calibrate
from partwise.remesh.parameters import RemeshParameters
from partwise.render.raycast import RayCastRenderer
from partwise.simulate.collection import CATEGORIES, shape_seed, simulate_shape

REFUSES_NOTHING = sqrt(2.0)


def known_shapes(per_category: int, seed: int) -> list[KnownShape]:
    """Of every category so many simulated soups, each with the clean mesh of its design."""
    shapes = []
    for category in sorted(CATEGORIES):
        for index in range(per_category):
            shape = shape_seed(category, seed, index)
            dirty = simulate_shape(category, shape, str(index), dirty=True)
            clean = simulate_shape(category, shape, str(index))
            shapes.append(KnownShape(category, str(index), dirty.mesh, dirty.labels, clean.mesh))
    return shapes


def calibrated(per_category: int, n_faces: int, seed: int) -> Calibration:
    """About six core-seconds a shape."""
    parameters = replace(RemeshParameters(), max_distance=REFUSES_NOTHING, levels=(n_faces,))
    with RayCastRenderer() as renderer:
        return calibrate(known_shapes(per_category, seed), parameters, n_faces, renderer)
