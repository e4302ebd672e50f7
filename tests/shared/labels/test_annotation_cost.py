"""Strokes, clicks and seconds of a log."""

import dataclasses
import math
from collections.abc import Callable
from datetime import datetime, timedelta

import numpy as np
import pytest

from partwise.errors import ParameterError
from partwise.labels.annotation_cost import AnnotationCost, annotation_cost
from partwise.labels.label_delta import LabelDelta
from partwise.labels.operations import Assign, Clear, Delta, DeltaSource, Operation, Paint, Redo, SegmentWide, Undo
from partwise.labels.strokes import Stroke
from partwise.segmentation.paint import Brush

MakeStroke = Callable[..., Stroke]

_DELTA = LabelDelta.between(np.zeros(3, np.uint16), np.ones(3, np.uint16))
_EACH: tuple[Operation, ...] = (
    Paint((0, 1, 2), Brush(0.1), 1),
    Assign(((0, 2),), 1),
    SegmentWide(0, 2),
    Undo(),
    Redo(),
    Delta(DeltaSource.MODEL_REFINEMENT, _DELTA),
    Clear(),
    Undo(),
)


@pytest.fixture
def strokes_at(make_stroke: MakeStroke) -> Callable[..., list[Stroke]]:
    def at_seconds(*seconds: float) -> list[Stroke]:
        start = make_stroke(0, Clear()).at
        return [
            dataclasses.replace(make_stroke(n, SegmentWide(0, 1)), at=start + timedelta(seconds=second))
            for n, second in enumerate(seconds)
        ]

    return at_seconds


def test_each_kind_counts_as_what_it_is(make_stroke: MakeStroke) -> None:
    cost = annotation_cost([make_stroke(n, operation) for n, operation in enumerate(_EACH)])
    assert (cost.strokes, cost.commands, cost.undos, cost.redos, cost.clicks) == (3, 2, 2, 1, 8)
    assert cost.undo_share == pytest.approx(2 / 5)


def test_nothing_costs_nothing() -> None:
    cost = annotation_cost([])
    assert cost == AnnotationCost(0, 0, 0, 0, 0.0, 0)
    assert cost.undo_share == 0


def test_idle_gaps_are_left_out_and_counted(strokes_at: Callable[..., list[Stroke]]) -> None:
    cost = annotation_cost(strokes_at(0, 4, 34, 64.5, 70))
    assert cost.active_s == pytest.approx(4 + 30 + 5.5)
    assert cost.n_idle_gaps == 1


def test_the_threshold_is_a_parameter(strokes_at: Callable[..., list[Stroke]]) -> None:
    strokes = strokes_at(0, 4, 34, 64.5, 70)
    assert annotation_cost(strokes, idle_after_s=5).active_s == pytest.approx(4)
    assert annotation_cost(strokes, idle_after_s=math.inf).active_s == pytest.approx(70)


def test_the_look_before_the_first_stroke_counts_when_it_is_known(strokes_at: Callable[..., list[Stroke]]) -> None:
    strokes = strokes_at(0, 4)
    opened = strokes[0].at - timedelta(seconds=12)
    assert annotation_cost(strokes, opened_at=opened).active_s == pytest.approx(16)
    assert annotation_cost(strokes, opened_at=opened - timedelta(hours=1)).active_s == pytest.approx(4)
    assert annotation_cost([], opened_at=opened).active_s == 0


def test_clocks_that_disagree_never_make_time_negative(strokes_at: Callable[..., list[Stroke]]) -> None:
    strokes = strokes_at(10, 4)
    assert annotation_cost(strokes, opened_at=strokes[0].at + timedelta(hours=1)).active_s == pytest.approx(6)


def test_the_order_of_strokes_does_not_matter(strokes_at: Callable[..., list[Stroke]]) -> None:
    strokes = strokes_at(0, 3, 9, 50, 51)
    assert annotation_cost(strokes[::-1]) == annotation_cost(strokes)


def test_two_people_do_not_share_their_pauses(strokes_at: Callable[..., list[Stroke]]) -> None:
    mine, yours = strokes_at(0, 20), [dataclasses.replace(stroke, author_id=8) for stroke in strokes_at(10, 35)]
    assert annotation_cost([*mine, *yours]).active_s == pytest.approx(20 + 25)
    assert annotation_cost([*mine, *yours], opened_at=mine[0].at - timedelta(seconds=5)).active_s == pytest.approx(50)


def test_costs_add_up(strokes_at: Callable[..., list[Stroke]]) -> None:
    one, other = annotation_cost(strokes_at(0, 4)), annotation_cost(strokes_at(0, 40, 41))
    assert one + other == AnnotationCost(5, 0, 0, 0, 5.0, 1)


@pytest.mark.parametrize("threshold", [0, -1, math.nan])
def test_a_threshold_that_is_none_is_refused(threshold: float) -> None:
    with pytest.raises(ParameterError, match="above 0 seconds"):
        annotation_cost([], idle_after_s=threshold)


def test_an_opening_without_zone_is_refused() -> None:
    with pytest.raises(ParameterError, match="opened_at must have a zone"):
        annotation_cost([], opened_at=datetime(2026, 3, 1))
