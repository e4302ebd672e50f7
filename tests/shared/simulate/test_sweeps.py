"""Profiles and the solids swept from them."""

import numpy as np
import pytest

from partwise.simulate.primitives import Box, Frustum
from partwise.simulate.sweeps import (
    CurvedPanel,
    Extrusion,
    Lathe,
    LatheShell,
    Wing,
    polygon_distance,
    smooth_curve,
    superellipse,
)

SQUARE = np.array([[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]])
POINTS = np.random.default_rng(0).uniform(-0.8, 0.8, (3000, 3))


def test_polygon_distance_of_a_square_is_exact() -> None:
    at = np.array([[0.0, 0.0], [2.0, 0.0], [2.0, 2.0], [0.5, 0.0]])
    np.testing.assert_allclose(polygon_distance(at, SQUARE), [-1.0, 1.0, np.sqrt(2.0), -0.5])


def test_polygon_distance_does_not_depend_on_winding() -> None:
    np.testing.assert_array_equal(
        polygon_distance(POINTS[:, :2], SQUARE), polygon_distance(POINTS[:, :2], SQUARE[::-1])
    )


def test_open_polygon_has_no_surface_on_its_last_edge() -> None:
    half = np.array([[0.0, -1.0], [1.0, -1.0], [1.0, 1.0], [0.0, 1.0]])
    assert polygon_distance(np.array([[0.0, 0.0]]), half, is_closed=False)[0] == -1.0


def test_extruded_rectangle_is_a_box() -> None:
    outline = ((-0.3, -0.2), (0.3, -0.2), (0.3, 0.2), (-0.3, 0.2))
    np.testing.assert_allclose(
        Extrusion(outline, 0.1).distance(POINTS), Box((0.3, 0.1, 0.2)).distance(POINTS), atol=1e-12
    )


def test_lathe_of_a_slanted_line_is_a_frustum() -> None:
    lathe = Lathe(((0.3, -0.4), (0.1, 0.4)))
    np.testing.assert_allclose(lathe.distance(POINTS), Frustum(0.4, 0.3, 0.1).distance(POINTS), atol=1e-12)


def test_lathe_shell_is_hollow_on_its_axis() -> None:
    assert LatheShell(((0.3, 0.0), (0.3, 1.0)), 0.1).distance(np.array([[0.0, 0.5, 0.0]]))[0] == pytest.approx(0.25)


def test_panel_of_large_bend_is_a_box() -> None:
    panel = CurvedPanel(1e6, 0.3, 0.2, 0.05)
    np.testing.assert_allclose(panel.distance(POINTS), Box((0.3, 0.2, 0.05)).distance(POINTS), atol=1e-5)


def test_panel_ends_come_forward() -> None:
    panel = CurvedPanel(0.5, 0.5 * np.pi / 2, 0.2, 0.05)
    assert panel.distance(np.array([[0.5, 0.0, 0.49]]))[0] < 0.0


def test_wing_tip_lies_behind_its_root_by_the_sweep() -> None:
    wing = Wing(1.0, 0.3, 0.3, 0.5, 0.1, 0.05, 0.01)
    tip = np.array([[0.99, 0.099, -0.65], [0.99, 0.099, -0.15]])
    assert (wing.distance(tip) < 0.0).tolist() == [True, False]


def test_superellipse_of_power_two_is_an_ellipse() -> None:
    x, z = np.array(superellipse(0.4, 0.2, 2.0)).T
    np.testing.assert_allclose((x / 0.4) ** 2 + (z / 0.2) ** 2, 1.0)


def test_smooth_curve_passes_through_its_knots() -> None:
    knots = ((0.0, 0.0), (1.0, 2.0), (3.0, 1.0))
    curve = np.array(smooth_curve(knots, 5))
    np.testing.assert_allclose(curve[[0, 2, 4]], knots, atol=1e-12)
