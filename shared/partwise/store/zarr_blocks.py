"""A block as a Zarr v3 group: one sharded array per quantity, a pointer array per domain, a listing in its attributes.

Shards hold chunks of 4,096 rows, each compressed by itself, so that one shape is a ranged read. The group's metadata is
written last: without it there is no block. Every chunk carries a checksum.
"""

import hashlib
from collections.abc import Callable, Mapping, Sequence
from typing import Any

import numpy as np
import zarr
from zarr.abc.store import ByteRequest, RangeByteRequest, Store, SuffixByteRequest
from zarr.codecs import Crc32cCodec, ZstdCodec
from zarr.core.buffer import Buffer, BufferPrototype
from zarr.storage import MemoryStore, StorePath, WrapperStore

from partwise.errors import NotFoundError, StoreError
from partwise.store.blocks import BlockKind, Domain
from partwise.store.ragged import Ragged, ragged_quantities

_ZSTD_LEVEL = 3
_ATTRIBUTE = "partwise"


class CompleteStore(WrapperStore[Store]):
    """A Zarr store in which an absent or short object is an error, where Zarr by itself would read zeros.

    Every shard of a block is written, even one of zeros, so nothing is ever rightly absent.
    """

    async def get(self, key: str, prototype: BufferPrototype, byte_range: ByteRequest | None = None) -> Buffer | None:
        found = await super().get(key, prototype, byte_range)
        if found is None:
            raise StoreError(f"the array store must hold {key} but does not; was its block deleted? Preprocess again")
        if len(found) < _wanted_bytes(byte_range):
            raise StoreError(
                f"the array store must hold {_wanted_bytes(byte_range)} bytes of {key} where it holds {len(found)}; "
                "delete its block and preprocess again"
            )
        return found


def _wanted_bytes(byte_range: ByteRequest | None) -> int:
    """How many bytes a complete answer has at least."""
    if isinstance(byte_range, RangeByteRequest):
        return byte_range.end - byte_range.start
    return byte_range.suffix if isinstance(byte_range, SuffixByteRequest) else 1


def write_block(
    kind: BlockKind, shapes: Sequence[Mapping[str, np.ndarray]], put: Callable[[str, bytes], None]
) -> tuple[int, str]:
    """Hand the block's objects, by key within the block, to `put`; returns their bytes in all and their checksum."""
    ragged = ragged_quantities(kind, shapes)
    digests: dict[str, tuple[int, str]] = {}

    def keep(store: MemoryStore) -> None:
        for key, buffer in sorted(store._store_dict.items()):
            data = buffer.to_bytes()
            put(key, data)
            digests[key] = (len(data), hashlib.sha256(data).hexdigest())

    for pointer_name, ptr in _pointers(ragged).items():
        store = MemoryStore()
        zarr.create_array(store, name=pointer_name, data=ptr, chunks=ptr.shape, config={"write_empty_chunks": True})
        keep(_without_root(store))
    for quantity in ragged:
        keep(_without_root(_encoded(quantity)))
    store = MemoryStore()
    attributes = {
        "kind": kind.name,
        "n_shapes": len(shapes),
        "domains": {quantity.name: quantity.domain.value for quantity in kind.quantities},
    }
    zarr.create_group(store, attributes={_ATTRIBUTE: attributes})
    keep(store)
    return sum(size for size, _ in digests.values()), combined_checksum(digests)


def _pointers(ragged: Sequence[Ragged]) -> dict[str, np.ndarray]:
    """One pointer array for each domain, shared by its quantities; a shape's row needs none."""
    return {f"{each.quantity.domain}_ptr": each.ptr for each in ragged if each.quantity.domain != Domain.SHAPE}


def _encoded(ragged: Ragged) -> MemoryStore:
    store = MemoryStore()
    array = zarr.create_array(
        store,
        name=ragged.quantity.name,
        shape=ragged.shape,
        dtype=ragged.quantity.dtype,
        chunks=(ragged.chunk_rows, *ragged.shape[1:]),
        shards=(ragged.shard_rows, *ragged.shape[1:]),
        compressors=[ZstdCodec(level=_ZSTD_LEVEL), Crc32cCodec()],
        fill_value=0,
        config={"write_empty_chunks": True},
    )
    for rows, values in ragged.shards():
        array[rows] = values
    return store


def _without_root(store: MemoryStore) -> MemoryStore:
    """Leave out the group that Zarr makes around a named array: the block's own comes last."""
    store._store_dict.pop("zarr.json", None)
    return store


def combined_checksum(digests: Mapping[str, tuple[int, str]]) -> str:
    """SHA-256 (hex) over key, size and SHA-256 of each object, in order of their keys."""
    lines = [f"{key} {size} {digest}\n" for key, (size, digest) in sorted(digests.items())]
    return hashlib.sha256("".join(lines).encode()).hexdigest()


class OpenBlock:
    """A block opened for reading. Keeps the metadata it has read, so that the next read fetches only rows."""

    def __init__(self, store: Store, name: str) -> None:
        self._store = store
        self._name = name
        attributes: Any = zarr.open_group(StorePath(store, name), mode="r", zarr_format=3).attrs[_ATTRIBUTE]
        self.kind: str = attributes["kind"]
        self.n_shapes: int = attributes["n_shapes"]
        self._domains = {quantity: Domain(domain) for quantity, domain in attributes["domains"].items()}
        self._arrays: dict[str, zarr.Array[Any]] = {}
        self._pointers: dict[Domain, np.ndarray] = {}

    def read(self, row: int, quantity: str) -> np.ndarray:
        """One shape's rows of a quantity; a shape's own row for the shape domain."""
        if quantity not in self._domains:
            known = ", ".join(self._domains)
            raise NotFoundError(f"block {self._name} ({self.kind}) has no quantity {quantity!r}; it has {known}")
        if not 0 <= row < self.n_shapes:
            raise NotFoundError(f"a row must be 0 to {self.n_shapes - 1} in block {self._name} but is {row}")
        domain = self._domains[quantity]
        if domain == Domain.SHAPE:
            return np.asarray(self._array(quantity)[row])
        ptr = self._pointer(domain)
        return np.asarray(self._array(quantity)[int(ptr[row]) : int(ptr[row + 1])])

    def _array(self, name: str) -> "zarr.Array[Any]":
        if name not in self._arrays:
            path = StorePath(self._store, f"{self._name}/{name}")
            self._arrays[name] = zarr.open_array(path, mode="r", zarr_format=3)
        return self._arrays[name]

    def _pointer(self, domain: Domain) -> np.ndarray:
        if domain not in self._pointers:
            self._pointers[domain] = np.asarray(self._array(f"{domain}_ptr")[:])
        return self._pointers[domain]
