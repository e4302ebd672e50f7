"""Meshes and renderers shared by the tests of pictures."""

from collections.abc import Iterator

import numpy as np
import pytest
import trimesh

from partwise.mesh import TriMesh
from partwise.render.gl import GlRenderer
from partwise.render.views import RenderError


@pytest.fixture(scope="session")
def gl_renderer() -> Iterator[GlRenderer]:
    try:
        renderer = GlRenderer()
    except RenderError as error:
        pytest.skip(f"no GL context can be made here: {error}")
    with renderer:
        yield renderer


@pytest.fixture(scope="session")
def meshes() -> dict[str, TriMesh]:
    """Closed, open, non-convex, thin and mixed-up surfaces."""
    knot = trimesh.creation.torus(0.8, 0.25).apply_translation([5.0, -3.0, 100.0])
    ball = trimesh.creation.icosphere(subdivisions=3)
    lower = ball.triangles_center[:, 1] < 0.2
    soup = trimesh.creation.annulus(0.5, 1.0, 0.2)
    rng = np.random.default_rng(3)
    flipped = np.where(rng.random(len(soup.faces))[:, None] < 0.5, soup.faces, soup.faces[:, ::-1])
    return {
        "sphere": _mesh(trimesh.creation.icosphere(subdivisions=4)),
        "box": _mesh(trimesh.creation.box(extents=(0.01, 0.02, 0.005))),
        "torus far from the origin": _mesh(knot),
        "open bowl": TriMesh(ball.vertices, ball.faces[lower]),
        "randomly oriented ring": TriMesh(soup.vertices, flipped),
        "one triangle": TriMesh(np.array([[0.0, 0, 0], [1, 0, 0.3], [0.2, 1, 0]]), np.array([[0, 1, 2]])),
    }


def _mesh(shape: trimesh.Trimesh) -> TriMesh:
    return TriMesh(np.asarray(shape.vertices), np.asarray(shape.faces))
