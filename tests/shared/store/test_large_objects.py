"""Objects in chunks: there whole or not at all, and gone when they expire."""

from datetime import UTC, datetime, timedelta

import numpy as np
import pytest

from partwise.errors import NotFoundError, StoreError
from partwise.store import large_objects as module
from partwise.store.large_objects import (
    LargeObjectWriter,
    delete_large_object,
    expiring_key,
    expiry_of,
    find_large_object,
    find_unexpired,
    large_object_keys,
    read_chunks,
    sweep_expired,
)

NOW = datetime(2026, 11, 22, 12, 0, tzinfo=UTC)
DATA = np.random.default_rng(0).bytes(2_500)


@pytest.fixture(autouse=True)
def _small_chunks(monkeypatch) -> None:
    monkeypatch.setattr(module, "CHUNK_BYTES", 1_000)


def written(store, key="uploads/1/x"):
    writer = LargeObjectWriter(store, key)
    for start in range(0, len(DATA), 700):
        writer.write(DATA[start : start + 700])
    return writer.finish({"name": "a.zip"})


def test_what_was_written_is_read(store) -> None:
    made = written(store)
    found = find_large_object(store, made.key)
    assert found == made
    assert [len(chunk) for chunk in read_chunks(store, found)] == [1_000, 1_000, 500]
    assert b"".join(read_chunks(store, found)) == DATA


def test_full_chunks_do_not_wait_in_memory(store) -> None:
    writer = LargeObjectWriter(store, "uploads/1/x")
    writer.write(DATA)
    assert store.list("uploads/1/x") == ["uploads/1/x/000000", "uploads/1/x/000001"]


def test_it_is_not_there_before_it_is_whole(store) -> None:
    LargeObjectWriter(store, "uploads/1/x").write(DATA)
    with pytest.raises(NotFoundError):
        find_large_object(store, "uploads/1/x")


def test_damage_is_noticed(store) -> None:
    made = written(store)
    store.put_bytes(f"{made.key}/000001", bytes(1_000))
    with pytest.raises(StoreError, match="damaged"):
        list(read_chunks(store, made))


@pytest.mark.parametrize("document", [b"{", b"[]", b"{}"])
def test_a_damaged_description_is_noticed(store, document) -> None:
    store.put_bytes("uploads/1/x/whole.json", document)
    with pytest.raises(StoreError, match="damaged"):
        find_large_object(store, "uploads/1/x")


def test_deleting_leaves_nothing(store) -> None:
    made = written(store)
    delete_large_object(store, made.key)
    assert store.list("uploads") == []


def test_what_has_expired_is_swept_whole_or_not(store) -> None:
    old, young = (expiring_key("uploads/1", NOW + timedelta(hours=hours)) for hours in (-1, 1))
    written(store, old)
    written(store, young)
    half = expiring_key("uploads/1", NOW - timedelta(seconds=1))
    store.put_bytes(f"{half}/begun", b"")
    assert set(large_object_keys(store, "uploads/1")) == {old, young, half}
    assert sweep_expired(store, "uploads/1", NOW) == [old, half]
    assert large_object_keys(store, "uploads/1") == [young]


def test_what_has_not_expired_is_found_by_name(store) -> None:
    made = written(store, expiring_key("uploads/1", datetime.now(UTC) + timedelta(hours=1)))
    assert find_unexpired(store, "uploads/1", made.name) == made
    with pytest.raises(NotFoundError):
        find_unexpired(store, "uploads/2", made.name)


def test_what_has_expired_is_not_found_even_before_it_is_swept(store) -> None:
    made = written(store, expiring_key("uploads/1", NOW - timedelta(days=1000)))
    with pytest.raises(NotFoundError, match="or no longer"):
        find_unexpired(store, "uploads/1", made.name)


def test_a_name_that_is_none_is_not_looked_for(store) -> None:
    written(store, "uploads/1/x")
    with pytest.raises(NotFoundError, match="no object 'x' in uploads/1"):
        find_unexpired(store, "uploads/1", "x")


def test_a_key_says_when_it_expires() -> None:
    assert expiry_of(expiring_key("uploads/1", NOW).rpartition("/")[2]) == NOW
