"""Deltas: exact, small, and never applied to what they were not made for."""

import base64
import dataclasses
import zlib

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from partwise.errors import LabelError
from partwise.labels.label_delta import LabelDelta

_BEFORE = np.array([0, 0, 1, 1, 2], np.uint16)
_AFTER = np.array([0, 3, 3, 4, 2], np.uint16)
_DELTA = LabelDelta.between(_BEFORE, _AFTER)


def _payload(*columns: tuple[list[int], str]) -> str:
    raw = b"".join(np.array(values, dtype=dtype).tobytes() for values, dtype in columns)
    return base64.b64encode(zlib.compress(raw)).decode()


@settings(max_examples=60, deadline=None)
@given(st.data())
def test_a_delta_turns_before_into_after(data: st.DataObject) -> None:
    n_faces = data.draw(st.integers(1, 60))
    labels = arrays(np.uint16, n_faces, elements=st.integers(0, 3) | st.integers(0, 65_535))
    before, after = data.draw(labels), data.draw(labels)
    kept = before.copy()
    np.testing.assert_array_equal(LabelDelta.between(before, after).applied_to(before), after)
    np.testing.assert_array_equal(before, kept)


def test_neighbours_of_one_new_label_are_one_run() -> None:
    assert _DELTA.n_runs == 2
    assert LabelDelta.between(_BEFORE, _BEFORE).n_runs == 0


def test_the_layout_is_as_documented() -> None:
    raw = zlib.decompress(base64.b64decode(_DELTA.payload))
    assert raw == np.array([1, 3, 2, 1], "<u4").tobytes() + np.array([3, 4], "<u2").tobytes()


def test_a_refinement_of_many_faces_takes_little_room() -> None:
    after = np.repeat(np.arange(5, dtype=np.uint16), 10_000)
    assert len(LabelDelta.between(np.zeros_like(after), after).payload) < 200


def test_labels_of_two_meshes_have_no_delta() -> None:
    with pytest.raises(LabelError, match="of one mesh"):
        LabelDelta.between(_BEFORE, _AFTER[:4])


def test_labels_of_another_mesh_are_refused() -> None:
    with pytest.raises(LabelError, match="for 5 faces must not be applied to 4"):
        _DELTA.applied_to(_BEFORE[:4])


def test_labels_it_was_not_made_for_are_refused() -> None:
    other = _BEFORE.copy()
    other[4] = 1
    with pytest.raises(LabelError, match="made for other labels"):
        _DELTA.applied_to(other)


@pytest.mark.parametrize("payload", ["!", "é", "AAAA", _DELTA.payload[:8], _DELTA.payload[:-4]])
def test_a_payload_that_is_no_zlib_stream_is_refused(payload: str) -> None:
    with pytest.raises(LabelError, match="fetch it again"):
        dataclasses.replace(_DELTA, payload=payload).applied_to(_BEFORE)


@pytest.mark.parametrize(
    "payload",
    [
        _payload(([1, 3], "<u4"), ([2, 1], "<u4")),
        _payload(([1, 3], "<u4"), ([2, 1], "<u4"), ([3, 4, 4], "<u2")),
        base64.b64encode(zlib.compress(bytes(10_000_000))).decode(),
    ],
)
def test_a_payload_of_another_length_is_refused(payload: str) -> None:
    with pytest.raises(LabelError, match="must hold 2 runs"):
        dataclasses.replace(_DELTA, payload=payload).applied_to(_BEFORE)


@pytest.mark.parametrize(
    ("first", "count"),
    [([3, 1], [1, 2]), ([1, 2], [2, 1]), ([1, 3], [2, 0]), ([1, 3], [2, 3]), ([1, 2**32 - 1], [2, 1])],
)
def test_runs_that_do_not_ascend_within_the_mesh_are_refused(first: list[int], count: list[int]) -> None:
    payload = _payload((first, "<u4"), (count, "<u4"), ([3, 4], "<u2"))
    with pytest.raises(LabelError, match="runs must ascend within 5 faces"):
        dataclasses.replace(_DELTA, payload=payload).applied_to(_BEFORE)


@pytest.mark.parametrize(("n_faces", "n_runs"), [(0, 0), (2**32, 0), (5, -1), (5, 6)])
def test_counts_out_of_range_are_refused(n_faces: int, n_runs: int) -> None:
    with pytest.raises(LabelError, match="0 to n_faces runs"):
        dataclasses.replace(_DELTA, n_faces=n_faces, n_runs=n_runs)


@pytest.mark.parametrize("sha256", ["", "0" * 63, "G" * 64])
def test_a_checksum_that_is_none_is_refused(sha256: str) -> None:
    with pytest.raises(LabelError, match="64 hex digits"):
        dataclasses.replace(_DELTA, sha256=sha256)
