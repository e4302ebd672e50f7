"""How close people's labels are: identities, analytic values, the medoid."""

import numpy as np
import pytest

from partwise.mesh import TriMesh
from partwise.store.records import Closeness
from partwise.workspace.consensus import agreement, closeness, compared


@pytest.fixture
def square() -> TriMesh:
    """A flat strip of four equal triangles."""
    vertices = np.array([[0, 0, 0], [1, 0, 0], [2, 0, 0], [0, 1, 0], [1, 1, 0], [2, 1, 0]], dtype=np.float64)
    faces = np.array([[0, 1, 4], [0, 4, 3], [1, 2, 5], [1, 5, 4]], dtype=np.int64)
    return TriMesh(vertices, faces)


def _labels(*values: int) -> np.ndarray:
    return np.array(values, dtype=np.uint16)


def test_labels_agree_with_themselves(square: TriMesh) -> None:
    labels = _labels(1, 1, 2, 0)
    for found in (agreement(square, labels, labels), closeness(square, labels, labels)):
        assert found == Closeness(1.0, 1.0, 0.0)


def test_agreement_is_symmetric(square: TriMesh) -> None:
    first, second = _labels(1, 1, 2, 2), _labels(1, 2, 2, 0)
    assert agreement(square, first, second) == agreement(square, second, first)


def test_area_and_parts_are_as_counted(square: TriMesh) -> None:
    found = agreement(square, _labels(1, 1, 2, 2), _labels(1, 1, 1, 2))
    assert found.area_agreement == pytest.approx(3 / 4)
    assert found.part_iou == pytest.approx((2 / 3 + 1 / 2) / 2)
    assert found.boundary_distance > 0


def test_what_a_reference_leaves_open_does_not_count(square: TriMesh) -> None:
    found = closeness(square, _labels(1, 2, 2, 1), _labels(1, 0, 2, 0))
    assert (found.area_agreement, found.part_iou) == (1.0, 1.0)


def test_faces_left_unlabelled_are_wrong_against_a_reference(square: TriMesh) -> None:
    assert closeness(square, _labels(1, 0, 2, 2), _labels(1, 1, 2, 2)).area_agreement == pytest.approx(3 / 4)


@pytest.mark.parametrize(("label", "share"), [(0, 1.0), (1, 0.0)])
def test_a_reference_that_says_nothing_agrees_with_nothing(square: TriMesh, label: int, share: float) -> None:
    assert closeness(square, _labels(*[label] * 4), _labels(0, 0, 0, 0)).area_agreement == share


def test_the_medoid_is_closest_to_the_others(square: TriMesh) -> None:
    peers = [(7, _labels(1, 1, 1, 1)), (9, _labels(1, 1, 1, 2))]
    assert compared(square, peers, _labels(1, 1, 2, 2)).medoid == 9
    assert compared(square, peers, _labels(1, 1, 1, 2)).medoid == 9
    assert compared(square, [(7, _labels(1, 1, 1, 1)), (9, _labels(1, 1, 2, 2))], _labels(1, 1, 1, 2)).medoid is None


def test_the_mean_is_over_all_pairs(square: TriMesh) -> None:
    found = compared(square, [(7, _labels(1, 1, 1, 1)), (9, _labels(1, 1, 1, 2))], _labels(1, 1, 2, 2))
    assert found.peers == (7, 9)
    assert found.closeness.area_agreement == pytest.approx((3 / 4 + 2 / 4 + 3 / 4) / 3)


def test_labels_without_peers_agree_with_themselves(square: TriMesh) -> None:
    found = compared(square, [], _labels(1, 1, 2, 2))
    assert (found.peers, found.closeness, found.medoid) == ((), Closeness(1.0, 1.0, 0.0), None)
