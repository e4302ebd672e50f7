"""The terms of boundary refinement, by their formulas."""

from dataclasses import replace

import numpy as np
import pytest

from partwise.segmentation.boundary_costs import crease_strength, cut_costs, leaving_costs
from partwise.segmentation.creases import Creases
from partwise.segmentation.parameters import PAPER_BOUNDARY, BoundaryParameters

DEFAULT = BoundaryParameters()
FLAT, CONCAVE, CONVEX, THINNER = range(4)


def creases(has_diameter: bool = True) -> Creases:
    """Four edges: flat, concave and convex by half a radian, and flat with a change of diameter."""
    angles, jumps = np.array([0.0, 0.5, -0.5, 0.0]), np.array([0.0, 0.0, 0.0, 0.2])
    return Creases(angles, angles.copy(), jumps, jumps.copy(), has_diameter)


def test_leaving_costs_grow_from_the_least_at_the_boundary_to_all_of_the_area_over_the_band() -> None:
    distances, areas = np.array([[0.0, 0.0], [9.0, 0.02], [9.0, np.inf]]), np.array([1.0, 1.0, 3.0])
    cost = leaving_costs(np.zeros(3, dtype=np.int64), distances, areas, DEFAULT)
    np.testing.assert_allclose(cost, [[0, 0.4 / 0.04], [0, 0.7 / 0.04], [0, 3 / 0.04]])


def test_the_paper_s_band_is_flat_and_counts_faces_alike() -> None:
    distances = np.array([[0.005, 0.005], [np.inf, 0.02]])
    cost = leaving_costs(np.zeros(2, dtype=np.int64), distances, np.array([1.0, 7.0]), PAPER_BOUNDARY)
    np.testing.assert_array_equal(cost, [[0.5, 0.5], [0.0, 1.0]])


@pytest.mark.parametrize("parameters", [DEFAULT, PAPER_BOUNDARY])
def test_unlabelled_faces_leave_for_nothing(parameters: BoundaryParameters) -> None:
    cost = leaving_costs(np.array([-1]), np.array([[0.0, np.inf]]), np.ones(1), parameters)
    np.testing.assert_array_equal(cost, 0.0)


def test_a_cut_costs_its_length_where_nothing_is_seen_less_where_concave_and_more_where_convex() -> None:
    cost = cut_costs(creases(), np.full(4, 2.0), DEFAULT)
    assert cost[FLAT] == pytest.approx(DEFAULT.smoothness * 2.0)
    assert cost[CONCAVE] < cost[FLAT] < cost[CONVEX]
    assert cost[THINNER] < cost[FLAT]


def test_strength_is_gain_times_angle_and_bend_and_change_of_diameter() -> None:
    np.testing.assert_allclose(crease_strength(creases(), DEFAULT), [0, 1.5, -2.5, 0.9])


@pytest.mark.parametrize(
    ("omega", "expected"), [(1.0, [0, 1.5, -2.5, 0]), (0.0, [0, 0, 0, 0.9]), (0.75, [0, 1.5, -2.5, 0.45])]
)
def test_omega_fades_one_of_them_out(omega: float, expected: list[float]) -> None:
    np.testing.assert_allclose(crease_strength(creases(), replace(DEFAULT, angle_weight=omega)), expected)


@pytest.mark.parametrize("parameters", [DEFAULT, PAPER_BOUNDARY])
def test_without_diameters_only_angles_count(parameters: BoundaryParameters) -> None:
    lengths = np.ones(4)
    np.testing.assert_array_equal(
        cut_costs(creases(has_diameter=False), lengths, parameters),
        cut_costs(creases(), lengths, replace(parameters, angle_weight=1.0)),
    )


def test_the_paper_s_cut_is_the_logarithm_of_its_dissimilarity() -> None:
    lengths = np.array([1.0, 1.0, 1.0, 5.0])  # 2 on average
    share = np.array([1e-3, 0.2 * 0.5, 0.2 * 0.5, 0.8 * 0.2]) / [1, *[0.2 * np.pi + 0.8] * 3]
    np.testing.assert_allclose(cut_costs(creases(), lengths, PAPER_BOUNDARY), -np.log(share) * lengths / 2)
