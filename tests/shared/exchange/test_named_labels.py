"""Names to part ids: exact, or refused with a hint."""

import numpy as np
import pytest

from partwise.errors import LabelError
from partwise.exchange.named_labels import NamedLabels, to_part_ids

LABELS = NamedLabels(("seat", "back"), np.array([0, 1, -1, 1]))


@pytest.mark.parametrize(
    ("names", "indices", "message"),
    [
        (("seat", " "), np.array([0]), "must not be empty"),
        (("seat", "seat"), np.array([0]), "must be distinct"),
        (("seat",), np.array([0, 1]), "one of 1 parts but one is 1"),
        (("seat",), np.array([0, -2]), "one is -2"),
    ],
)
def test_refuses(names, indices, message):
    with pytest.raises(LabelError, match=message):
        NamedLabels(names, indices)


@pytest.mark.parametrize("indices", [np.zeros((2, 2), dtype=int), np.array([0.5])])
def test_indices_are_one_whole_number_a_face(indices):
    with pytest.raises(LabelError, match="whole numbers"):
        NamedLabels(("seat",), indices)


def test_indices_cannot_be_written():
    with pytest.raises(ValueError, match="read-only"):
        LABELS.indices[0] = 1


def test_ids_are_the_schemas():
    assert to_part_ids(LABELS, {"back": 7, "seat": 3, "leg": 1}, "a.txt").tolist() == [3, 7, -1, 7]


def test_no_parts_at_all():
    assert to_part_ids(NamedLabels((), np.array([-1, -1])), {}, "a.txt").tolist() == [-1, -1]


@pytest.mark.parametrize(
    ("known", "hint"),
    [
        ({"seat": 0, "Back": 1}, "did you mean 'Back'"),
        ({"seat": 0, "backs": 1, "rack": 2}, "'backs'"),
        ({"seat": 0, "leg": 1}, "add the part or rename it"),
    ],
)
def test_an_unknown_part_is_named_with_its_file_and_near_matches(known, hint):
    with pytest.raises(LabelError, match=r"^a\.txt: part 'back' must be in the schema") as caught:
        to_part_ids(LABELS, known, "a.txt")
    assert hint in str(caught.value)


def test_a_part_without_faces_must_be_known_too():
    with pytest.raises(LabelError, match="'leg'"):
        to_part_ids(NamedLabels(("seat", "leg"), np.array([0])), {"seat": 0}, "a.txt")
