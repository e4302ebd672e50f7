"""The benchmark of annotation cost: rows, summaries, comparisons, and that it repeats."""

import json

import numpy as np
import pytest

from partwise.errors import NotEnoughDataError
from partwise.simulate.collection import simulate_shape
from partwise_cli.bench.annotating import Start, TaskShape, measure_annotating
from partwise_cli.bench.patches import TrueShape


def mug(index: int) -> TaskShape:
    shape = simulate_shape("mugs", index, f"mug-{index}", n_faces=1500)
    truth = np.unique(shape.labels, return_inverse=True)[1]
    return TaskShape(TrueShape(f"mugs/{index}", shape.mesh, truth), ("body", "handle"))


@pytest.fixture(scope="module")
def mugs() -> list[TaskShape]:
    return [mug(0), mug(1)]


@pytest.fixture(scope="module")
def measured(mugs):
    return measure_annotating(mugs, seed=0)


def test_every_shape_has_each_start_with_and_without_refinement_to_each_target(measured):
    keys = {(row.shape, row.start, row.refinement, row.target) for row in measured.rows}
    assert len(measured.rows) == len(keys) == 2 * len(Start) * 2 * 2
    assert all(row.reached for row in measured.rows)
    assert measured.simulated


def test_more_right_costs_more(measured):
    for start in Start:
        for refinement in (False, True):
            less, more = (measured.values(start, refinement, target, "clicks") for target in (0.95, 0.97))
            assert all(a <= b for a, b in zip(less, more, strict=True))


def test_painting_alone_costs_most(measured):
    blank = measured.values(Start.BLANK, False, 0.97, "strokes")
    for start in (Start.PATCHES, Start.PREDICTED, Start.REFINED):
        assert np.mean(measured.values(start, False, 0.97, "strokes")) < np.mean(blank)


def test_a_summary_has_medians_of_the_rows(measured):
    (row,) = (
        row for row in measured.summary() if (row["start"], row["refinement"], row["target"]) == ("blank", False, 0.95)
    )
    assert row["n"] == 2
    assert row["n_unreached"] == 0
    assert row["median_strokes"] == np.median(measured.values(Start.BLANK, False, 0.95, "strokes"))
    assert row["mean_clicks"] == np.mean(measured.values(Start.BLANK, False, 0.95, "clicks"))


def test_comparisons_are_of_the_named_pairs(measured):
    found = {(what, target): pair for what, target, pair in measured.comparisons()}
    pair = found["patches − blank, with refinement", 0.95]
    first, second = (measured.values(start, True, 0.95, "strokes") for start in (Start.PATCHES, Start.BLANK))
    assert pair.mean == pytest.approx(np.mean(np.subtract(first, second)))
    pair = found["predicted: with − without refinement", 0.97]
    first, second = (measured.values(Start.PREDICTED, way, 0.97, "strokes") for way in (True, False))
    assert pair.median == np.median(np.subtract(first, second))


def test_what_is_made_agrees_with_the_truth_as_far_as_the_target(measured):
    for start in Start:
        for which in ("plain", "refinement"):
            assert measured.agreements[start, which].accuracy_by_area >= 0.97
    assert measured.agreements[Start.PREDICTED, "start"].accuracy_by_area < 0.97
    assert set(measured.agreements[Start.BLANK, "plain"].iou) == {"mugs/body", "mugs/handle"}
    assert (Start.BLANK, "start") not in measured.agreements


def test_a_shape_comes_out_the_same_whatever_the_others(mugs, measured):
    alone = measure_annotating(mugs[1:], seed=0)
    assert alone.rows == tuple(row for row in measured.rows if row.shape == "mugs/1")


def test_the_result_is_plain_json(measured):
    document = json.loads(json.dumps(measured.as_json()))
    assert document["predictions"] == "simulated"
    assert len(document["rows"]) == len(measured.rows)
    assert set(document["comparisons"]) == {"strokes", "clicks", "active_s"}
    assert {each["labels"] for each in document["agreement"]} == {"start", "plain", "refinement"}


def test_given_predictions_are_begun_with_and_missing_ones_left_out(mugs):
    shape = mugs[0].shape
    given = TaskShape(shape, mugs[0].part_names, predicted=shape.truth)
    seen: list[str] = []
    result = measure_annotating([given], seed=0, targets=(0.9,), on_shape=seen.append)
    assert seen == [shape.name]
    assert not result.simulated
    assert {row.start for row in result.rows} == {Start.BLANK, Start.PATCHES, Start.PREDICTED}
    assert result.values(Start.PREDICTED, False, 0.9, "strokes") == [0]
    assert not [what for what, _, _ in result.comparisons() if what.startswith("refined")]


def test_refuses_to_measure_nothing():
    with pytest.raises(NotEnoughDataError, match="none"):
        measure_annotating([], seed=0)
