"""A log becomes the labels of a revision, or is refused."""

from collections.abc import Callable

import numpy as np
import pytest

from partwise.errors import ConflictError, LabelError
from partwise.labels.encoding import labels_sha256
from partwise.labels.fold import fold
from partwise.labels.operations import Assign, SegmentWide
from partwise.labels.schema import Part, PartSchema
from partwise.labels.strokes import Stroke, StrokeLog
from partwise.mesh import TriMesh

MakeStroke = Callable[..., Stroke]

_SCHEMA = PartSchema(5, (Part(1, "seat", "#E69F00"), Part(2, "back", "#56B4E9")))
_SQUARE = TriMesh(np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]]), np.array([[0, 1, 2], [0, 2, 3]]))
_BASE = np.array([0, 1], np.uint16)


@pytest.fixture
def log(make_stroke: MakeStroke) -> StrokeLog:
    log = StrokeLog.starting_from(_SQUARE.content_hash(), _BASE, base_revision=8)
    return log.with_stroke(make_stroke(0, SegmentWide(0, 9), 8)).with_stroke(make_stroke(1, Assign(((0, 1),), 2), 8))


def test_folding_gives_labels_and_what_a_revision_names(log: StrokeLog) -> None:
    folded = fold(log, _SQUARE, _BASE, _SCHEMA)
    assert folded.labels.tolist() == [2, 1]
    assert folded.labels.dtype == np.uint16
    assert folded.sha256 == labels_sha256(np.array([2, 1], np.uint16))
    assert (folded.mesh_hash, folded.parent_revision) == (_SQUARE.content_hash(), 8)
    assert (folded.schema_version, folded.n_strokes) == (5, 2)


def test_an_empty_log_folds_to_its_base() -> None:
    log = StrokeLog.starting_from(_SQUARE.content_hash(), _BASE)
    np.testing.assert_array_equal(fold(log, _SQUARE, _BASE, _SCHEMA).labels, _BASE)


def test_a_part_that_is_left_on_a_face_must_be_in_the_schema(log: StrokeLog) -> None:
    with pytest.raises(LabelError, match="face 0 has part id 9, which is not in schema version 5"):
        fold(log.prefix(1), _SQUARE, _BASE, _SCHEMA)


def test_a_log_of_another_mesh_is_refused(log: StrokeLog) -> None:
    with pytest.raises(LabelError, match="on its own mesh"):
        fold(log, TriMesh(_SQUARE.vertices * 2, _SQUARE.faces), _BASE, _SCHEMA)


def test_labels_the_annotator_saw_are_accepted(log: StrokeLog) -> None:
    seen = labels_sha256(np.array([2, 1], np.uint16))
    assert fold(log, _SQUARE, _BASE, _SCHEMA, expected_sha256=seen).sha256 == seen


def test_other_labels_than_the_annotator_saw_are_refused(log: StrokeLog) -> None:
    with pytest.raises(ConflictError, match="as the annotator saw them"):
        fold(log, _SQUARE, _BASE, _SCHEMA, expected_sha256="0" * 64)
