"""Strategies for operations on a mesh, shared by the tests of replay and of the codec."""

from collections.abc import Callable
from datetime import UTC, datetime, timedelta
from uuid import UUID

import numpy as np
import pytest
from hypothesis import strategies as st

from partwise.labels.editor import Editor
from partwise.labels.label_delta import LabelDelta
from partwise.labels.operations import Assign, Clear, Delta, DeltaSource, Operation, Paint, Redo, SegmentWide, Undo
from partwise.labels.strokes import Stroke
from partwise.segmentation.paint import Brush

_START = datetime(2026, 3, 1, 9, 30, tzinfo=UTC)
_LABELS = st.integers(0, 3)


def _operations(labels: np.ndarray) -> st.SearchStrategy[Operation]:
    """Any operation on a shape that is now labelled so; parts 1 to 3."""
    n_faces = len(labels)
    face = st.integers(0, n_faces - 1)
    brush = st.builds(Brush, st.floats(0.01, 1.0), st.none() | st.floats(-1.0, 1.0))
    paint = st.builds(Paint, st.lists(face, min_size=1, max_size=3).map(tuple), brush, _LABELS, st.none() | _LABELS)
    assign = st.builds(Assign.to_faces, st.lists(face, min_size=1, max_size=5), _LABELS)
    text = st.text(st.characters(exclude_characters="\0", exclude_categories=["Cs"]), max_size=4)
    parameters = st.dictionaries(text, st.none() | st.booleans() | st.floats(-9, 9) | text)

    def delta(source: DeltaSource, after: list[int], named: dict[str, float]) -> Operation:
        return Delta.of(source, LabelDelta.between(labels, np.array(after, np.uint16)), named)

    after = st.lists(_LABELS, min_size=n_faces, max_size=n_faces)
    deltas = st.builds(delta, st.sampled_from(DeltaSource), after, parameters)
    steps = st.sampled_from((Undo(), Undo(), Redo(), Clear()))
    return st.one_of(paint, assign, st.builds(SegmentWide, face, _LABELS), deltas, steps)


def _stroke(sequence: int, operation: Operation, base_revision: int | None = None) -> Stroke:
    at = _START + timedelta(seconds=2.5 * sequence, microseconds=sequence)
    return Stroke(UUID(int=sequence + 1), sequence, base_revision, 7, at, operation)


def _perform(editor: Editor, operation: Operation) -> None:
    """As the next stroke of this editor."""
    stroke = _stroke(len(editor.log().strokes), operation)
    editor.perform(operation, stroke_id=stroke.id, author_id=stroke.author_id, at=stroke.at)


@pytest.fixture(scope="session")
def operations() -> Callable[[np.ndarray], st.SearchStrategy[Operation]]:
    return _operations


@pytest.fixture(scope="session")
def make_stroke() -> Callable[..., Stroke]:
    return _stroke


@pytest.fixture(scope="session")
def perform() -> Callable[[Editor, Operation], None]:
    return _perform
