"""Times of gestures: the laws they follow, term by term."""

from dataclasses import replace

import numpy as np
import pytest

from partwise.errors import ParameterError
from partwise.simulate.annotator.motor import Gesture, Hand, MotorModel, Tool, command_s, undo_s

MODEL = MotorModel()
UP, DOWN = np.array([0.0, 0.0, 1.0]), np.array([0.0, 0.0, -1.0])
HERE = np.zeros(3)
HAND = Hand(pointer=HERE, view=UP, tool=Tool.PAINT, part=1)
CLICK = Gesture(Tool.PAINT, 1, HERE, UP, 0.1, HERE)


def extra_s(gesture: Gesture) -> float:
    return HAND.seconds(gesture, MODEL) - HAND.seconds(CLICK, MODEL)


def test_a_click_where_the_pointer_is_costs_deciding_pointing_and_the_button():
    assert HAND.seconds(CLICK, MODEL) == pytest.approx(MODEL.decide_s + MODEL.point_s + MODEL.button_s)


def test_pointing_costs_a_bit_for_each_doubling():
    far = replace(CLICK, place=np.array([0.3, 0, 0]))  # 0.3 / 0.1 + 1 = 4
    assert extra_s(far) == pytest.approx(2 * MODEL.point_bit_s)


def test_a_drag_costs_its_length_over_its_width():
    assert extra_s(replace(CLICK, path=0.5)) == pytest.approx(5 * MODEL.steer_s)


def test_another_tool_or_part_must_be_picked():
    pick = MODEL.prepare_s + MODEL.key_s
    assert extra_s(replace(CLICK, part=2)) == pytest.approx(pick)
    assert extra_s(replace(CLICK, tool=Tool.PATCHES, part=2)) == pytest.approx(2 * pick)


def test_what_faces_away_costs_a_turn_and_is_in_view_afterwards():
    behind = replace(CLICK, normal=DOWN)
    assert extra_s(behind) == pytest.approx(MODEL.turn_s)
    np.testing.assert_array_equal(HAND.after(behind).view, DOWN)
    np.testing.assert_array_equal(HAND.after(CLICK).view, UP)


def test_the_hand_is_where_the_drag_ended_with_its_tool():
    end = np.array([0.0, 0.2, 0.0])
    after = HAND.after(Gesture(Tool.PATCHES, 2, HERE, UP, 0.1, end, path=0.2))
    assert (after.tool, after.part) == (Tool.PATCHES, 2)
    np.testing.assert_array_equal(after.pointer, end)


def test_a_command_costs_more_than_taking_it_back():
    assert command_s(MODEL) > undo_s(MODEL) > 0


@pytest.mark.parametrize("value", [-0.1, np.inf, np.nan])
@pytest.mark.parametrize("name", ["turn_s", "aim"])
def test_refuses_times_that_are_none(name, value):
    with pytest.raises(ParameterError, match=name):
        MotorModel(**{name: value})
