"""Objects that are too large for memory, as chunks in the array store: written once, read from front to back.

The chunks lie below the object's key, and beside them `whole.json`, which is written last: without it the object is
not there, whatever a writer that was killed has left. Keys name when the object expires: `<folder>/<time>-<random>`.
"""

import hashlib
import json
import re
import secrets
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from datetime import UTC, datetime
from typing import Any

from partwise.errors import NotFoundError, StoreError
from partwise.store.array_store import ArrayStore

CHUNK_BYTES = 8 << 20
EXPIRING_NAME = r"[0-9]{8}T[0-9]{6}Z-[0-9a-f]{32}"
"""Regular expression of the last step of an expiring object's key."""
_WHOLE = "whole.json"
_TIME = "%Y%m%dT%H%M%SZ"


@dataclass(frozen=True, slots=True)
class LargeObject:
    """An object that is there whole. about : small JSON that its writer left. sha256 : of its bytes, in hexadecimal."""

    key: str
    n_bytes: int
    n_chunks: int
    sha256: str
    about: Mapping[str, Any]

    @property
    def name(self) -> str:
        """The last step of its key."""
        return self.key.rpartition("/")[2]

    @property
    def expires_at(self) -> datetime:
        """When it may be swept."""
        return expiry_of(self.name)


class LargeObjectWriter:
    """Takes bytes and stores each full chunk. Nothing is there until `finish`. `zipfile` can write to it."""

    def __init__(self, arrays: ArrayStore, key: str) -> None:
        self._arrays = arrays
        self._key = key
        self._pending = bytearray()
        self._hash = hashlib.sha256()
        self._n_bytes = 0
        self._n_chunks = 0

    def write(self, data: bytes) -> int:
        """Appends. StoreError if the store cannot take it."""
        self._pending += data
        self._hash.update(data)
        self._n_bytes += len(data)
        while len(self._pending) >= CHUNK_BYTES:
            self._store(bytes(self._pending[:CHUNK_BYTES]))
            del self._pending[:CHUNK_BYTES]
        return len(data)

    def flush(self) -> None:
        """Nothing: chunks are stored when they are full."""

    def finish(self, about: Mapping[str, Any]) -> LargeObject:
        """Makes the object appear."""
        if self._pending:
            self._store(bytes(self._pending))
            self._pending.clear()
        made = LargeObject(self._key, self._n_bytes, self._n_chunks, self._hash.hexdigest(), about)
        document = {"n_bytes": made.n_bytes, "n_chunks": made.n_chunks, "sha256": made.sha256, "about": dict(about)}
        self._arrays.put_bytes(f"{self._key}/{_WHOLE}", json.dumps(document).encode())
        return made

    def _store(self, chunk: bytes) -> None:
        self._arrays.put_bytes(_chunk_key(self._key, self._n_chunks), chunk)
        self._n_chunks += 1


def expiring_key(folder: str, expires_at: datetime) -> str:
    """A new key in the folder, for an object that expires then."""
    return f"{folder}/{expires_at.astimezone(UTC):{_TIME}}-{secrets.token_hex(16)}"


def expiry_of(name: str) -> datetime:
    """When an object of this name expires, to the second."""
    return datetime.strptime(name.partition("-")[0], _TIME).replace(tzinfo=UTC)


def find_large_object(arrays: ArrayStore, key: str) -> LargeObject:
    """The object under a key.

    Raises
    ------
    NotFoundError : it was never finished, or is gone. StoreError : what is there is damaged.
    """
    try:
        document = json.loads(arrays.get_bytes(f"{key}/{_WHOLE}"))
        return LargeObject(key, document["n_bytes"], document["n_chunks"], document["sha256"], document["about"])
    except (ValueError, KeyError, TypeError) as error:
        raise StoreError(f"{key}: an object's description must be as it was written but is damaged") from error


def find_unexpired(arrays: ArrayStore, folder: str, name: str) -> LargeObject:
    """The expiring object of this name directly in a folder. The name may be anything: it comes from outside.

    Raises
    ------
    NotFoundError : it names none, or one that was never finished, has expired or is gone. StoreError : it is damaged.
    """
    missing = NotFoundError(f"there is no object {name[:80]!a} in {folder}, or no longer; write it anew")
    if not re.fullmatch(EXPIRING_NAME, name):
        raise missing
    found = find_large_object(arrays, f"{folder}/{name}")
    if found.expires_at <= datetime.now(UTC):
        raise missing
    return found


def read_chunks(arrays: ArrayStore, found: LargeObject) -> Iterator[bytes]:
    """The object's bytes, a chunk at a time.

    Raises
    ------
    NotFoundError : it was deleted meanwhile. StoreError : at the end, unless the bytes are those that were written.
    """
    checksum = hashlib.sha256()
    for n in range(found.n_chunks):
        chunk = arrays.get_bytes(_chunk_key(found.key, n))
        checksum.update(chunk)
        yield chunk
    if checksum.hexdigest() != found.sha256:
        raise StoreError(f"{found.key}: an object must be as it was written but is damaged; write it anew")


def delete_large_object(arrays: ArrayStore, key: str) -> None:
    """Deletes it, or what was left of it."""
    arrays.delete(f"{key}/{_WHOLE}")
    for each in arrays.list(key):
        arrays.delete(each)


def large_object_keys(arrays: ArrayStore, folder: str) -> list[str]:
    """Keys of what is directly in a folder, finished or not, sorted: those that expire first come first."""
    return sorted({"/".join(key.split("/")[: folder.count("/") + 2]) for key in arrays.list(folder)})


def sweep_expired(arrays: ArrayStore, folder: str, now: datetime) -> list[str]:
    """Deletes what has expired directly in a folder; returns its keys."""
    expired = [key for key in large_object_keys(arrays, folder) if expiry_of(key.rpartition("/")[2]) < now]
    for key in expired:
        delete_large_object(arrays, key)
    return expired


def _chunk_key(key: str, n: int) -> str:
    return f"{key}/{n:06d}"
