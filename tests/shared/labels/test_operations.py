"""What may be an operation."""

import math
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from partwise.errors import LabelError, ParameterError
from partwise.labels.label_delta import LabelDelta
from partwise.labels.operations import (
    Assign,
    Clear,
    Delta,
    DeltaSource,
    Operation,
    Paint,
    Redo,
    SegmentWide,
    Undo,
    check_on_mesh,
)
from partwise.segmentation.paint import Brush

_BRUSH = Brush(0.1)
_DELTA = LabelDelta.between(np.zeros(3, np.uint16), np.ones(3, np.uint16))


@given(st.lists(st.integers(0, 60), min_size=1))
def test_assign_names_the_faces_given(faces: list[int]) -> None:
    assign = Assign.to_faces(faces, 1)
    assert assign.faces().tolist() == sorted(set(faces))
    assert assign.n_faces == len(set(faces))
    assert assign.end == max(faces) + 1


def test_consecutive_faces_are_one_run() -> None:
    assert Assign.to_faces([7, 3, 4, 5], 1).runs == ((3, 3), (7, 1))


@pytest.mark.parametrize("label", [-1, 65_536])
@pytest.mark.parametrize(
    "make",
    [
        lambda label: Paint((0,), _BRUSH, label),
        lambda label: Paint((0,), _BRUSH, 1, only_over=label),
        lambda label: Assign(((0, 1),), label),
        lambda label: SegmentWide(0, label),
    ],
)
def test_a_label_that_is_no_part_id_is_refused(make: Any, label: int) -> None:
    with pytest.raises(LabelError, match=f"must be a part id, 1 to 65535, or 0 for unlabelled but is {label}"):
        make(label)


@pytest.mark.parametrize(
    "make", [lambda: Paint((3, -1), _BRUSH, 1), lambda: Assign(((-1, 2),), 1), lambda: SegmentWide(-1, 1)]
)
def test_a_negative_face_is_refused(make: Any) -> None:
    with pytest.raises(ParameterError, match="a face must be 0 or more but is -1"):
        make()


def test_paint_without_seeds_is_refused() -> None:
    with pytest.raises(ParameterError, match="at least one seed"):
        Paint((), _BRUSH, 1)


@pytest.mark.parametrize("make", [lambda: Assign((), 1), lambda: Assign.to_faces([], 1)])
def test_assign_without_faces_is_refused(make: Any) -> None:
    with pytest.raises(ParameterError, match="at least one face"):
        make()


@pytest.mark.parametrize("runs", [((0, 0),), ((0, 2), (1, 2)), ((5, 1), (2, 1)), ((4, -3),)])
def test_runs_that_are_empty_overlap_or_descend_are_refused(runs: tuple[tuple[int, int], ...]) -> None:
    with pytest.raises(ParameterError, match="must ascend and hold at least one face"):
        Assign(runs, 1)


def test_parameters_of_a_delta_are_sorted_by_name() -> None:
    delta = Delta.of(DeltaSource.BOUNDARY_REFINEMENT, _DELTA, {"omega": 0.2, "again": True})
    assert delta.parameters == (("again", True), ("omega", 0.2))


@pytest.mark.parametrize("parameters", [(("b", 1), ("a", 1)), (("a", 1), ("a", 2))])
def test_parameters_out_of_order_or_twice_are_refused(parameters: tuple[tuple[str, int], ...]) -> None:
    with pytest.raises(ParameterError, match="sorted by name"):
        Delta(DeltaSource.PATCHES, _DELTA, parameters)


@pytest.mark.parametrize("value", [math.nan, math.inf, [1], {}])
def test_parameters_that_json_cannot_hold_are_refused(value: Any) -> None:
    with pytest.raises(ParameterError, match="parameter omega must be"):
        Delta.of(DeltaSource.PATCHES, _DELTA, {"omega": value})


def test_operations_compare_by_value() -> None:
    pairs: list[tuple[Operation, Operation]] = [
        (Paint((1,), Brush(0.1), 2), Paint((1,), Brush(0.1), 2)),
        (Assign.to_faces([1, 2], 2), Assign.to_faces([2, 1], 2)),
    ]
    for one, other in pairs:
        assert one == other
        assert hash(one) == hash(other)


_ON_THREE_FACES = [
    Paint((2, 0), _BRUSH, 1),
    Assign(((0, 1), (2, 1)), 1),
    SegmentWide(2, 1),
    Delta(DeltaSource.PATCHES, _DELTA),
    Clear(),
    Undo(),
    Redo(),
]


@pytest.mark.parametrize("operation", _ON_THREE_FACES)
def test_faces_of_the_mesh_may_be_named(operation: Operation) -> None:
    check_on_mesh(operation, 3)


@pytest.mark.parametrize("operation", _ON_THREE_FACES[:3])
def test_a_face_outside_the_mesh_is_refused(operation: Operation) -> None:
    with pytest.raises(ParameterError, match="a face must be 0 to 1 but is 2"):
        check_on_mesh(operation, 2)


def test_a_delta_of_another_mesh_is_refused() -> None:
    with pytest.raises(LabelError, match="for 3 faces must not be applied to 2"):
        check_on_mesh(Delta(DeltaSource.PATCHES, _DELTA), 2)


def test_a_damaged_delta_is_refused() -> None:
    damaged = Delta(DeltaSource.PATCHES, LabelDelta(3, 1, "AAAA", _DELTA.sha256))
    with pytest.raises(LabelError, match="fetch it again"):
        check_on_mesh(damaged, 3)
