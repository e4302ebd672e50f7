"""The upper bound that patches allow, and the table of it."""

import itertools
import json
import os
from pathlib import Path

import numpy as np
import pytest

from partwise.errors import NotEnoughDataError
from partwise.exchange.labels_psb import read_psb_labels
from partwise.io.read import read_mesh
from partwise.mesh import TriMesh
from partwise.simulate.collection import simulate_shape
from partwise_cli.bench.patches import TrueShape, best_labels, measure_patches

DATA = os.environ.get("PARTWISE_DATA")


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


def test_a_patch_a_face_is_right_everywhere():
    mesh = TriMesh(np.vstack([np.zeros(3), np.eye(3)]), np.array([[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]]))
    measured = measure_patches([TrueShape("tetrahedron", mesh, np.array([0, 1, 1, 2]))], n_patches=(4, 80))
    assert measured.mean_accuracy("random_walks") == measured.mean_accuracy("k_means") == (pytest.approx(1.0),) * 2


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


@pytest.mark.skipif(not DATA, reason="PARTWISE_DATA is not set: no real meshes at hand")
def test_on_real_shapes_random_walks_are_well_ahead():
    def real(name):
        file = Path(str(DATA)) / "lpsb" / f"{name}.off"
        mesh = read_mesh(file)
        return TrueShape(name, mesh, read_psb_labels(file.with_name(f"{file.stem}_labels.txt"), mesh.n_faces).indices)

    measured = measure_patches([real("Glasses/46"), real("Octopus/121"), real("Human/1")], (20, 40))
    walks, k_means = (np.array(measured.mean_accuracy(method)) for method in ("random_walks", "k_means"))
    assert walks.min() > 0.9
    assert (walks - k_means).min() > 0.03
