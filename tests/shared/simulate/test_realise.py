"""What cannot become one clean piece is refused."""

import numpy as np
import pytest

from partwise.errors import DegenerateMeshError
from partwise.simulate.blueprint import Blueprint, Piece
from partwise.simulate.primitives import Box, Ellipsoid, place
from partwise.simulate.realise import part_of_piece, realise, require_one_piece

BALL = Ellipsoid((0.3, 0.3, 0.3))
APART = Blueprint((Piece(BALL, "a"), Piece(place(BALL, (1.0, 0.0, 0.0)), "b")), blend=0.01)
TOGETHER = Blueprint((Piece(BALL, "a"), Piece(place(BALL, (0.4, 0.0, 0.0)), "b")), blend=0.01)


def test_pieces_that_do_not_touch_are_refused() -> None:
    with pytest.raises(DegenerateMeshError, match="must be one piece"):
        realise(APART, ("a", "b"), 2000)


def test_pieces_that_do_not_touch_are_refused_before_they_become_soup() -> None:
    with pytest.raises(DegenerateMeshError, match="must be one piece"):
        require_one_piece(APART)


def test_too_few_faces_for_the_shape_are_refused() -> None:
    with pytest.raises(DegenerateMeshError, match="ask for more faces"):
        realise(TOGETHER, ("a", "b"), 3)


def test_labels_change_half_way_between_two_balls() -> None:
    mesh, labels = realise(TOGETHER, ("a", "b"), 3000)
    middle = mesh.vertices[mesh.faces].mean(axis=1)[:, 0]
    np.testing.assert_array_equal(labels, (middle > 0.2).astype(int))


def test_parts_are_numbered_by_their_names_order() -> None:
    blueprint = Blueprint((Piece(BALL, "b"), Piece(Box((0.1, 0.1, 0.1)), "a")), blend=0.0)
    assert part_of_piece(blueprint, ("a", "b")).tolist() == [1, 0]
