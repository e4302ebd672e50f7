"""Labels of many shapes are moved by Ray tasks; a shape that fails costs only itself."""

from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest

from partwise.mesh import TriMesh
from partwise.store.meshes import kept_mesh_key
from partwise.store.records import Collection, RevisionKind
from partwise.testing.spheres import ball, halves, speckles
from partwise.testing.workspaces import ingest, publish_meshes
from partwise.workspace.labelling import commit_labels
from partwise.workspace.progress import RunProgress
from partwise.workspace.relabel import RELABEL, MoveReport
from partwise.workspace.workspace import Workspace, init_workspace, open_workspace
from partwise_workers import passes
from partwise_workers import relabelling as module
from partwise_workers.relabelling import move_labels

FINE, COARSE = ball(3), ball(2)
N_SHAPES = 4


def scaled(mesh: TriMesh, number: int) -> TriMesh:
    return TriMesh(mesh.vertices * (1 + number), mesh.faces)


@pytest.fixture
def remeshed(tmp_path: Path) -> Iterator[tuple[Workspace, Collection, list[int]]]:
    """Shapes whose fine meshes were labelled before they got coarse ones; the last one's labels are too fine."""
    init_workspace(tmp_path / "ws")
    with open_workspace(tmp_path / "ws") as workspace:
        collection = workspace.catalog.create_collection("balls", ["upper", "lower"])
        ids = list(ingest(workspace, collection, {f"{i}.off": scaled(FINE, i) for i in range(N_SHAPES)}).values())
        publish_meshes(workspace, {shape_id: scaled(FINE, i) for i, shape_id in enumerate(ids)}, "fine")
        for shape_id in ids:
            labels = speckles(FINE) if shape_id == ids[-1] else halves(FINE)
            commit_labels(workspace, collection, workspace.catalog.shape(shape_id), labels, RevisionKind.HUMAN, "ann")
        publish_meshes(workspace, {shape_id: scaled(COARSE, i) for i, shape_id in enumerate(ids)}, "coarse")
        yield workspace, collection, ids


def test_tasks_move_what_one_process_would(local_ray, remeshed, monkeypatch: pytest.MonkeyPatch) -> None:
    workspace, collection, ids = remeshed
    monkeypatch.setattr(module, "FEW", 0)
    told = []
    assert move_labels(workspace, collection, told.append) == MoveReport(N_SHAPES, 1, 0)
    for shape_id in ids[:-1]:
        head = workspace.catalog.head_revision(shape_id)
        np.testing.assert_array_equal(workspace.catalog.labels(head.id), halves(COARSE))
    assert [review.shape_id for review in workspace.catalog.open_reviews(collection.id)] == ids[-1:]
    assert [(progress.n_done, progress.n_total) for progress in told] == [(i + 1, N_SHAPES) for i in range(N_SHAPES)]
    assert move_labels(workspace, collection, told.append) == MoveReport(0, 0, 0)


def test_a_shape_whose_mesh_is_damaged_costs_only_itself(local_ray, remeshed, monkeypatch: pytest.MonkeyPatch) -> None:
    workspace, collection, _ = remeshed
    monkeypatch.setattr(module, "FEW", 0)
    workspace.arrays.put_bytes(kept_mesh_key(FINE.content_hash()), b"damaged")
    assert move_labels(workspace, collection, lambda _: None) == MoveReport(N_SHAPES - 1, 1, 1)
    (failure,) = workspace.catalog.failures(collection.id)
    assert (failure.source_key, failure.run.stage) == ("0.off", RELABEL)
    assert "safetensors" in str(failure.run.reason)


def test_few_moves_need_no_ray(remeshed, monkeypatch: pytest.MonkeyPatch) -> None:
    workspace, collection, _ = remeshed

    def refuse() -> None:
        raise AssertionError("Ray was asked for")

    monkeypatch.setattr(module, "connected", refuse)
    assert move_labels(workspace, collection, lambda _: None).n_moved == N_SHAPES


def test_preprocessing_ends_with_moving_labels(remeshed, monkeypatch: pytest.MonkeyPatch) -> None:
    workspace, collection, _ = remeshed
    monkeypatch.setattr(passes, "_run", lambda *_: RunProgress(0, 0, 0))
    told: list[MoveReport] = []
    progress = passes.preprocess(workspace, collection, lambda _: None, on_moved=told.append)
    assert (progress, told) == (RunProgress(0, 0, 0), [MoveReport(N_SHAPES, 1, 0)])
    assert len(workspace.catalog.open_reviews(collection.id)) == 1
