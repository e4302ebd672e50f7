"""The benchmark of refinement: its rows, its means, and what it is given to measure."""

import json
from dataclasses import replace

import numpy as np
import pytest

from partwise.errors import NotEnoughDataError
from partwise.simulate.collection import simulate_shape
from partwise_cli.bench.patches import TrueShape
from partwise_cli.bench.refinement import (
    VARIANTS,
    half_labelled,
    measure_boundary_refinement,
    measure_model_refinement_time,
    noisy_probabilities,
)


@pytest.fixture(scope="module")
def mug() -> TrueShape:
    shape = simulate_shape("mugs", 0, "mug", n_faces=1500)
    return TrueShape("mug", shape.mesh, np.unique(shape.labels, return_inverse=True)[1])


@pytest.fixture(scope="module")
def measured(mug):
    return measure_boundary_refinement([mug], seed=3, n_passes=2)


def test_every_variant_has_a_row_with_the_start_and_each_pass(measured):
    assert [row.variant for row in measured.rows] == list(VARIANTS)
    for row in measured.rows:
        assert len(row.displaced) == len(row.true) == len(row.displaced_distance) == len(row.true_distance) == 3
        assert row.true[0] == pytest.approx(1.0)
        assert row.true_distance[0] == pytest.approx(0.0, abs=1e-9)
        assert row.displaced[0] < 1.0


def test_gain_and_loss_are_differences_from_the_start(measured):
    row = measured.rows[0]
    means = measured.mean("default")
    assert means["gain"] == pytest.approx([100 * (value - row.displaced[0]) for value in row.displaced[1:]], abs=1e-3)
    assert means["loss"] == pytest.approx([100 * (1 - value) for value in row.true[1:]], abs=1e-3)


def test_the_result_is_plain_json_and_repeats_with_its_seed(mug, measured):
    def without_times(result):
        rows = json.loads(json.dumps(result.as_json()))["rows"]
        return [{key: value for key, value in row.items() if "core_ms" not in key} for row in rows]

    assert without_times(measured) == without_times(measure_boundary_refinement([mug], seed=3, n_passes=2))


def test_half_of_the_patches_are_labelled_and_every_part_is_among_them():
    patches = np.repeat(np.arange(10), 3)
    truth = np.where(patches == 7, 5, 2)
    partly = half_labelled(patches, truth, np.ones(30), np.random.default_rng(0))
    assert len(np.unique(patches[partly != -1])) == 5
    assert (partly[patches == 7] == 5).all()
    known = partly != -1
    np.testing.assert_array_equal(partly[known], truth[known])


def test_more_than_half_are_labelled_where_parts_need_it():
    patches = np.arange(4)
    truth = np.array([0, 1, 2, 2])
    partly = half_labelled(patches, truth, np.array([1.0, 1.0, 1.0, 2.0]), np.random.default_rng(0))
    np.testing.assert_array_equal(partly, [0, 1, -1, 2])


def test_probabilities_favour_the_label():
    labels = np.arange(4000) % 4
    probabilities = noisy_probabilities(labels, 4, np.random.default_rng(0))
    np.testing.assert_allclose(probabilities.sum(axis=1), 1.0)
    assert (np.argmax(probabilities, axis=1) == labels).mean() > 0.9


def test_model_refinement_has_a_row_for_each_number_of_labels(mug):
    result = measure_model_refinement_time([mug], seed=0, n_labels=(2, 4))
    assert [row.n_labels for row in result.rows] == [2, 4]
    assert set(json.loads(json.dumps(result.as_json()))["core_ms_at_10k_faces"]) == {"2", "4"}


@pytest.mark.parametrize("measure", [measure_boundary_refinement, measure_model_refinement_time])
def test_refuses_an_empty_folder(measure):
    with pytest.raises(NotEnoughDataError, match="there are none"):
        measure([], seed=0)


def test_what_a_shape_gets_depends_on_no_other_shape(mug, measured):
    before = TrueShape("first", mug.mesh, mug.truth)
    rows = measure_boundary_refinement([before, mug], seed=3, n_passes=2).rows
    of_mug = [row.displaced for row in rows if row.shape == "mug"]
    assert of_mug == [row.displaced for row in measured.rows]


def test_means_of_a_category_are_those_of_its_shapes(measured):
    row = measured.rows[0]
    inside = replace(row, shape="Cup/1", displaced=(0.5, 0.6, 0.6))
    both = replace(measured, rows=(row, inside)).as_json()
    assert both["by_category"]["Cup"][row.variant]["displaced"] == 50.0
    assert set(both["by_category"]) == {"", "Cup"}
