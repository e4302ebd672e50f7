"""Labels of many shapes are moved by Ray tasks; a shape that fails costs only itself."""

import os
import sys
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import ray
from ray import cloudpickle

from partwise.errors import StoreError
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

cloudpickle.register_pickle_by_value(sys.modules[__name__])

FINE, COARSE = ball(3), ball(2)
N_SHAPES = 4


@ray.remote(max_retries=0)
def dies(*_: object) -> None:
    os._exit(1)


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


def test_a_store_that_is_down_ends_the_moves_and_blames_no_shape(
    local_ray, remeshed, monkeypatch: pytest.MonkeyPatch
) -> None:
    workspace, collection, _ = remeshed
    monkeypatch.setattr(module, "FEW", 0)
    workspace.arrays.put_bytes(kept_mesh_key(FINE.content_hash()), b"damaged")

    def refuse(*_: object) -> None:
        raise StoreError("the array store refused; is it reachable?")

    monkeypatch.setattr(workspace.arrays, "stage", refuse)
    with pytest.raises(StoreError, match="is it reachable"):
        move_labels(workspace, collection, lambda _: None)
    assert list(workspace.catalog.failures(collection.id)) == []


def test_a_move_past_the_deadline_is_given_up_and_named(local_ray, remeshed, monkeypatch: pytest.MonkeyPatch) -> None:
    workspace, collection, _ = remeshed
    monkeypatch.setattr(module, "FEW", 0)
    monkeypatch.setattr(module, "POLL_S", 0.01)
    workers = workspace.config.workers
    limits = replace(workers.limits, remesh=replace(workers.limits.remesh, deadline_s=1e-3))
    config = replace(workspace.config, workers=replace(workers, limits=limits))
    report = move_labels(replace(workspace, config=config), collection, lambda _: None)
    assert report.n_failed >= 1
    assert report.n_moved + report.n_failed == N_SHAPES
    reasons = [str(failure.run.reason) for failure in workspace.catalog.failures(collection.id)]
    assert len(reasons) == report.n_failed
    assert all("raise deadline_s under [workers.limits.remesh]" in reason for reason in reasons)


def test_a_move_whose_process_dies_costs_only_itself_and_says_what_to_do(
    local_ray, remeshed, monkeypatch: pytest.MonkeyPatch
) -> None:
    workspace, collection, _ = remeshed
    monkeypatch.setattr(module, "FEW", 0)
    monkeypatch.setattr(module, "_compute", dies)
    assert move_labels(workspace, collection, lambda _: None).n_failed == N_SHAPES
    failures = workspace.catalog.failures(collection.id)
    assert all("then preprocess again" in str(failure.run.reason) for failure in failures)


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
