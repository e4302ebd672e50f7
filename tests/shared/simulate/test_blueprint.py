"""Fields of whole blueprints."""

import numpy as np

from partwise.simulate.blueprint import Blueprint, Deformation, Piece, random_ripples
from partwise.simulate.collection import CATEGORIES
from partwise.simulate.primitives import Ellipsoid, Solid, place

POINTS = np.random.default_rng(3).uniform(-1.0, 1.0, (3000, 3))


def ball(x: float, radius: float = 0.3) -> Solid:
    return place(Ellipsoid((radius,) * 3), (x, 0.0, 0.0))


TWO_BALLS = Blueprint((Piece(ball(-0.3), "left"), Piece(ball(0.4), "right")), blend=0.0)


def test_without_blend_the_field_is_the_minimum_of_the_pieces() -> None:
    pieces = np.min([piece.solid.distance(POINTS) for piece in TWO_BALLS.pieces], axis=0)
    np.testing.assert_array_equal(TWO_BALLS.distance(POINTS), pieces)


def test_the_nearest_piece_is_the_one_with_the_least_distance() -> None:
    pieces = np.argmin([piece.solid.distance(POINTS) for piece in TWO_BALLS.pieces], axis=0)
    np.testing.assert_array_equal(TWO_BALLS.nearest_piece(POINTS), pieces)


def test_skipping_far_pieces_changes_no_sign() -> None:
    blueprint = CATEGORIES["chairs"].draw(np.random.default_rng(5))
    straight = blueprint.deformation.to_straight(POINTS)
    union = np.min([piece.solid.distance(straight) for piece in blueprint.pieces], axis=0)
    inside = union < 0.0
    assert (blueprint.distance(POINTS)[inside] < 0.0).all()


def test_a_carving_is_taken_away() -> None:
    hollow = Blueprint((Piece(ball(0.0, 0.5), "body"),), blend=0.0, carvings=(ball(0.0, 0.2),))
    np.testing.assert_allclose(hollow.distance(np.zeros((1, 3))), [0.2])


def test_a_piece_alone_is_carved_too() -> None:
    hollow = Blueprint((Piece(ball(0.0, 0.5), "body"),), blend=0.0, carvings=(ball(0.0, 0.2),))
    np.testing.assert_array_equal(hollow.piece_distance(0, POINTS), hollow.distance(POINTS))


def test_thickness_is_that_of_the_thinnest_piece_or_wall() -> None:
    pieces = (Piece(ball(0.0, 0.2), "a"), Piece(ball(0.5, 0.1), "b"))
    assert [Blueprint(pieces, 0.0, wall=wall).thickness for wall in (np.inf, 0.05)] == [0.2, 0.05]


def test_no_deformation_moves_nothing() -> None:
    np.testing.assert_array_equal(Deformation().to_straight(POINTS), POINTS)


def test_lean_moves_points_by_their_height() -> None:
    straight = Deformation(lean=0.1, pivot=0.5).to_straight(np.array([[0.0, 1.5, 0.1]]))
    np.testing.assert_allclose(straight, [[0.0, 1.5, 0.0]], atol=1e-12)


def test_ripples_stay_near_their_amplitude() -> None:
    moved = random_ripples(np.random.default_rng(0), 0.01).displacement(POINTS)
    assert 0.0 < np.abs(moved).max() < 0.05


def test_bounds_hold_every_category() -> None:
    for category in CATEGORIES.values():
        blueprint = category.draw(np.random.default_rng(11))
        low, high = blueprint.bounds()
        around = np.random.default_rng(0).uniform(low - 0.3, high + 0.3, (20_000, 3))
        inside = around[blueprint.distance(around) < 0.0]
        assert ((inside > low) & (inside < high)).all(), category.name


def test_piece_bounds_hold_the_piece() -> None:
    blueprint = CATEGORIES["planes"].draw(np.random.default_rng(2))
    points = np.random.default_rng(0).uniform(*blueprint.bounds(), (40_000, 3))
    for index in range(len(blueprint.pieces)):
        low, high = blueprint.piece_bounds(index)
        inside = points[blueprint.piece_distance(index, points) < 0.0]
        assert ((inside > low) & (inside < high)).all()
