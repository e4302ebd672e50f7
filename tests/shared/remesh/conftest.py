"""Shapes and the renderer that the tests of remeshing share."""

from collections.abc import Iterator

import numpy as np
import pytest
import trimesh

from partwise.mesh import TriMesh
from partwise.render.raycast import RayCastRenderer


@pytest.fixture(scope="session")
def renderer() -> Iterator[RayCastRenderer]:
    with RayCastRenderer() as opened:
        yield opened


@pytest.fixture(scope="session")
def ball() -> TriMesh:
    """A closed manifold of 1,280 faces."""
    return from_trimesh(trimesh.creation.icosphere(subdivisions=3))


@pytest.fixture(scope="session")
def open_bowl(ball: TriMesh) -> TriMesh:
    """A sheet without thickness."""
    return TriMesh(ball.vertices, ball.faces[ball.vertices[ball.faces].mean(axis=1)[:, 1] < 0.2])


def from_trimesh(shape: trimesh.Trimesh) -> TriMesh:
    return TriMesh(np.asarray(shape.vertices), np.asarray(shape.faces))
