"""Fields of the simple solids against analytic distances."""

import numpy as np
import pytest

from partwise.simulate.primitives import (
    Box,
    Clipped,
    Ellipsoid,
    Frustum,
    Mirrored,
    Rod,
    Solid,
    TorusArc,
    Tube,
    place,
    smooth_difference,
    smooth_union,
)
from partwise.simulate.sweeps import CurvedPanel, Extrusion, Lathe, LatheShell, Wing, superellipse

SOLIDS: dict[str, Solid] = {
    "box": Box((0.3, 0.2, 0.1), 0.05),
    "ellipsoid": Ellipsoid((0.3, 0.2, 0.25)),
    "rod": Rod((0.0, 0.0, 0.0), (0.2, 0.4, 0.1), 0.05, 0.1),
    "tube": Tube(((0.0, 0.0, 0.0), (0.2, 0.3, 0.0), (0.4, 0.3, 0.2)), (0.05, 0.04, 0.06)),
    "frustum": Frustum(0.3, 0.2, 0.1, 0.02),
    "torus arc": TorusArc(0.3, 0.05, 2.0),
    "extrusion": Extrusion(superellipse(0.3, 0.2, 3.0), 0.1, 0.03),
    "lathe": Lathe(((0.2, 0.0), (0.3, 0.2), (0.1, 0.5))),
    "lathe shell": LatheShell(((0.2, 0.0), (0.3, 0.2), (0.1, 0.5)), 0.04),
    "curved panel": CurvedPanel(0.4, 0.3, 0.2, 0.03, 0.02),
    "wing": Wing(0.6, 0.3, 0.15, 0.2, 0.05, 0.05, 0.01),
    "placed": place(Box((0.3, 0.2, 0.1)), (0.1, 0.2, -0.3), pitch=0.4, yaw=1.0, roll=-0.3),
    "mirrored": Mirrored(Rod((0.1, 0.0, 0.0), (0.5, 0.4, 0.1), 0.05, 0.1)),
    "clipped": Clipped(Ellipsoid((0.3, 0.2, 0.25)), -0.1, 0.15),
}


def points_in(radius: float, n: int = 4000) -> np.ndarray:
    return np.random.default_rng(0).uniform(-radius, radius, (n, 3))


@pytest.mark.parametrize("name", SOLIDS)
def test_a_solid_lies_inside_its_bounding_sphere(name: str) -> None:
    solid = SOLIDS[name]
    points = np.array(solid.centre) + points_in(1.5 * solid.radius)
    inside = points[solid.distance(points) < 0.0]
    assert len(inside) > 0
    assert np.linalg.norm(inside - solid.centre, axis=1).max() <= solid.radius * (1.0 + 1e-9)


@pytest.mark.parametrize("name", SOLIDS)
def test_a_field_is_no_steeper_than_contouring_allows_for(name: str) -> None:
    solid = SOLIDS[name]
    points = np.array(solid.centre) + points_in(1.5 * solid.radius)
    step = np.random.default_rng(1).normal(size=points.shape) * 0.01
    change = np.abs(solid.distance(points + step) - solid.distance(points))
    assert (change <= 1.35 * np.linalg.norm(step, axis=1) + 1e-12).all()


@pytest.mark.parametrize("name", SOLIDS)
def test_thickness_is_at_most_the_smallest_extent(name: str) -> None:
    solid = SOLIDS[name]
    points = np.array(solid.centre) + points_in(1.2 * solid.radius, 60_000)
    inside = points[solid.distance(points) < 0.0]
    assert 0.0 < solid.thickness <= np.ptp(inside, axis=0).min() * 1.2


def test_box_distance_is_zero_on_its_face_and_exact_at_a_corner() -> None:
    box = Box((1.0, 2.0, 3.0))
    np.testing.assert_allclose(box.distance(np.array([[1.0, 0.0, 0.0], [2.0, 3.0, 4.0]])), [0.0, np.sqrt(3.0)])


def test_ellipsoid_of_equal_radii_is_a_sphere() -> None:
    points = points_in(1.0)
    np.testing.assert_allclose(Ellipsoid((0.5,) * 3).distance(points), np.linalg.norm(points, axis=1) - 0.5, atol=1e-12)


def test_ellipsoid_is_deep_at_its_centre() -> None:
    assert Ellipsoid((0.3, 0.2, 0.4)).distance(np.zeros((1, 3)))[0] == -0.2


def test_rod_of_one_radius_is_a_capsule() -> None:
    rod = Rod((0.0, 0.0, 0.0), (0.0, 1.0, 0.0), 0.1, 0.1)
    np.testing.assert_allclose(rod.distance(np.array([[0.5, 0.5, 0.0], [0.0, 1.5, 0.0]])), [0.4, 0.4])


def test_tube_of_two_points_is_a_rod() -> None:
    ends = ((0.0, 0.1, 0.0), (0.4, 0.5, 0.2))
    np.testing.assert_allclose(
        Tube(ends, (0.1, 0.05)).distance(points_in(1.0)), Rod(*ends, 0.1, 0.05).distance(points_in(1.0))
    )


def test_frustum_of_one_radius_is_a_cylinder() -> None:
    points = points_in(1.0)
    side, cap = np.hypot(points[:, 0], points[:, 2]) - 0.2, np.abs(points[:, 1]) - 0.4
    exact = np.hypot(np.maximum(side, 0), np.maximum(cap, 0)) + np.minimum(np.maximum(side, cap), 0)
    np.testing.assert_allclose(Frustum(0.4, 0.2, 0.2).distance(points), exact, atol=1e-12)


def test_full_torus_arc_is_a_torus() -> None:
    points = points_in(1.0)
    ring = np.hypot(np.hypot(points[:, 0], points[:, 1]) - 0.5, points[:, 2]) - 0.1
    np.testing.assert_allclose(TorusArc(0.5, 0.1, np.pi).distance(points), ring, atol=1e-12)


def test_torus_arc_ends_where_it_should() -> None:
    arc = TorusArc(0.5, 0.1, np.pi / 2)
    np.testing.assert_allclose(arc.distance(np.array([[-0.5, 0.0, 0.0], [0.0, 0.5, 0.0]])), [np.sqrt(0.5) - 0.1, -0.1])


def test_place_turns_about_z_then_x_then_y() -> None:
    pin = place(Rod((0.0, 0.0, 0.0), (0.0, 1.0, 0.0), 0.01, 0.01), (1.0, 0.0, 0.0), pitch=np.pi / 2, yaw=np.pi / 2)
    assert pin.distance(np.array([[2.0, 0.0, 0.0]]))[0] == pytest.approx(-0.01)


def test_place_keeps_distances() -> None:
    solid, points = Ellipsoid((0.3,) * 3), points_in(1.0)
    moved = place(solid, (0.1, 0.2, 0.3), pitch=0.3, yaw=0.7, roll=1.1)
    np.testing.assert_allclose(moved.distance(points), solid.distance(points - [0.1, 0.2, 0.3]), atol=1e-12)


def test_clipped_ends_at_its_planes() -> None:
    clipped = Clipped(Box((1.0, 1.0, 1.0)), 0.0, 0.5)
    np.testing.assert_allclose(clipped.distance(np.array([[0, -0.1, 0], [0, 0.6, 0], [0, 0.25, 0]])), [0.1, 0.1, -0.25])


def test_smooth_union_never_lies_above_the_union() -> None:
    a, b = np.random.default_rng(0).normal(size=(2, 100))
    assert (smooth_union(a, b, 0.3) <= np.minimum(a, b)).all()


def test_smooth_union_far_from_a_seam_is_the_union() -> None:
    assert smooth_union(np.array([0.1]), np.array([0.5]), 0.3)[0] == 0.1


def test_smooth_union_without_blend_is_the_union() -> None:
    assert smooth_union(np.array([0.1]), np.array([0.1]), 0.0)[0] == 0.1


def test_smooth_difference_without_blend_is_the_difference() -> None:
    a, b = np.random.default_rng(0).normal(size=(2, 100))
    np.testing.assert_array_equal(smooth_difference(a, b, 0.0), np.maximum(a, -b))
