"""How right labels are where ground truth is on record."""

import numpy as np
import pytest

from partwise.store.records import RevisionKind
from partwise.workspace.assessment import assess
from partwise.workspace.choices import Segmentation
from partwise.workspace.labelling import commit_labels


def _truth(filled, key: str, labels: list[int]) -> None:
    ids = np.array(labels, dtype=np.uint16)
    commit_labels(filled.workspace, filled.collection, filled.shape(key), ids, RevisionKind.REFERENCE, "truth")


def _assess(filled, segmentation: Segmentation = Segmentation.PREDICTED) -> dict[str, tuple[float, float]]:
    found = assess(filled.workspace, filled.collection, segmentation)
    return {each.shape.source_key: (each.by_face, each.by_area) for each in found}


def test_shapes_without_ground_truth_are_left_out(filled) -> None:
    filled.described().evaluated()
    _truth(filled, "a.off", [1, 1, 1, 1])
    assert _assess(filled) == {"a.off": (1.0, 1.0)}


def test_accuracy_counts_faces_and_area(filled) -> None:
    filled.described().evaluated()  # says that everything is the body
    _truth(filled, "a.off", [1, 1, 2, 1])  # the third face is the large one, √3 / 2 against 1 / 2
    large = np.sqrt(3) / 2
    assert _assess(filled)["a.off"] == pytest.approx((0.75, 1.5 / (1.5 + large)))


def test_faces_without_ground_truth_do_not_count(filled) -> None:
    filled.described().evaluated()
    _truth(filled, "a.off", [0, 1, 0, 2])
    assert _assess(filled)["a.off"] == pytest.approx((0.5, 0.5))


def test_ground_truth_of_nothing_is_left_out(filled) -> None:
    filled.described().evaluated()
    _truth(filled, "a.off", [0, 0, 0, 0])
    assert _assess(filled) == {}


def test_unlabelled_faces_are_wrong(filled) -> None:
    filled.preprocessed()
    _truth(filled, "a.off", [1, 1, 1, 1])
    half = np.array([1, 1, 0, 0], dtype=np.uint16)
    commit_labels(filled.workspace, filled.collection, filled.shape("a.off"), half, RevisionKind.HUMAN, "ann")
    assert _assess(filled, Segmentation.CONFIRMED)["a.off"][0] == pytest.approx(0.5)


def test_refined_labels_are_assessed_by_themselves(filled) -> None:
    filled.refined(filled.described().evaluated())  # says that everything is the handle
    _truth(filled, "a.off", [1, 1, 1, 1])
    assert _assess(filled, Segmentation.REFINED) == {"a.off": (0.0, 0.0)}
