"""Contours of fields whose surface is known."""

import numpy as np
import pytest

from partwise.errors import DegenerateMeshError
from partwise.geometry.contouring import contour, grid_over
from partwise.geometry.manifold import manifold_report

BOX = np.array([[-1.0, -1.0, -1.0], [1.0, 1.0, 1.0]])


def ball(points: np.ndarray) -> np.ndarray:
    return np.linalg.norm(points, axis=1) - 0.8


def test_a_ball_s_contour_is_clean_and_lies_on_the_ball() -> None:
    mesh = contour(ball, grid_over(BOX, 0.05), steepness=1.0)
    assert manifold_report(mesh).is_clean
    np.testing.assert_allclose(np.linalg.norm(mesh.vertices, axis=1), 0.8, atol=0.002)


def test_the_grid_has_room_around_the_box() -> None:
    grid = grid_over(BOX, 0.1)
    high = grid.origin + (np.array(grid.shape) - 1) * grid.spacing
    assert (grid.origin < BOX[0] - 0.1).all()
    assert (high > BOX[1] + 0.1).all()


def test_a_field_without_a_surface_is_refused() -> None:
    with pytest.raises(DegenerateMeshError, match="does not cross"):
        contour(lambda points: np.ones(len(points)), grid_over(BOX, 0.1), steepness=1.0)
