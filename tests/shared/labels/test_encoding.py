"""Label arrays as bytes, and the rules of a label array."""

import dataclasses

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from partwise.errors import LabelError
from partwise.labels.checks import checked_labels
from partwise.labels.encoding import decode_labels, encode_labels, labels_sha256
from partwise.labels.schema import Part, PartSchema

_SCHEMA = PartSchema(1, (Part(1, "seat", "#E69F00"), Part(3, "back", "#56B4E9")))
_LABELS = np.array([0, 1, 3, 3], np.uint16)


@settings(max_examples=40, deadline=None)
@given(arrays(np.uint16, st.integers(0, 300)))
def test_labels_come_back(labels: np.ndarray) -> None:
    decoded = decode_labels(encode_labels(labels))
    assert decoded.dtype == np.uint16
    np.testing.assert_array_equal(decoded, labels)


def test_few_parts_take_little_room() -> None:
    assert len(encode_labels(np.repeat(np.arange(4, dtype=np.uint16), 2_500)).blob) < 200


def test_checksum_is_of_the_values_not_their_layout() -> None:
    strided = np.repeat(_LABELS, 2)[::2]
    assert labels_sha256(strided) == labels_sha256(_LABELS) == encode_labels(strided).sha256


def test_damaged_bytes_are_refused() -> None:
    encoded = encode_labels(_LABELS)
    for blob in (b"", b"junk", encoded.blob[:-1]):
        with pytest.raises(LabelError, match="restore"):
            decode_labels(dataclasses.replace(encoded, blob=blob))


def test_another_face_count_is_refused() -> None:
    with pytest.raises(LabelError, match="5 labels but holds 4"):
        decode_labels(dataclasses.replace(encode_labels(_LABELS), n_faces=5))


def test_another_checksum_is_refused() -> None:
    with pytest.raises(LabelError, match="checksum 000000000000"):
        decode_labels(dataclasses.replace(encode_labels(_LABELS), sha256="0" * 64))


def test_good_labels_become_uint16() -> None:
    checked = checked_labels(_LABELS.astype(np.int64), 4, _SCHEMA)
    assert checked.dtype == np.uint16
    np.testing.assert_array_equal(checked, _LABELS)


def test_checked_labels_are_a_copy() -> None:
    labels = _LABELS.copy()
    checked = checked_labels(labels, 4, _SCHEMA)
    labels[:] = 1
    np.testing.assert_array_equal(checked, _LABELS)


@pytest.mark.parametrize("labels", [np.zeros(4), np.zeros((4, 1), np.int64), np.array(["seat"] * 4)])
def test_what_is_not_one_number_per_face_is_refused(labels: np.ndarray) -> None:
    with pytest.raises(LabelError, match="one whole number per face"):
        checked_labels(labels, 4, _SCHEMA)


def test_another_number_of_labels_is_refused() -> None:
    with pytest.raises(LabelError, match="4 labels for 5 faces"):
        checked_labels(_LABELS, 5, _SCHEMA)


@pytest.mark.parametrize("part_id", [2, -1, 65_536 + 1])
def test_an_id_outside_the_schema_is_refused(part_id: int) -> None:
    labels = _LABELS.astype(np.int64)
    labels[2] = part_id
    with pytest.raises(LabelError, match=f"face 2 has part id {part_id}"):
        checked_labels(labels, 4, _SCHEMA)
