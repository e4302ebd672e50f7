"""Strokes and logs as JSON, version 1, and back.

A stroke is one flat object: `v`, `kind`, `id`, `sequence`, `base_revision`, `author_id`, `at` and the fields of its
kind. A key that is missing, unknown or of another type is refused, never guessed. The order of keys means nothing.
"""

import json
from collections.abc import Callable, Mapping
from datetime import UTC, datetime
from typing import Any
from uuid import UUID

from partwise.errors import FileFormatError
from partwise.labels.label_delta import LabelDelta
from partwise.labels.operations import (
    Assign,
    Clear,
    Delta,
    DeltaSource,
    Operation,
    Paint,
    Redo,
    Scalar,
    SegmentWide,
    Undo,
)
from partwise.labels.stroke_fields import Fields
from partwise.labels.stroke_versions import STROKE_VERSION, upgraded_log, upgraded_stroke
from partwise.labels.strokes import Stroke, StrokeLog
from partwise.segmentation.paint import Brush

LOG_FORMAT = "partwise strokes"


def stroke_to_document(stroke: Stroke) -> dict[str, Any]:
    """The stroke as a JSON object of version 1."""
    return {
        "v": STROKE_VERSION,
        **_operation_document(stroke.operation),
        "id": str(stroke.id),
        "sequence": stroke.sequence,
        "base_revision": stroke.base_revision,
        "author_id": stroke.author_id,
        "at": stroke.at.astimezone(UTC).isoformat(timespec="microseconds").replace("+00:00", "Z"),
    }


def stroke_from_document(document: Mapping[str, Any]) -> Stroke:
    """The stroke of a JSON object, of this version or an older one.

    Raises
    ------
    FileFormatError : a newer version, an unknown kind, a key that is missing, unknown or of another type.
    ParameterError, LabelError : a value out of its range.
    """
    fields = Fields(upgraded_stroke(document), "a stroke")
    fields.whole("v")
    kind = fields.text("kind")
    if kind not in _READERS:
        raise FileFormatError(
            f"a stroke's kind must be one of {', '.join(_READERS)} but is {kind!r}; was it written by a newer Partwise?"
        )
    operation = _READERS[kind](fields)
    stroke = Stroke(
        id=_uuid(fields.text("id")),
        sequence=fields.whole("sequence"),
        base_revision=fields.whole_or_none("base_revision"),
        author_id=fields.whole("author_id"),
        at=_time(fields.text("at")),
        operation=operation,
    )
    fields.check_all_read()
    return stroke


def log_to_json(log: StrokeLog) -> str:
    """The log as JSON text, equal for equal logs."""
    document = {
        "format": LOG_FORMAT,
        "v": STROKE_VERSION,
        "mesh_hash": log.mesh_hash,
        "n_faces": log.n_faces,
        "base_revision": log.base_revision,
        "base_sha256": log.base_sha256,
        "strokes": [stroke_to_document(stroke) for stroke in log.strokes],
    }
    return json.dumps(document, sort_keys=True, allow_nan=False, separators=(",", ":"))


def log_from_json(text: str) -> StrokeLog:
    """The log of JSON text, of this version or an older one; its strokes may be of mixed versions.

    Raises
    ------
    FileFormatError : not JSON, not a stroke log, a newer version, a malformed stroke.
    ParameterError, LabelError, ConflictError : a value out of its range, strokes that do not follow on each other.
    """
    document = _parsed(text)
    if not isinstance(document, dict) or document.get("format") != LOG_FORMAT:
        raise FileFormatError(
            f"a stroke log must be an object with format {LOG_FORMAT!r} but is not; choose another file"
        )
    fields = Fields(upgraded_log(document), "a stroke log")
    fields.text("format")
    fields.whole("v")
    log = StrokeLog(
        mesh_hash=fields.text("mesh_hash"),
        n_faces=fields.whole("n_faces"),
        base_revision=fields.whole_or_none("base_revision"),
        base_sha256=fields.text("base_sha256"),
        strokes=tuple(stroke_from_document(stroke) for stroke in fields.objects("strokes")),
    )
    fields.check_all_read()
    return log


def _operation_document(operation: Operation) -> dict[str, Any]:
    match operation:
        case Paint(seeds, brush, label, only_over):
            return {
                "kind": "paint",
                "seeds": [int(seed) for seed in seeds],  # they may be numpy's
                "radius": float(brush.radius),
                "min_cosine": None if brush.min_cosine is None else float(brush.min_cosine),
                "label": int(label),
                "only_over": None if only_over is None else int(only_over),
            }
        case Assign(runs, label):
            return {"kind": "assign", "runs": [[int(first), int(count)] for first, count in runs], "label": int(label)}
        case SegmentWide(seed, label):
            return {"kind": "segment_wide", "seed": int(seed), "label": int(label)}
        case Delta(source, delta, parameters):
            return {
                "kind": "delta",
                "source": source.value,
                "parameters": dict(parameters),
                "n_faces": delta.n_faces,
                "n_runs": delta.n_runs,
                "payload": delta.payload,
                "sha256": delta.sha256,
            }
        case Clear():
            return {"kind": "clear"}
        case Undo():
            return {"kind": "undo"}
        case Redo():
            return {"kind": "redo"}


def _read_paint(fields: Fields) -> Operation:
    return Paint(
        tuple(fields.wholes("seeds")),
        Brush(fields.number("radius"), fields.number_or_none("min_cosine")),
        fields.whole("label"),
        fields.whole_or_none("only_over"),
    )


def _read_assign(fields: Fields) -> Operation:
    return Assign(tuple(fields.whole_pairs("runs")), fields.whole("label"))


def _read_segment_wide(fields: Fields) -> Operation:
    return SegmentWide(fields.whole("seed"), fields.whole("label"))


def _read_delta(fields: Fields) -> Operation:
    source = fields.text("source")
    if source not in list(DeltaSource):
        raise FileFormatError(
            f"a delta's source must be one of {', '.join(DeltaSource)} but is {source!r}; written by a newer Partwise?"
        )
    parameters: dict[str, Scalar] = fields.mapping("parameters")
    delta = LabelDelta(fields.whole("n_faces"), fields.whole("n_runs"), fields.text("payload"), fields.text("sha256"))
    return Delta.of(DeltaSource(source), delta, parameters)


_READERS: Mapping[str, Callable[[Fields], Operation]] = {
    "paint": _read_paint,
    "assign": _read_assign,
    "segment_wide": _read_segment_wide,
    "delta": _read_delta,
    "clear": lambda _: Clear(),
    "undo": lambda _: Undo(),
    "redo": lambda _: Redo(),
}


def _uuid(text: str) -> UUID:
    try:
        return UUID(text)
    except ValueError as error:
        raise FileFormatError(f"a stroke's id must be a UUID but is {text!r}; make one for each stroke") from error


def _time(text: str) -> datetime:
    try:
        at = datetime.fromisoformat(text)
        return at if at.tzinfo is None else at.astimezone(UTC)
    except (ValueError, OverflowError) as error:
        raise FileFormatError(f"a stroke's time must be like 2026-01-31T12:00:00Z but is {text!r}") from error


def _parsed(text: str) -> Any:
    def refuse_constant(name: str) -> float:
        raise ValueError(f"{name} is no number")

    try:
        return json.loads(text, parse_constant=refuse_constant)
    except (ValueError, RecursionError) as error:
        raise FileFormatError(f"a stroke log must be JSON but: {error}; was the file cut short?") from error
