"""Blocks that are damaged, disks that are full, stores that do not answer: an error in one line, never wrong values."""

import errno
import os
import socket
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from partwise.errors import ConfigError, NotFoundError, StoreError
from partwise.store import objects
from partwise.store.array_store import BlockAddress
from partwise.store.block_kinds import REFINEMENT
from partwise.store.open_arrays import open_array_store
from partwise.store.zarr_store import ZarrArrayStore

_LABELS = np.random.default_rng(5).integers(0, 9, 20_000).astype(np.uint16)


@pytest.fixture
def root(tmp_path: Path, store: ZarrArrayStore) -> Path:
    return tmp_path / "arrays"


@pytest.fixture
def address(store: ZarrArrayStore) -> BlockAddress:
    return store.write_block(REFINEMENT, [{"labels": _LABELS}])


def _is_refused(store: ZarrArrayStore, address: BlockAddress) -> None:
    with pytest.raises(StoreError, match="block") as caught:
        store.read(address.name, 0, "labels")
    assert "\n" not in str(caught.value)
    with pytest.raises(StoreError, match="checksum"):
        store.verify(address)


@pytest.mark.parametrize("n_bytes", [0, 10, -1, -100])
def test_a_truncated_shard_is_refused(store: ZarrArrayStore, root: Path, address: BlockAddress, n_bytes: int) -> None:
    shard = root / address.name / "labels/c/0"
    shard.write_bytes(shard.read_bytes()[:n_bytes])
    _is_refused(store, address)


@pytest.mark.parametrize("key", ["zarr.json", "labels/zarr.json", "labels/c/0", "face_ptr/c/0", "face_ptr/zarr.json"])
def test_an_absent_object_is_refused(store: ZarrArrayStore, root: Path, address: BlockAddress, key: str) -> None:
    (root / address.name / key).unlink()
    _is_refused(store, address)


@pytest.mark.parametrize("key", ["zarr.json", "labels/zarr.json", "labels/c/0", "face_ptr/c/0"])
def test_a_flipped_byte_is_refused(store: ZarrArrayStore, root: Path, address: BlockAddress, key: str) -> None:
    file = root / address.name / key
    data = bytearray(file.read_bytes())
    data[len(data) // 3] ^= 0xFF
    file.write_bytes(data)
    _is_refused(store, address)


def test_a_shard_that_vanishes_from_an_open_block_is_refused(
    store: ZarrArrayStore, root: Path, address: BlockAddress
) -> None:
    np.testing.assert_array_equal(store.read(address.name, 0, "labels"), _LABELS)
    (root / address.name / "labels/c/0").unlink()
    _is_refused(store, address)


def test_a_block_that_never_was_is_refused(store: ZarrArrayStore, address: BlockAddress) -> None:
    with pytest.raises(StoreError, match="was its block deleted"):
        store.read(address.name[:-1] + ("0" if address.name[-1] != "0" else "1"), 0, "labels")


@pytest.mark.parametrize(
    "damage",
    [
        lambda data: b"",
        lambda data: data[:3],
        lambda data: data[:-1],
        lambda data: bytes(len(data)),
        lambda data: data[:200] + bytes(64) + data[264:],
    ],
    ids=["empty", "shorter than its checksum", "cut off", "zeros", "a page that was never written"],
)
def test_damaged_staging_is_refused(store: ZarrArrayStore, root: Path, damage: Callable[[bytes], bytes]) -> None:
    store.stage("a", {"x": np.ones(100)})
    file = root / "staging/a"
    file.write_bytes(damage(file.read_bytes()))
    with pytest.raises(StoreError, match="damaged; preprocess its shape again"):
        store.read_staged("a")


def test_staging_does_not_wait_for_the_disk(store: ZarrArrayStore, monkeypatch: pytest.MonkeyPatch) -> None:
    store.stage("folder/a", {"x": np.ones(100)})  # a new folder's entry is synced
    monkeypatch.setattr(objects.os, "fsync", lambda _: _fail(errno.EIO))
    store.stage("folder/b", {"x": np.ones(100)})
    np.testing.assert_array_equal(store.read_staged("folder/b")["x"], np.ones(100))


def test_a_full_disk_leaves_nothing_half_staged(
    store: ZarrArrayStore, root: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(objects.os, "replace", lambda *_: _fail(errno.ENOSPC))
    with pytest.raises(StoreError, match="no room for staging/a; free some space"):
        store.stage("a", {"x": np.ones(100)})
    assert list(store.staged_keys()) == []
    assert list((root / ".partial").iterdir()) == []


def _fail(error_number: int) -> None:
    raise OSError(error_number, os.strerror(error_number))


def test_a_full_disk_keeps_the_previous_object(
    store: ZarrArrayStore, root: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    store.put_bytes("models/1", b"old")
    monkeypatch.setattr(objects.os, "fsync", lambda _: _fail(errno.ENOSPC))
    with pytest.raises(StoreError, match="no room for models/1; free some space"):
        store.put_bytes("models/1", b"new")
    assert store.get_bytes("models/1") == b"old"
    assert list((root / ".partial").iterdir()) == []


def test_a_full_disk_leaves_no_half_block(store: ZarrArrayStore, monkeypatch: pytest.MonkeyPatch) -> None:
    put = store._objects.put

    def fills_up(key: str, data: bytes) -> None:
        if key.endswith("labels/zarr.json"):
            with objects.storing("arrays", key):
                _fail(errno.ENOSPC)
        put(key, data)

    monkeypatch.setattr(store._objects, "put", fills_up)
    with pytest.raises(StoreError, match="free some space"):
        store.write_block(REFINEMENT, [{"labels": _LABELS}])
    assert store.block_names() == []


def test_a_store_that_also_refuses_to_clean_up_says_what_went_wrong_first(
    store: ZarrArrayStore, monkeypatch: pytest.MonkeyPatch
) -> None:
    def refuse(what: str) -> None:
        raise StoreError(f"cannot {what}")

    monkeypatch.setattr(store._objects, "put", lambda key, data: refuse("put"))
    monkeypatch.setattr(store._objects, "delete_folder", lambda folder: refuse("delete"))
    with pytest.raises(StoreError, match="cannot put"):
        store.write_block(REFINEMENT, [{"labels": _LABELS}])


def test_a_refusing_disk_is_said(store: ZarrArrayStore, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(objects.os, "fsync", lambda _: _fail(errno.EACCES))
    with pytest.raises(StoreError, match="Permission denied; may you write there"):
        store.put_bytes("models/1", b"new")


def test_a_driver_with_errors_of_its_own_is_said() -> None:
    class BotoError(Exception):
        pass

    with (
        pytest.raises(StoreError, match="at models/1: no route; is it reachable"),
        objects.storing("s3://b", "models/1"),
    ):
        raise BotoError("no route\nmore")


def test_a_folder_without_a_parent_is_refused(tmp_path: Path) -> None:
    with pytest.raises(StoreError, match="folder"):
        open_array_store(str(tmp_path / "missing" / "arrays"))


def test_a_file_is_no_store(tmp_path: Path) -> None:
    (tmp_path / "arrays").touch()
    with pytest.raises(StoreError, match="arrays"):
        open_array_store(str(tmp_path / "arrays"))


def test_an_unknown_scheme_is_refused() -> None:
    with pytest.raises(ConfigError, match="gopher"):
        open_array_store("gopher://host/arrays")


def test_an_unreachable_object_store_is_said() -> None:
    pytest.importorskip("s3fs")
    with socket.socket() as free:
        free.bind(("127.0.0.1", 0))
        port = free.getsockname()[1]
    options = {
        "endpoint_url": f"http://127.0.0.1:{port}",
        "key": "k",
        "secret": "s",
        "config_kwargs": {"retries": {"max_attempts": 0}},
    }
    with pytest.raises(StoreError, match="reachable") as caught:
        open_array_store("s3://bucket/arrays", options)
    assert "\n" not in str(caught.value)


def test_a_file_url_is_a_folder(tmp_path: Path) -> None:
    store = open_array_store(f"file://{tmp_path}/arrays")
    store.put_bytes("a/b", b"x")
    assert (tmp_path / "arrays/a/b").read_bytes() == b"x"


def test_a_missing_object_is_not_found_on_disk(store: ZarrArrayStore) -> None:
    with pytest.raises(NotFoundError, match="a/b"):
        store.get_bytes("a/b")
