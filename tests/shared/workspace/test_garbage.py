"""`gc` sweeps what nothing needs, and only that."""

from datetime import UTC, datetime, timedelta
from pathlib import Path

import numpy as np
import pytest

from partwise.store.block_kinds import REFINEMENT
from partwise.store.large_objects import LargeObjectWriter, expiring_key
from partwise.store.records import RevisionKind
from partwise.testing.workspaces import publish_features, publish_meshes
from partwise.workspace import garbage as module
from partwise.workspace.garbage import GarbageReport, collect_garbage
from partwise.workspace.labelling import commit_labels
from partwise.workspace.shapes import load_mesh, shape_mesh

AT_ONCE = timedelta(0)
NOTHING = GarbageReport(0, 0, 0, 0, 0)


def test_what_is_in_use_stays(filled) -> None:
    filled.refined(filled.described().evaluated())
    before = filled.workspace.arrays.block_names()
    assert collect_garbage(filled.workspace, AT_ONCE) == NOTHING
    assert filled.workspace.arrays.block_names() == before


def test_replaced_blocks_are_swept(filled) -> None:
    filled.preprocessed()
    ids, rng = list(filled.ids.values()), np.random.default_rng(0)
    old = publish_features(filled.workspace, ids, rng)
    n_bytes = filled.workspace.catalog.block(old).n_bytes
    new = publish_features(filled.workspace, ids, rng, key="describe-2")
    assert collect_garbage(filled.workspace, AT_ONCE) == GarbageReport(1, 0, 0, n_bytes, 0)
    names = filled.workspace.arrays.block_names()
    assert old not in names
    assert new in names


def test_a_block_is_needed_until_every_shape_in_it_is_replaced(filled) -> None:
    filled.preprocessed()
    rng = np.random.default_rng(0)
    old = publish_features(filled.workspace, list(filled.ids.values()), rng)
    publish_features(filled.workspace, [filled.ids["a.off"]], rng, key="describe-2")
    assert collect_garbage(filled.workspace, AT_ONCE) == NOTHING
    assert old in filled.workspace.arrays.block_names()


def test_orphans_are_swept_once_they_are_old(filled) -> None:
    name = filled.workspace.arrays.write_block(REFINEMENT, [{"labels": np.zeros(4, dtype=np.uint16)}]).name
    assert collect_garbage(filled.workspace, timedelta(hours=1)) == NOTHING
    assert name in filled.workspace.arrays.block_names()
    assert collect_garbage(filled.workspace, timedelta(seconds=-1)) == GarbageReport(0, 1, 0, 0, 0)
    assert name not in filled.workspace.arrays.block_names()


def test_a_labelled_mesh_outlives_its_block(filled) -> None:
    filled.preprocessed()
    shape = filled.shape("b.off")
    labels = np.ones(16, dtype=np.uint16)
    commit_labels(filled.workspace, filled.collection, shape, labels, RevisionKind.HUMAN, "ann")
    labelled = shape_mesh(filled.workspace, shape)
    publish_meshes(filled.workspace, dict.fromkeys(filled.ids.values(), filled.meshes["a.off"]), key="mesh-2")
    assert collect_garbage(filled.workspace, AT_ONCE).n_unused_blocks == 1
    kept = filled.workspace.catalog.mesh(shape.id, labelled.mesh_hash)
    assert np.array_equal(load_mesh(filled.workspace, kept).faces, filled.meshes["b.off"].faces)


def test_what_killed_writes_left_is_swept_once_it_is_old(filled) -> None:
    partial = Path(filled.workspace.array_url) / ".partial" / "half"
    partial.write_bytes(b"half of it")
    assert collect_garbage(filled.workspace, timedelta(hours=1)) == NOTHING
    assert collect_garbage(filled.workspace, timedelta(seconds=-1)) == GarbageReport(0, 0, 1, 0, 0)
    assert not partial.exists()


def test_a_block_that_comes_into_use_meanwhile_is_left_alone(filled, monkeypatch: pytest.MonkeyPatch) -> None:
    filled.preprocessed()
    ids, rng, catalog = list(filled.ids.values()), np.random.default_rng(0), filled.workspace.catalog
    names = [publish_features(filled.workspace, ids, rng, key=f"describe-{version}") for version in range(2)]
    blocks = [catalog.block(name) for name in names]
    lists = [blocks, blocks[1:]]  # as if the second had been unused when they were listed
    monkeypatch.setattr(type(catalog), "unused_blocks", lambda *_, **__: lists.pop(0))
    assert collect_garbage(filled.workspace, timedelta(hours=1)) == GarbageReport(1, 0, 0, blocks[0].n_bytes, 0)
    left = filled.workspace.arrays.block_names()
    assert (names[0] in left, names[1] in left) == (False, True)


def test_sources_stay(filled) -> None:
    collect_garbage(filled.workspace, timedelta(seconds=-1))
    assert len(filled.workspace.arrays.list("sources")) == 3


def test_garbage_is_collected_page_by_page(filled, monkeypatch: pytest.MonkeyPatch) -> None:
    filled.preprocessed()
    monkeypatch.setattr(module, "PAGE", 1)
    ids, rng = list(filled.ids.values()), np.random.default_rng(0)
    for version in range(3):
        publish_features(filled.workspace, ids, rng, key=f"describe-{version}")
    assert collect_garbage(filled.workspace, timedelta(seconds=-1)).n_unused_blocks == 2
    assert len(filled.workspace.arrays.block_names()) == 2


@pytest.mark.parametrize("folder", ["uploads", "exports"])
def test_what_nobody_came_for_in_time_is_swept(filled, folder: str) -> None:
    for hours in (-1, 1):
        key = expiring_key(f"{folder}/{filled.collection.id}", datetime.now(UTC) + timedelta(hours=hours))
        LargeObjectWriter(filled.workspace.arrays, key).finish({})
    assert collect_garbage(filled.workspace, AT_ONCE) == GarbageReport(0, 0, 0, 0, 1)
    assert filled.workspace.arrays.list(folder) == [f"{key}/whole.json"]
