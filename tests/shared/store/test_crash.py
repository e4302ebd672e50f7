"""A process killed at any moment: what was published is whole, what was not is invisible and swept."""

import multiprocessing
import os
import signal
from datetime import timedelta
from pathlib import Path

import numpy as np
import pytest

from partwise.store.array_store import BlockAddress
from partwise.store.block_kinds import REFINEMENT
from partwise.store.open import open_catalog
from partwise.store.open_arrays import open_array_store
from partwise.store.records import NewBlock, NewStageRun
from partwise.store.sql_catalog import SqlCatalog
from partwise.store.zarr_store import ZarrArrayStore
from partwise.testing.catalog.samples import add_collection

_LABELS = np.arange(5_000, dtype=np.uint16)
_GRACE_OVER = timedelta(days=-1)  # a limit a day ahead: everything counts as old enough


def _sweep(catalog: SqlCatalog, store: ZarrArrayStore) -> None:
    visible = {block.name for block in catalog.visible_blocks()}
    for name in store.orphans(visible, _GRACE_OVER):
        store.delete_block(name)


def _new_block(address: BlockAddress) -> NewBlock:
    return NewBlock(address.name, "refinement", address.n_shapes, address.n_bytes, address.checksum)


def _write_and_die(root: str, url: str, shape_id: int, n_puts: int) -> None:
    """Be killed just before the object number `n_puts`, or before the commit if there are fewer."""
    store = open_array_store(root)
    put, count = store._objects.put, 0

    def deadly(key: str, data: bytes) -> None:
        nonlocal count
        if count == n_puts:
            os.kill(os.getpid(), signal.SIGKILL)
        count += 1
        put(key, data)

    store._objects.put = deadly  # type: ignore[method-assign]
    address = store.write_block(REFINEMENT, [{"labels": _LABELS}])
    with open_catalog(url):
        os.kill(os.getpid(), signal.SIGKILL)
    raise AssertionError(address, shape_id)


@pytest.mark.parametrize("n_puts", [0, 3, 99])
def test_a_killed_writer_leaves_only_what_gc_sweeps(catalog_file: Path, tmp_path: Path, n_puts: int) -> None:
    root, url = str(tmp_path / "arrays"), f"sqlite:///{catalog_file}"
    store = open_array_store(root)
    with open_catalog(url) as catalog:
        _, (finished, unfinished) = add_collection(catalog, 2)
        address = store.write_block(REFINEMENT, [{"labels": _LABELS}])
        catalog.publish_block(_new_block(address), [NewStageRun(finished, "refine", "k1", 0)])
        process = multiprocessing.get_context("spawn").Process(
            target=_write_and_die, args=(root, url, unfinished, n_puts)
        )
        process.start()
        process.join()
        assert process.exitcode == -signal.SIGKILL
        assert set(catalog.stage_runs([finished, unfinished], "refine")) == {finished}
        _sweep(catalog, store)
        assert list(store.block_names()) == [address.name]
        store.verify(address)


def test_a_write_under_way_is_not_swept(catalog: SqlCatalog, store: ZarrArrayStore) -> None:
    address = store.write_block(REFINEMENT, [{"labels": _LABELS}])
    assert store.orphans(set(), timedelta(hours=1)) == []
    assert list(store.orphans(set(), _GRACE_OVER)) == [address.name]


def test_a_superseded_block_is_forgotten_first_and_then_swept(catalog: SqlCatalog, store: ZarrArrayStore) -> None:
    _, (shape_id,) = add_collection(catalog, 1)
    for key in ("k1", "k2"):
        address = store.write_block(REFINEMENT, [{"labels": _LABELS}])
        catalog.publish_block(_new_block(address), [NewStageRun(shape_id, "refine", key, 0)])
    catalog.delete_blocks([block.name for block in catalog.unused_blocks()])
    _sweep(catalog, store)
    assert list(store.block_names()) == [address.name]
