"""`python -m partwise.render.gl_probe` draws a tetrahedron with GL and exits with 0 where the picture is right."""

import sys

import numpy as np

from partwise.mesh import TriMesh
from partwise.render.gl import GlRenderer
from partwise.render.raycast import RayCastRenderer

MIN_AGREEMENT = 0.99  # share of pixels where both renderers see surface, or both see none


def main() -> str | None:
    """None where GL draws what ray casting draws, else what is wrong."""
    tetrahedron = TriMesh(
        np.array([[1, 1, 1], [1, -1, -1], [-1, 1, -1], [-1, -1, 1]], dtype=np.float64),
        np.array([[0, 1, 2], [0, 3, 1], [0, 2, 3], [1, 3, 2]]),
    )
    with GlRenderer() as renderer:
        drawn = renderer.depth_views(tetrahedron) > 0
    expected = RayCastRenderer().depth_views(tetrahedron) > 0
    agreement = float((drawn == expected).mean())
    if agreement < MIN_AGREEMENT:
        return f"GL agrees with ray casting on {agreement:.1%} of pixels only; the driver draws wrongly"
    return None


if __name__ == "__main__":
    sys.exit(main())
