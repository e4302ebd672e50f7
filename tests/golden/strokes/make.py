"""Writes the golden logs beside it: `python tests/golden/strokes/make.py`. See README.md.

Once a version has been released its file is never written again: only the file of the newest version may change.
"""

import json
from collections.abc import Sequence
from datetime import UTC, datetime, timedelta
from pathlib import Path
from typing import Any
from uuid import UUID

import numpy as np

from partwise.labels.label_delta import LabelDelta
from partwise.labels.operations import Assign, Clear, Delta, DeltaSource, Operation, Paint, Redo, SegmentWide, Undo
from partwise.labels.stroke_json import log_to_json
from partwise.labels.strokes import Stroke, StrokeLog
from partwise.mesh import TriMesh
from partwise.segmentation.paint import Brush
from partwise.testing.plain_paint import plain_painted

PROVENANCE = (
    "Log from tests/golden/strokes/make.py. Labels worked out there stroke by stroke in plain Python, with "
    "partwise.testing.plain_paint and lists of past labels, not by the code that replays logs."
)
_START = datetime(2026, 3, 1, 9, 30, 0, 250_000, tzinfo=UTC)
_DIAGONAL = 1.224744871391589  # of the sheet below


def bent_sheet() -> TriMesh:
    """6 × 4 squares, bent upwards by a right angle after the third column."""
    height = np.array([0, 0, 0, 0, 1, 2, 3]) / 6
    reach = np.array([0, 1, 2, 3, 3, 3, 3]) / 6
    vertices = [(reach[i], j / 4, height[i]) for j in range(5) for i in range(7)]
    corners = [j * 7 + i for j in range(4) for i in range(6)]
    faces = [face for a in corners for face in ([a, a + 1, a + 8], [a, a + 8, a + 7])]
    return TriMesh(np.array(vertices, dtype=np.float32), np.array(faces))


class PlainLabels:
    """Labels as a list, with every earlier list kept. Undo and redo change nothing where none is left."""

    def __init__(self, mesh: TriMesh) -> None:
        self._vertices, self._faces = mesh.vertices.tolist(), mesh.faces.tolist()
        self.now = [0] * mesh.n_faces
        self._past: list[list[int]] = []
        self._future: list[list[int]] = []

    def do(self, operation: Operation) -> list[int]:
        if isinstance(operation, Undo):
            self._step(self._past, self._future)
        elif isinstance(operation, Redo):
            self._step(self._future, self._past)
        else:
            self._past.append(self.now)
            self._future.clear()
            self.now = self._after(operation)
        return self.now

    def _step(self, there: list[list[int]], here: list[list[int]]) -> None:
        if there:
            here.append(self.now)
            self.now = there.pop()

    def _after(self, operation: Operation) -> list[int]:
        match operation:
            case Paint(seeds, brush, label, only_over):
                taken = self._painted(list(seeds), brush.radius, brush.min_cosine, only_over)
            case SegmentWide(seed, label):
                taken = self._painted([seed], 1.0, None, self.now[seed])
            case Assign(runs, label):
                taken = [face for first, count in runs for face in range(first, first + count)]
            case Delta():
                return refined(self.now)
            case _:
                return [0] * len(self.now)
        return [label if face in taken else old for face, old in enumerate(self.now)]

    def _painted(self, seeds: list[int], radius: float, min_cosine: float | None, over: int | None) -> list[int]:
        is_open = None if over is None else {face for face, label in enumerate(self.now) if label == over}
        return plain_painted(self._vertices, self._faces, seeds, radius, min_cosine, is_open)


def refined(labels: list[int]) -> list[int]:
    """What a solver might have answered: part 2 gone, faces 5 to 7 part 3."""
    return [3 if 5 <= face < 8 else 1 if label == 2 else label for face, label in enumerate(labels)]


def version_1() -> tuple[dict[str, Any], list[list[int]]]:
    """A log with every kind of operation, and the labels after each stroke."""
    mesh = bent_sheet()
    plain = PlainLabels(mesh)
    first: list[Operation] = [
        Paint((16,), Brush(0.25), 1),
        Paint((2, 4, 30), Brush(0.5, 0.75), 2),
        SegmentWide(11, 3),
        Undo(),
        Redo(),
        Assign.to_faces([8, 9, 10, 11, 20], 1),
    ]
    after_each = [plain.do(operation) for operation in first]
    now = np.array(plain.now, dtype=np.uint16)
    delta = LabelDelta.between(now, np.array(refined(plain.now), dtype=np.uint16))
    then: list[Operation] = [
        Delta.of(DeltaSource.BOUNDARY_REFINEMENT, delta, {"omega": 0.2}),
        Clear(),
        Undo(),
        Paint((47,), Brush(1.0), 2, only_over=0),
    ]
    after_each += [plain.do(operation) for operation in then]
    return _log_of(mesh, [*first, *then]), after_each


def version_1_without_steps() -> tuple[dict[str, Any], list[list[int]]]:
    """Undo and redo where there is nothing to take back or to do again, and the labels after each stroke."""
    mesh = bent_sheet()
    first, second = Assign(((8, 4), (20, 1)), 1), Paint((40,), Brush(0.25), 2)
    operations = [Undo(), Redo(), first, Redo(), Undo(), Undo(), Redo(), Redo(), second, Redo(), Undo(), Undo(), Undo()]
    plain = PlainLabels(mesh)
    return _log_of(mesh, operations), [plain.do(operation) for operation in operations]


def _log_of(mesh: TriMesh, operations: Sequence[Operation]) -> dict[str, Any]:
    log = StrokeLog.starting_from(mesh.content_hash(), np.zeros(mesh.n_faces, dtype=np.uint16))
    for n, operation in enumerate(operations):
        at = _START + timedelta(seconds=3.5 * n)
        log = log.with_stroke(Stroke(UUID(int=n + 1, version=4), n, None, 7, at, operation))
    document: dict[str, Any] = json.loads(log_to_json(log))
    return document


def version_0() -> tuple[dict[str, Any], list[list[int]]]:
    """A log from when radii were in model units, with each kind of stroke that changed since."""
    mesh = bent_sheet()
    steps: list[tuple[dict[str, Any], Operation]] = [
        (
            {"kind": "paint", "seed": 16, "radius": 0.3, "diagonal": _DIAGONAL, "label": 1},
            Paint((16,), Brush(0.3 / _DIAGONAL), 1),
        ),
        ({"kind": "assign", "faces": [9, 8, 10, 11, 20, 8], "label": 2}, Assign(((8, 4), (20, 1)), 2)),
        (
            {"kind": "paint", "seed": 40, "radius": 9.0, "diagonal": _DIAGONAL, "label": 3},
            Paint((40,), Brush(1.0), 3),
        ),
        ({"kind": "undo"}, Undo()),
        ({"kind": "segment_wide", "seed": 0, "label": 3}, SegmentWide(0, 3)),
    ]
    strokes = [
        {
            "v": 0,
            "id": str(UUID(int=n + 1, version=4)),
            "sequence": n,
            "author_id": 7,
            "at": f"2026-01-05T08:00:{n:02}Z",
            **fields,
        }
        for n, (fields, _) in enumerate(steps)
    ]
    log = {"format": "partwise strokes", "v": 0, "mesh_hash": mesh.content_hash(), "n_faces": mesh.n_faces}
    plain = PlainLabels(mesh)
    return {**log, "strokes": strokes}, [plain.do(operation) for _, operation in steps]


def write(name: str, log: dict[str, Any], after_each: list[list[int]]) -> None:
    mesh = bent_sheet()
    document = {
        "provenance": PROVENANCE,
        "vertices": mesh.vertices.tolist(),
        "faces": mesh.faces.tolist(),
        "log": log,
        "labels_after_each_stroke": after_each,
    }
    lines = [f"{json.dumps(key)}: {json.dumps(value, separators=(',', ':'))}" for key, value in document.items()]
    Path(__file__).with_name(f"{name}.json").write_text("{\n" + ",\n".join(lines) + "\n}\n")


if __name__ == "__main__":
    write("v0", *version_0())
    write("v1", *version_1())
    write("v1_without_steps", *version_1_without_steps())
