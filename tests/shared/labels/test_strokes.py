"""Strokes and logs: places, ids, times; and the editor that keeps a log."""

import dataclasses
from collections.abc import Callable
from datetime import UTC, datetime, timedelta, timezone
from typing import Any
from uuid import UUID

import numpy as np
import pytest

from partwise.errors import ConflictError, LabelError, ParameterError
from partwise.labels.editor import Editor
from partwise.labels.operations import Assign, Clear, SegmentWide, Undo
from partwise.labels.schema import Part, PartSchema
from partwise.labels.strokes import Stroke, StrokeLog
from partwise.mesh import TriMesh

MakeStroke = Callable[..., Stroke]

_BLANK = np.zeros(2, np.uint16)
_LOG = StrokeLog.starting_from("0" * 64, _BLANK)
_SQUARE = TriMesh(np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]]), np.array([[0, 1, 2], [0, 2, 3]]))
_SCHEMA = PartSchema(1, (Part(1, "seat", "#E69F00"),))
_WHO: dict[str, Any] = {"author_id": 7, "at": datetime(2026, 3, 1, tzinfo=UTC)}


@pytest.mark.parametrize(
    ("changed", "message"),
    [
        ({"sequence": -1}, "sequence must be 0 to 2147483646"),
        ({"sequence": 2**31 - 1}, "sequence must be 0 to 2147483646"),
        ({"author_id": 0}, "author must be a person's id"),
        ({"author_id": 2**31}, "author must be a person's id"),
        ({"base_revision": 0}, "base revision must be 1 to 2147483647"),
        ({"base_revision": 10**30}, "base revision must be 1 to 2147483647"),
        ({"at": datetime(2026, 3, 1)}, "time must be in UTC"),
        ({"at": datetime(2026, 3, 1, tzinfo=timezone(timedelta(hours=1)))}, "time must be in UTC"),
    ],
)
def test_a_stroke_out_of_range_is_refused(changed: dict[str, Any], message: str, make_stroke: MakeStroke) -> None:
    with pytest.raises(ParameterError, match=message):
        dataclasses.replace(make_stroke(0, Clear()), **changed)


def test_strokes_follow_on_each_other(make_stroke: MakeStroke) -> None:
    log = _LOG.with_stroke(make_stroke(0, Clear())).with_stroke(make_stroke(1, Undo()))
    assert [stroke.sequence for stroke in log.strokes] == [0, 1]
    assert log.prefix(1) == _LOG.with_stroke(make_stroke(0, Clear()))


def test_a_stroke_sent_twice_is_added_once(make_stroke: MakeStroke) -> None:
    log = _LOG.with_stroke(make_stroke(0, Clear())).with_stroke(make_stroke(1, Undo()))
    assert log.with_stroke(make_stroke(0, Clear())) is log


def test_an_id_used_for_another_stroke_is_refused(make_stroke: MakeStroke) -> None:
    log = _LOG.with_stroke(make_stroke(0, Clear()))
    with pytest.raises(ConflictError, match="in the log with other content"):
        log.with_stroke(make_stroke(0, Undo()))


@pytest.mark.parametrize("sequence", [0, 2])
def test_a_stroke_for_another_state_of_the_log_is_refused(sequence: int, make_stroke: MakeStroke) -> None:
    log = _LOG.with_stroke(make_stroke(0, Clear()))
    stale = dataclasses.replace(make_stroke(sequence, Undo()), id=UUID(int=99))
    with pytest.raises(ConflictError, match=f"must have sequence 1 but has {sequence}"):
        log.with_stroke(stale)


def test_a_stroke_on_another_revision_is_refused(make_stroke: MakeStroke) -> None:
    with pytest.raises(ConflictError, match="based on revision None but is on 3"):
        _LOG.with_stroke(make_stroke(0, Clear(), base_revision=3))


def test_a_log_in_which_an_id_occurs_twice_is_refused(make_stroke: MakeStroke) -> None:
    strokes = (make_stroke(0, Clear()), dataclasses.replace(make_stroke(1, Clear()), id=make_stroke(0, Clear()).id))
    with pytest.raises(ConflictError, match="id of its own"):
        dataclasses.replace(_LOG, strokes=strokes)


def test_a_log_of_no_faces_is_refused() -> None:
    with pytest.raises(LabelError, match="a mesh with faces"):
        StrokeLog.starting_from("0" * 64, _BLANK[:0])


def test_an_editor_keeps_what_had_effect() -> None:
    editor = Editor(_SQUARE, _BLANK, _SCHEMA, base_revision=4)
    editor.perform(SegmentWide(0, 1), stroke_id=UUID(int=1), **_WHO)
    assert editor.perform(Assign(((0, 1),), 1), stroke_id=UUID(int=2), **_WHO).is_empty
    editor.perform(Undo(), stroke_id=UUID(int=3), **_WHO)
    log = editor.log()
    assert [(stroke.sequence, stroke.id.int, stroke.base_revision) for stroke in log.strokes] == [(0, 1, 4), (1, 3, 4)]
    assert (log.mesh_hash, log.n_faces, log.base_revision) == (_SQUARE.content_hash(), 2, 4)
    assert editor.can_redo
    assert not editor.can_undo


def test_an_editor_that_refuses_keeps_labels_and_log() -> None:
    editor = Editor(_SQUARE, _BLANK, _SCHEMA)
    editor.perform(SegmentWide(0, 1), stroke_id=UUID(int=1), **_WHO)
    refused: list[tuple[Any, dict[str, Any], type[Exception]]] = [
        (SegmentWide(0, 2), {"stroke_id": UUID(int=2)}, LabelError),
        (SegmentWide(2, 1), {"stroke_id": UUID(int=2)}, ParameterError),
        (Clear(), {"stroke_id": UUID(int=1)}, ConflictError),
        (Clear(), {"stroke_id": UUID(int=2), "author_id": 0}, ParameterError),
        (Clear(), {"stroke_id": UUID(int=2), "at": datetime(2026, 3, 1)}, ParameterError),
    ]
    for operation, named, error in refused:
        with pytest.raises(error):
            editor.perform(operation, **{**_WHO, **named})
        assert editor.labels.tolist() == [1, 1]
        assert len(editor.log().strokes) == 1
