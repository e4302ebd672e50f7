"""Strokes as JSON: exact round trip, older versions, and everything that is refused."""

import json
import random
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from partwise.errors import ConflictError, FileFormatError, LabelError, ParameterError
from partwise.labels.label_delta import LabelDelta
from partwise.labels.operations import Assign, Clear, Delta, DeltaSource, Operation, Paint, SegmentWide
from partwise.labels.replay import replay
from partwise.labels.stroke_json import log_from_json, log_to_json, stroke_from_document, stroke_to_document
from partwise.labels.stroke_versions import STROKE_VERSION, upgraded_stroke
from partwise.labels.strokes import Stroke, StrokeLog
from partwise.mesh import TriMesh
from partwise.segmentation.paint import Brush

MakeStroke = Callable[..., Stroke]

_GOLDEN = Path(__file__).parents[2] / "golden" / "strokes"
_BLANK = np.zeros(4, np.uint16)
_PAINT = Paint((2, 0), Brush(0.1, 0.5), 3)
_ASSIGN = Assign(((0, 2), (3, 1)), 3)
_DELTA = Delta.of(DeltaSource.START_FROM, LabelDelta.between(_BLANK, _BLANK + np.uint16(2)), {"model": 3})


def _golden(version: int) -> dict[str, Any]:
    return _read(_GOLDEN / f"v{version}.json")


def _read(path: Path) -> dict[str, Any]:
    document: dict[str, Any] = json.loads(path.read_text())
    return document


def _shuffled(value: Any, order: random.Random) -> Any:
    if isinstance(value, list):
        return [_shuffled(item, order) for item in value]
    if isinstance(value, dict):
        items = [(key, _shuffled(item, order)) for key, item in value.items()]
        order.shuffle(items)
        return dict(items)
    return value


def test_there_is_a_log_of_every_version() -> None:
    assert {f"v{version}" for version in range(STROKE_VERSION + 1)} <= {path.stem for path in _GOLDEN.glob("*.json")}


@pytest.mark.parametrize("path", sorted(_GOLDEN.glob("*.json")), ids=lambda path: path.stem)
def test_golden_logs_replay(path: Path) -> None:
    golden = _read(path)
    mesh = TriMesh(np.array(golden["vertices"]), np.array(golden["faces"]))
    log = log_from_json(json.dumps(golden["log"]))
    for n_strokes, labels in enumerate(golden["labels_after_each_stroke"], start=1):
        assert replay(mesh, np.zeros(mesh.n_faces, np.uint16), log.prefix(n_strokes)).tolist() == labels


def test_an_older_log_is_written_as_the_newest_version() -> None:
    log = log_from_json(json.dumps(_golden(0)["log"]))
    assert {
        json.loads(log_to_json(log))["v"],
        *(stroke["v"] for stroke in json.loads(log_to_json(log))["strokes"]),
    } == {1}
    assert log_from_json(log_to_json(log)) == log


def test_a_log_may_mix_versions() -> None:
    newest = json.loads(log_to_json(log_from_json(json.dumps(_golden(0)["log"]))))
    mixed = {**newest, "strokes": [*_golden(0)["log"]["strokes"][:2], *newest["strokes"][2:]]}
    assert log_from_json(json.dumps(mixed)) == log_from_json(json.dumps(newest))


def test_upgrading_leaves_the_stored_stroke_as_it_is() -> None:
    stroke = _golden(0)["log"]["strokes"][0]
    kept = json.dumps(stroke)
    assert upgraded_stroke(stroke)["v"] == STROKE_VERSION
    assert json.dumps(stroke) == kept


def test_the_documented_stroke_is_one() -> None:
    page = (Path(__file__).parents[3] / "docs" / "segmentation.md").read_text()
    block = page.partition('```json\n{"v": ')[2].partition("```")[0]
    stroke = stroke_from_document(json.loads('{"v": ' + block))
    assert stroke.operation == Paint((812, 840), Brush(0.05, 0.766), 3)


@settings(max_examples=80, deadline=None)
@given(data=st.data())
def test_strokes_come_back(
    data: st.DataObject, operations: Callable[[np.ndarray], st.SearchStrategy[Operation]], make_stroke: MakeStroke
) -> None:
    stroke = make_stroke(data.draw(st.integers(0, 9)), data.draw(operations(_BLANK)), data.draw(st.none() | st.just(5)))
    assert stroke_from_document(json.loads(json.dumps(stroke_to_document(stroke)))) == stroke


@settings(max_examples=20, deadline=None)
@given(st.integers(0, 2**32), st.integers(0, STROKE_VERSION))
def test_the_order_of_keys_means_nothing(seed: int, version: int) -> None:
    log = _golden(version)["log"]
    shuffled = json.dumps(_shuffled(log, random.Random(seed)))  # noqa: S311 # no secret
    assert log_to_json(log_from_json(shuffled)) == log_to_json(log_from_json(json.dumps(log)))


def test_a_stroke_is_one_flat_object(make_stroke: MakeStroke) -> None:
    assert stroke_to_document(make_stroke(1, _PAINT)) == {
        "v": 1,
        "kind": "paint",
        "seeds": [2, 0],
        "radius": 0.1,
        "min_cosine": 0.5,
        "label": 3,
        "only_over": None,
        "id": "00000000-0000-0000-0000-000000000002",
        "sequence": 1,
        "base_revision": None,
        "author_id": 7,
        "at": "2026-03-01T09:30:02.500001Z",
    }


@pytest.mark.parametrize(
    "operation",
    [
        Paint(tuple(np.array([2, 0])), Brush(np.float64(0.1), np.float64(0.5)), np.int64(3), np.uint16(1)),  # type: ignore[arg-type]
        Assign(((np.int64(0), np.int64(2)),), np.uint16(3)),  # type: ignore[arg-type]
        SegmentWide(np.int64(0), np.uint16(1)),  # type: ignore[arg-type]
    ],
)
def test_numbers_of_numpy_are_numbers(operation: Operation, make_stroke: MakeStroke) -> None:
    document = json.loads(json.dumps(stroke_to_document(make_stroke(0, operation))))
    assert stroke_from_document(document).operation == operation


def test_a_time_elsewhere_is_the_same_moment(make_stroke: MakeStroke) -> None:
    document = stroke_to_document(make_stroke(0, Clear()))
    assert stroke_from_document({**document, "at": "2026-03-01T11:30:00+02:00"}) == stroke_from_document(document)


def test_text_of_every_script_is_kept(make_stroke: MakeStroke) -> None:
    delta = Delta.of(_DELTA.source, _DELTA.delta, {"模型": "Ω 🪑"})
    assert stroke_from_document(stroke_to_document(make_stroke(0, delta))).operation == delta


def test_a_whole_number_is_a_good_radius(make_stroke: MakeStroke) -> None:
    read = stroke_from_document({**stroke_to_document(make_stroke(0, _PAINT)), "radius": 1})
    assert read.operation == Paint((2, 0), Brush(1.0, 0.5), 3)


@pytest.mark.parametrize(
    ("operation", "changed", "message"),
    [
        (Clear(), {"kind": "smear"}, "kind must be one of paint, assign, .* but is 'smear'"),
        (Clear(), {"v": 2}, "version 0 to 1 but has 2; upgrade"),
        (Clear(), {"v": -1}, "version 0 to 1 but has -1"),
        (Clear(), {"v": "1"}, "'v' of a stroke must be a whole number"),
        (Clear(), {"colour": 1, "angle": 2}, "unknown keys angle, colour"),
        (Clear(), {"id": "7"}, "id must be a UUID"),
        (Clear(), {"id": 7}, "'id' of a stroke must be text but is 7"),
        (Clear(), {"at": "yesterday"}, "time must be like"),
        (Clear(), {"at": "0001-01-01T00:00:00+23:00"}, "time must be like"),
        (Clear(), {"sequence": True}, "'sequence' of a stroke must be a whole number but is True"),
        (Clear(), {"sequence": 1.0}, "must be a whole number but is 1.0"),
        (Clear(), {"base_revision": "x" * 99}, "must be a whole number but is 'xxx.{53}…"),
        (_PAINT, {"radius": "wide"}, "must be a finite number but is 'wide'"),
        (_PAINT, {"radius": float("nan")}, "must be a finite number but is nan"),
        (_PAINT, {"radius": float("inf")}, "must be a finite number but is inf"),
        (_PAINT, {"radius": 10**400}, "must be a finite number"),
        (_PAINT, {"radius": True}, "must be a finite number"),
        (_PAINT, {"min_cosine": "1"}, "must be a finite number"),
        (_PAINT, {"seeds": 3}, "list of whole numbers"),
        (_PAINT, {"seeds": [1, 2.5]}, "list of whole numbers"),
        (_ASSIGN, {"runs": 3}, "list of pairs"),
        (_ASSIGN, {"runs": [[1, 2, 3]]}, "list of pairs"),
        (_ASSIGN, {"runs": [[1, "2"]]}, "list of pairs"),
        (_ASSIGN, {"runs": [7]}, "list of pairs"),
        (_DELTA, {"source": "magic"}, "source must be one of patches, .* but is 'magic'"),
        (_DELTA, {"parameters": []}, "must be an object"),
        (_DELTA, {"parameters": {"model": "\ud800"}}, "must be an object of text and numbers"),
        (_DELTA, {"parameters": {"\udfff": 1}}, "must be an object of text and numbers"),
        (_DELTA, {"parameters": {"model": "\0"}}, "must be an object of text and numbers"),
        (_DELTA, {"parameters": {"model": 2**53 + 1}}, "must be an object of text and numbers"),
        (_DELTA, {"payload": "\ud800"}, "'payload' of a stroke must be text"),
        (_DELTA, {"payload": "\0"}, "'payload' of a stroke must be text"),
    ],
)
def test_a_malformed_stroke_is_refused(
    operation: Operation, changed: dict[str, Any], message: str, make_stroke: MakeStroke
) -> None:
    document = {**stroke_to_document(make_stroke(0, operation)), **changed}
    with pytest.raises(FileFormatError, match=message):
        stroke_from_document(document)


@pytest.mark.parametrize("operation", [_PAINT, _ASSIGN, SegmentWide(0, 1), _DELTA, Clear()])
def test_a_missing_key_is_named(operation: Operation, make_stroke: MakeStroke) -> None:
    document = stroke_to_document(make_stroke(0, operation))
    for key in document:
        short = {kept: value for kept, value in document.items() if kept != key}
        with pytest.raises(FileFormatError, match=f"a stroke must have '{key}' but has"):
            stroke_from_document(short)


@pytest.mark.parametrize(
    ("operation", "changed", "error"),
    [
        (_PAINT, {"radius": 0}, ParameterError),
        (_PAINT, {"seeds": []}, ParameterError),
        (_PAINT, {"label": 70_000}, LabelError),
        (_ASSIGN, {"runs": []}, ParameterError),
        (_DELTA, {"n_runs": 9}, LabelError),
        (_DELTA, {"parameters": {"a": [1]}}, ParameterError),
        (Clear(), {"at": "2026-03-01T11:30:00"}, ParameterError),
    ],
)
def test_values_out_of_range_are_refused_by_their_own_rule(
    operation: Operation, changed: dict[str, Any], error: type[Exception], make_stroke: MakeStroke
) -> None:
    with pytest.raises(error):
        stroke_from_document({**stroke_to_document(make_stroke(0, operation)), **changed})


@pytest.mark.parametrize(
    ("place", "changed", "error", "message"),
    [
        (0, {"diagonal": 0}, FileFormatError, "diagonal above 0"),
        (0, {"diagonal": None}, FileFormatError, "'diagonal' of a stroke of version 0 must be a finite number"),
        (0, {"radius": -1}, ParameterError, "radius must be in"),
        (0, {"seed": [1]}, FileFormatError, "'seed' of a stroke of version 0 must be a whole number"),
        (1, {"faces": [1, 2**70]}, FileFormatError, "faces must be at most"),
        (1, {"faces": [1, -1]}, ParameterError, "a face must be 0 or more"),
    ],
)
def test_a_malformed_older_stroke_is_refused(
    place: int, changed: dict[str, Any], error: type[Exception], message: str
) -> None:
    with pytest.raises(error, match=message):
        stroke_from_document({**_golden(0)["log"]["strokes"][place], **changed})


@pytest.mark.parametrize("n_faces", [0, 2**24 + 1])
def test_an_older_log_of_no_mesh_is_refused(n_faces: int) -> None:
    with pytest.raises(FileFormatError, match="1 to 16777216 faces"):
        log_from_json(json.dumps({**_golden(0)["log"], "n_faces": n_faces}))


@pytest.mark.parametrize("text", ["", "{", '{"format": NaN}', "[" * 100_000, "9" * 5_000])
def test_what_is_not_json_is_refused(text: str) -> None:
    with pytest.raises(FileFormatError, match="must be JSON but"):
        log_from_json(text)


@pytest.mark.parametrize("text", ["[]", "3", "{}", '{"format": "other"}'])
def test_what_is_no_stroke_log_is_refused(text: str) -> None:
    with pytest.raises(FileFormatError, match="an object with format"):
        log_from_json(text)


@pytest.mark.parametrize(
    ("changed", "message"),
    [
        ({"v": 2}, "a stroke log must have version 0 to 1 but has 2"),
        ({"strokes": [1]}, "list of objects"),
        ({"strokes": None}, "list of objects"),
        ({"author": "x"}, "a stroke log has unknown keys author"),
    ],
)
def test_a_malformed_log_is_refused(changed: dict[str, Any], message: str) -> None:
    document = json.loads(log_to_json(StrokeLog.starting_from("0" * 64, _BLANK)))
    with pytest.raises(FileFormatError, match=message):
        log_from_json(json.dumps({**document, **changed}))


def test_a_log_with_a_gap_is_refused() -> None:
    document = _golden(1)["log"]
    with pytest.raises(ConflictError, match="must have sequence 1 but has 2"):
        log_from_json(json.dumps({**document, "strokes": document["strokes"][:1] + document["strokes"][2:]}))
