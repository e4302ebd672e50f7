"""A simulated mug with its parts, seen and equipped for annotators."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
import pytest

from partwise.labels.palette import default_colour
from partwise.labels.schema import Part, PartSchema
from partwise.mesh import TriMesh
from partwise.segmentation.boundary_refinement import BoundaryRefiner
from partwise.segmentation.k_means_patches import KMeansPatches
from partwise.simulate.annotator.motor import Tool
from partwise.simulate.annotator.session import Equipment
from partwise.simulate.annotator.sight import Sight
from partwise.simulate.collection import simulate_shape

ALL_STROKES = frozenset({Tool.PAINT, Tool.PATCHES, Tool.SEGMENT_WIDE})


@dataclass(frozen=True, slots=True, eq=False)
class Desk:
    """belongs : part ids 1 and 2. equipped : equipment of these tools, with what they need."""

    mesh: TriMesh
    belongs: np.ndarray
    sight: Sight
    schema: PartSchema
    equipped: Callable[..., Equipment]


@pytest.fixture(scope="session")
def desk() -> Desk:
    shape = simulate_shape("mugs", 0, "mug", n_faces=1500)
    belongs = np.unique(shape.labels, return_inverse=True)[1] + 1
    cutter, refiner = KMeansPatches(shape.mesh), BoundaryRefiner.build(shape.mesh)
    patches = [cutter.patches(n) for n in (10, 20, 40)]

    def equipped(*tools: Tool, **options) -> Equipment:
        return Equipment(
            tools=frozenset(tools),
            patches=patches if Tool.PATCHES in tools else (),
            refine=refiner.refine if Tool.BOUNDARY_REFINEMENT in tools else None,
            **options,
        )

    schema = PartSchema(1, tuple(Part(i, name, default_colour(i)) for i, name in enumerate(("body", "handle"), 1)))
    return Desk(shape.mesh, belongs, Sight.of(shape.mesh, belongs), schema, equipped)
