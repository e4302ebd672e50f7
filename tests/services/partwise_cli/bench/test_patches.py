"""The upper bound that patches allow, and the table of it."""

import itertools
import json

import numpy as np
import pytest

from partwise.errors import NotEnoughDataError
from partwise.simulate.collection import simulate_shape
from partwise_cli.bench.patches import TrueShape, best_labels, measure_patches


@pytest.fixture(scope="module")
def shape():
    simulated = simulate_shape("mugs", 0, "mug", n_faces=2000)
    return TrueShape("mug", simulated.mesh, simulated.labels)


def test_a_patch_takes_the_part_of_most_area():
    patches, truth = np.array([0, 0, 0, 1]), np.array([2, 1, 1, 0])
    np.testing.assert_array_equal(best_labels(patches, truth, np.array([3.0, 1, 1, 1])), [2, 2, 2, 0])


def test_unknown_truth_has_no_say():
    patches, truth = np.array([0, 0, 1]), np.array([-1, 1, -1])
    np.testing.assert_array_equal(best_labels(patches, truth, np.array([9.0, 1, 1])), [1, 1, -1])


def test_a_patch_a_face_is_right_everywhere(shape):
    measured = measure_patches([shape], n_patches=(shape.mesh.n_faces,))
    assert measured.mean_accuracy("random_walks") == measured.mean_accuracy("k_means") == (pytest.approx(1.0),)


def test_nested_patches_allow_more_the_more_they_are(shape):
    accuracy = measure_patches([shape]).mean_accuracy("random_walks")
    assert all(first <= second + 1e-12 for first, second in itertools.pairwise(accuracy))


def test_the_table_is_plain_json_with_means_over_shapes(shape):
    seen = []
    other = TrueShape("other", shape.mesh, np.zeros_like(shape.truth))
    table = json.loads(json.dumps(measure_patches([shape, other], (5, 10), on_shape=seen.append).as_json()))
    assert seen == ["mug", "other"]
    assert table["n_shapes"] == 2
    assert len(table["rows"]) == 4
    walks = [row["accuracy"] for row in table["rows"] if row["method"] == "random_walks"]
    np.testing.assert_allclose(table["accuracy"]["random_walks"], np.mean(walks, axis=0))
    np.testing.assert_allclose(
        table["ahead"], np.subtract(table["accuracy"]["random_walks"], table["accuracy"]["k_means"])
    )
    assert walks[1] == [pytest.approx(1.0)] * 2


def test_refuses_to_measure_nothing():
    with pytest.raises(NotEnoughDataError, match="none"):
        measure_patches([])
