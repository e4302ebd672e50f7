"""`ZarrArrayStore`: the array store on a local folder or any fsspec URL."""

import hashlib
import zlib
from collections import OrderedDict
from collections.abc import Callable, Iterator, Mapping, Sequence
from collections.abc import Set as AbstractSet
from contextlib import contextmanager
from datetime import datetime, timedelta
from threading import Lock

import numpy as np
from safetensors.numpy import load, save
from zarr.abc.store import Store

from partwise.errors import ParameterError, PartwiseError, StoreError
from partwise.store.array_store import BlockAddress
from partwise.store.blocks import BlockKind
from partwise.store.keys import BLOCKS, STAGING, block_time, checked_block_name, checked_key, new_block_name
from partwise.store.objects import Objects
from partwise.store.zarr_blocks import CompleteStore, OpenBlock, combined_checksum, write_block

_OPEN_BLOCKS = 16
_CHECKSUM_BYTES = 4


class ZarrArrayStore:
    """Blocks through Zarr, plain objects beside them; get one from `partwise.store.open_arrays`. Threads may share it.

    `where` names the store in messages. See `ArrayStore` for what methods do.
    """

    def __init__(self, objects: Objects, zarr_store: Store, where: str, clock: Callable[[], datetime]) -> None:
        self._objects = objects
        self._zarr = CompleteStore(zarr_store)
        self._where = where
        self._clock = clock
        self._open: OrderedDict[str, OpenBlock] = OrderedDict()
        self._lock = Lock()

    # Blocks

    def write_block(self, kind: BlockKind, shapes: Sequence[Mapping[str, np.ndarray]]) -> BlockAddress:
        name = new_block_name(kind.name, self._clock())
        try:
            n_bytes, checksum = write_block(kind, shapes, lambda key, data: self._objects.put(f"{name}/{key}", data))
        except BaseException:
            self._forget_half(name)
            raise
        return BlockAddress(name, len(shapes), n_bytes, checksum)

    def _forget_half(self, name: str) -> None:
        """Free what a failed write took, if the store still answers; otherwise `gc` sweeps it as an orphan."""
        try:
            self._objects.delete_folder(name)
        except StoreError:
            return

    def read(self, block_name: str, row: int, quantity: str) -> np.ndarray:
        with self._reading(block_name):
            return self._opened(block_name).read(row, quantity)

    def read_many(self, block_name: str, row: int, quantities: Sequence[str]) -> Mapping[str, np.ndarray]:
        with self._reading(block_name):
            block = self._opened(block_name)
            return {quantity: block.read(row, quantity) for quantity in quantities}

    def verify(self, address: BlockAddress) -> None:
        digests = {}
        for key in self._objects.keys(checked_block_name(address.name)):
            data = self._objects.get(key)
            digests[key.removeprefix(f"{address.name}/")] = (len(data), hashlib.sha256(data).hexdigest())
        if combined_checksum(digests) != address.checksum:
            raise StoreError(
                f"block {address.name} must have checksum {address.checksum[:12]}… but what is stored at {self._where} "
                "differs; run `partwise retry --lost`, then preprocess"
            )

    def block_names(self) -> Sequence[str]:
        names = []
        for kind in self._objects.folders(BLOCKS):
            names += [f"{BLOCKS}/{kind}/{last}" for last in self._objects.folders(f"{BLOCKS}/{kind}")]
        return sorted(names)

    def orphans(self, visible: AbstractSet[str], older_than: timedelta) -> Sequence[str]:
        limit = self._clock() - older_than
        return [name for name in self.block_names() if name not in visible and block_time(name) < limit]

    def delete_block(self, name: str) -> None:
        self._objects.delete_folder(checked_block_name(name))
        with self._lock:
            self._open.pop(name, None)

    def sweep_unfinished(self, older_than: timedelta) -> int:
        return self._objects.sweep_unfinished(self._clock() - older_than)

    # Plain objects

    def put_bytes(self, key: str, data: bytes) -> None:
        self._objects.put(_plain(key), data)

    def get_bytes(self, key: str) -> bytes:
        return self._objects.get(_plain(key))

    def exists(self, key: str) -> bool:
        return self._objects.exists(_plain(key))

    def delete(self, key: str) -> None:
        self._objects.delete(_plain(key))

    def list(self, prefix: str) -> Sequence[str]:
        return self._objects.keys(checked_key(prefix))

    # Staging

    def stage(self, key: str, arrays: Mapping[str, np.ndarray]) -> None:
        # safetensors writes an array's memory as it lies, so that a strided or swapped one would come back scrambled
        plain = {
            name: np.array(array, order="C", dtype=array.dtype.newbyteorder("<")) for name, array in arrays.items()
        }
        data = save(plain)
        self._objects.put_unsynced(_staged(key), data + _checksum(data))

    def read_staged(self, key: str) -> Mapping[str, np.ndarray]:
        stored = memoryview(self._objects.get(_staged(key)))
        data, checksum = stored[:-_CHECKSUM_BYTES], stored[-_CHECKSUM_BYTES:]
        if checksum != _checksum(data):
            raise StoreError(f"staged {key} must be as it was written but is damaged; preprocess its shape again")
        return load(bytes(data))

    def staged_keys(self, prefix: str = "") -> Sequence[str]:
        folder = _staged(prefix) if prefix else STAGING
        return [key.removeprefix(f"{STAGING}/") for key in self._objects.keys(folder)]

    def delete_staged(self, key: str) -> None:
        self._objects.delete(_staged(key))

    def delete_staged_many(self, keys: Sequence[str]) -> None:
        self._objects.delete_many([_staged(key) for key in keys])

    # Open blocks

    def _opened(self, name: str) -> OpenBlock:
        """The block, opened once while it is among the last few used: opening costs several reads."""
        with self._lock:
            if name in self._open:
                self._open.move_to_end(name)
                return self._open[name]
        block = OpenBlock(self._zarr, checked_block_name(name))
        with self._lock:
            self._open[name] = block
            while len(self._open) > _OPEN_BLOCKS:
                self._open.popitem(last=False)
        return block

    @contextmanager
    def _reading(self, name: str) -> Iterator[None]:
        """Whatever Zarr, a codec or a driver raises about a block: it is damaged, gone or out of reach."""
        try:
            yield
        except PartwiseError:
            raise
        except Exception as error:
            reason = next(iter(str(error).strip().splitlines()), type(error).__name__)
            raise StoreError(
                f"block {name} in the array store at {self._where} cannot be read ({reason}); is the store reachable? "
                "If so, delete the block and preprocess its shapes again"
            ) from error


def _plain(key: str) -> str:
    """A key outside blocks and staging, which have rules of their own."""
    if checked_key(key).split("/")[0] in (BLOCKS, STAGING):
        raise ParameterError(f"a plain object's key must not be under {BLOCKS}/ or {STAGING}/ but is {key!r}")
    return key


def _staged(key: str) -> str:
    return checked_key(f"{STAGING}/{key}")


def _checksum(data: bytes | memoryview) -> bytes:
    """Of a staged object, which is not synced: a machine that went down may have kept some of its pages only."""
    return zlib.crc32(data).to_bytes(_CHECKSUM_BYTES, "little")
