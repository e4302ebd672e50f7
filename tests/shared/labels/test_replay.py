"""Replay is live editing; undo takes back exactly what was done; what is refused changes nothing."""

from collections.abc import Callable

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from partwise.errors import LabelError, ParameterError
from partwise.labels.editor import Editor
from partwise.labels.label_delta import LabelDelta
from partwise.labels.operations import Assign, Clear, Delta, DeltaSource, Operation, Paint, Redo, SegmentWide, Undo
from partwise.labels.replay import UNDO_LIMIT, Replay, replay
from partwise.labels.schema import Part, PartSchema
from partwise.labels.stroke_json import log_from_json, log_to_json
from partwise.labels.strokes import Stroke, StrokeLog
from partwise.mesh import TriMesh
from partwise.segmentation.paint import Brush, PaintSurface
from partwise.testing.meshes import meshes

Operations = Callable[[np.ndarray], st.SearchStrategy[Operation]]
Perform = Callable[[Editor, Operation], None]

_SCHEMA = PartSchema(1, (Part(1, "seat", "#E69F00"), Part(2, "back", "#56B4E9"), Part(3, "leg", "#009E73")))
_STRIP = TriMesh(
    np.array([[k // 2, k % 2, 0] for k in range(8)], dtype=np.float64), np.array([[k, k + 1, k + 2] for k in range(6)])
)
_BLANK = np.zeros(6, np.uint16)
_EDIT = Assign(((1, 2),), 2)


def _strip(labels: np.ndarray = _BLANK) -> Replay:
    return Replay(PaintSurface.build(_STRIP), labels, _SCHEMA.ids)


def _drawn_base(mesh: TriMesh, data: st.DataObject) -> np.ndarray:
    drawn = data.draw(st.lists(st.integers(0, 3), min_size=mesh.n_faces, max_size=mesh.n_faces))
    return np.array(drawn, np.uint16)


def _edited(
    mesh: TriMesh, data: st.DataObject, operations: Operations, perform: Perform
) -> tuple[Editor, list[np.ndarray]]:
    """An editor after drawn operations, and its labels before and after every stroke that it kept."""
    editor = Editor(mesh, _drawn_base(mesh, data), _SCHEMA)
    seen = [editor.labels.copy()]
    for _ in range(data.draw(st.integers(0, 8))):
        operation = data.draw(operations(editor.labels))
        perform(editor, operation)
        if len(editor.log().strokes) == len(seen):
            seen.append(editor.labels.copy())
    return editor, seen


@settings(max_examples=60, deadline=None)
@given(mesh=meshes(), data=st.data())
def test_replay_is_live(mesh: TriMesh, data: st.DataObject, operations: Operations, perform: Perform) -> None:
    editor, seen = _edited(mesh, data, operations, perform)
    log = log_from_json(log_to_json(editor.log()))
    assert log == editor.log()
    np.testing.assert_array_equal(replay(mesh, seen[0], log), editor.labels)


@settings(max_examples=30, deadline=None)
@given(mesh=meshes(), data=st.data())
def test_every_prefix_replays(mesh: TriMesh, data: st.DataObject, operations: Operations, perform: Perform) -> None:
    editor, seen = _edited(mesh, data, operations, perform)
    for n_strokes, labels in enumerate(seen):
        np.testing.assert_array_equal(replay(mesh, seen[0], editor.log().prefix(n_strokes)), labels)


@settings(max_examples=30, deadline=None)
@given(mesh=meshes(), data=st.data())
def test_an_editor_resumes_where_it_was(
    mesh: TriMesh, data: st.DataObject, operations: Operations, perform: Perform
) -> None:
    editor, seen = _edited(mesh, data, operations, perform)
    resumed = Editor.resumed(mesh, seen[0], _SCHEMA, editor.log())
    assert resumed.log() == editor.log()
    assert (resumed.can_undo, resumed.can_redo) == (editor.can_undo, editor.can_redo)
    while editor.can_undo:
        perform(editor, Undo())
        perform(resumed, Undo())
        np.testing.assert_array_equal(resumed.labels, editor.labels)


@settings(max_examples=40, deadline=None)
@given(mesh=meshes(), data=st.data())
def test_undo_takes_back_and_redo_does_again(mesh: TriMesh, data: st.DataObject, operations: Operations) -> None:
    state = Replay(PaintSurface.build(mesh), _drawn_base(mesh, data))
    stack = [state.labels.copy()]
    for _ in range(data.draw(st.integers(1, 6))):
        operation = data.draw(operations(state.labels).filter(lambda drawn: not isinstance(drawn, Undo | Redo)))
        if not state.apply(operation).is_empty:
            stack.append(state.labels.copy())
    for labels in stack[-2::-1]:
        state.apply(Undo())
        np.testing.assert_array_equal(state.labels, labels)
    assert not state.can_undo
    for labels in stack[1:]:
        state.apply(Redo())
        np.testing.assert_array_equal(state.labels, labels)
    assert not state.can_redo


@settings(max_examples=30, deadline=None)
@given(mesh=meshes(), data=st.data())
def test_a_change_says_exactly_what_changed(mesh: TriMesh, data: st.DataObject, operations: Operations) -> None:
    state = Replay(PaintSurface.build(mesh), _drawn_base(mesh, data))
    for _ in range(4):
        before = state.labels.copy()
        change = state.apply(data.draw(operations(state.labels)))
        np.testing.assert_array_equal(change.faces, np.flatnonzero(before != state.labels))
        np.testing.assert_array_equal(change.before, before[change.faces])
        np.testing.assert_array_equal(change.after, state.labels[change.faces])


@pytest.mark.parametrize(
    ("operation", "expected"),
    [
        (Paint((0,), Brush(0.01), 3), [3, 1, 1, 2, 2, 0]),
        (Paint((1,), Brush(1.0), 3, only_over=1), [3, 3, 3, 2, 2, 0]),
        (Paint((0, 5), Brush(0.01), 3), [3, 1, 1, 2, 2, 3]),
        (Assign(((2, 2), (5, 1)), 3), [1, 1, 3, 3, 2, 3]),
        (SegmentWide(1, 3), [3, 3, 3, 2, 2, 0]),
        (SegmentWide(3, 0), [1, 1, 1, 0, 0, 0]),
        (Clear(), [0, 0, 0, 0, 0, 0]),
    ],
)
def test_each_kind_does_its_part(operation: Operation, expected: list[int]) -> None:
    state = _strip(np.array([1, 1, 1, 2, 2, 0], np.uint16))
    state.apply(operation)
    assert state.labels.tolist() == expected


def test_a_new_step_leaves_nothing_to_redo() -> None:
    state = _strip()
    for operation in (_EDIT, Undo(), SegmentWide(0, 1)):
        state.apply(operation)
    assert not state.can_redo
    assert state.apply(Redo()).is_empty
    assert state.labels.tolist() == [1] * 6


@pytest.mark.parametrize("operation", [Undo(), Redo()])
def test_without_a_step_undo_and_redo_change_nothing(operation: Operation) -> None:
    state = _strip(np.array([1, 1, 1, 2, 2, 0], np.uint16))
    assert state.apply(operation).is_empty
    assert state.labels.tolist() == [1, 1, 1, 2, 2, 0]
    assert (state.can_undo, state.can_redo) == (False, False)


def test_an_edit_without_effect_is_no_step() -> None:
    state = _strip()
    for operation in (_EDIT, Assign(((0, 2),), 2), Undo()):
        state.apply(operation)
    assert state.apply(Assign(((0, 1),), 0)).is_empty
    assert state.can_redo
    assert state.can_undo
    state.apply(Undo())
    np.testing.assert_array_equal(state.labels, _BLANK)
    assert not state.can_undo


def test_undo_goes_back_so_far_and_no_further() -> None:
    state = _strip()
    for step in range(UNDO_LIMIT + 5):
        state.apply(SegmentWide(0, 1 + step % 2))
    for _ in range(UNDO_LIMIT):
        state.apply(Undo())
    assert not state.can_undo
    assert state.apply(Undo()).is_empty
    assert state.labels.tolist() == [1] * 6  # after the fifth step


@pytest.mark.parametrize(
    ("operation", "error", "message"),
    [
        (Paint((0, 6), Brush(0.5), 1), ParameterError, "a face must be 0 to 5 but is 6"),
        (Assign(((2, 4), (9, 2)), 1), ParameterError, "a face must be 0 to 5 but is 10"),
        (Assign(((2, 2**40),), 1), ParameterError, "a face must be 0 to 5"),
        (SegmentWide(6, 1), ParameterError, "a face must be 0 to 5 but is 6"),
        (Paint((0,), Brush(0.5), 4), LabelError, "its parts are 1, 2, 3"),
        (Assign(((0, 1),), 9), LabelError, "part of the schema but is 9"),
        (SegmentWide(0, 9), LabelError, "part of the schema but is 9"),
        (
            Delta(
                DeltaSource.PATCHES,
                LabelDelta.between(np.array([0, 2, 2, 0, 0, 0], np.uint16), np.full(6, 9, np.uint16)),
            ),
            LabelError,
            "part of the schema but is 9",
        ),
        (
            Delta(DeltaSource.PATCHES, LabelDelta.between(_BLANK, np.array([0, 0, 0, 0, 0, 1], np.uint16))),
            LabelError,
            "made for other labels",
        ),
    ],
)
def test_what_is_refused_changes_nothing(operation: Operation, error: type[Exception], message: str) -> None:
    state = _strip()
    state.apply(_EDIT)
    before = state.labels.copy()
    with pytest.raises(error, match=message):
        state.apply(operation)
    np.testing.assert_array_equal(state.labels, before)
    state.apply(Undo())
    np.testing.assert_array_equal(state.labels, _BLANK)


def test_an_empty_schema_is_named_so() -> None:
    with pytest.raises(LabelError, match="its parts are none"):
        Replay(PaintSurface.build(_STRIP), _BLANK, ()).apply(SegmentWide(0, 1))


def test_labels_are_a_view_that_cannot_be_written() -> None:
    state = _strip()
    with pytest.raises(ValueError, match="read-only"):
        state.labels[0] = 1


def test_base_labels_stay_as_they_are() -> None:
    base = _BLANK.copy()
    _strip(base).apply(_EDIT)
    np.testing.assert_array_equal(base, _BLANK)


def test_base_labels_of_another_mesh_are_refused() -> None:
    with pytest.raises(LabelError, match="labels for 6 faces"):
        _strip(np.zeros(5, np.uint16))


def test_base_labels_that_are_no_whole_numbers_are_refused() -> None:
    with pytest.raises(LabelError, match="must be whole numbers but are float64"):
        _strip(np.zeros(6))


def test_undo_cannot_be_spoilt_through_a_change() -> None:
    with pytest.raises(ValueError, match="read-only"):
        _strip().apply(_EDIT).before[0] = 9


def test_undo_brings_back_a_part_that_may_no_longer_be_given() -> None:
    state = _strip()
    state.apply(SegmentWide(0, 3))
    state.restrict_to([1])
    for operation in (SegmentWide(0, 1), Undo()):
        state.apply(operation)
    assert state.labels.tolist() == [3] * 6
    with pytest.raises(LabelError, match="its parts are 1 "):
        state.apply(Assign(((0, 1),), 3))


@pytest.mark.parametrize("label", [-1, 65_536])
def test_base_labels_that_are_no_part_ids_are_refused(label: int) -> None:
    with pytest.raises(LabelError, match="must be 0 to 65535"):
        _strip(np.full(6, label))


def test_a_log_of_another_mesh_is_refused(make_stroke: Callable[..., Stroke]) -> None:
    log = StrokeLog.starting_from(_STRIP.content_hash(), _BLANK).with_stroke(make_stroke(0, _EDIT))
    moved = TriMesh(_STRIP.vertices + 1, _STRIP.faces)
    with pytest.raises(LabelError, match="on its own mesh"):
        replay(moved, _BLANK, log)


def test_a_log_from_other_labels_is_refused() -> None:
    log = StrokeLog.starting_from(_STRIP.content_hash(), _BLANK, base_revision=12)
    with pytest.raises(LabelError, match="fetch revision 12"):
        replay(_STRIP, np.ones(6, np.uint16), log)


def test_a_log_that_cannot_be_replayed_names_the_stroke(make_stroke: Callable[..., Stroke]) -> None:
    log = StrokeLog.starting_from(_STRIP.content_hash(), _BLANK)
    log = log.with_stroke(make_stroke(0, Clear())).with_stroke(make_stroke(1, SegmentWide(6, 1)))
    with pytest.raises(LabelError, match="stroke 1 of the log cannot be replayed"):
        replay(_STRIP, _BLANK, log)
