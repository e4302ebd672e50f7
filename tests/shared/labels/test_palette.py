"""Colours as text and as numbers."""

import pytest

from partwise.labels.palette import default_colour, rgb


@pytest.mark.parametrize("colour", ["#E69F00", "#e69f00"])
def test_a_colour_is_three_numbers(colour) -> None:
    assert rgb(colour) == (230, 159, 0)


def test_default_colours_are_text_of_the_same_kind() -> None:
    assert {len(rgb(default_colour(part_id))) for part_id in range(20)} == {3}
    assert len({default_colour(part_id) for part_id in range(6)}) == 6
