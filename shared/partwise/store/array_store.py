"""`ArrayStore`: arrays that a machine can make again, in write-once blocks, beside plain objects and staging.

A block holds the arrays of many shapes, one ragged array per quantity. Writing a block shows nothing to anybody: it
becomes visible when its name is committed to the catalog, and one that never is becomes an orphan for `gc`. Keys and
names are relative, made of letters, digits, `.`, `_`, `-` and `/`. Methods raise `StoreError` when the store cannot be
reached, is full, or holds something damaged, and `NotFoundError` for an object that is not there.
"""

from collections.abc import Mapping, Sequence
from collections.abc import Set as AbstractSet
from dataclasses import dataclass
from datetime import timedelta
from typing import Protocol

import numpy as np

from partwise.store.blocks import BlockKind


@dataclass(frozen=True, slots=True)
class BlockAddress:
    """A block as written: its unique name, its size as stored, the SHA-256 (hex) over all of its objects."""

    name: str
    n_shapes: int
    n_bytes: int
    checksum: str


class ArrayStore(Protocol):
    def write_block(self, kind: BlockKind, shapes: Sequence[Mapping[str, np.ndarray]]) -> BlockAddress:
        """Write the arrays of each shape under a fresh name `blocks/<kind>/<uuid>`; row i is shape i.

        Raises `ParameterError` if there are no shapes, or a shape lacks a quantity, has one too many, or has one of
        another dtype, width or row count than its kind and its other quantities say.
        """
        ...

    def read(self, block_name: str, row: int, quantity: str) -> np.ndarray:
        """One quantity of one shape, reading little more than its own rows."""
        ...

    def read_many(self, block_name: str, row: int, quantities: Sequence[str]) -> Mapping[str, np.ndarray]:
        """Several quantities of one shape."""
        ...

    def verify(self, address: BlockAddress) -> None:
        """Read the whole block and raise `StoreError` unless it is as it was written."""
        ...

    def block_names(self) -> Sequence[str]:
        """Every block in the store, visible or not, sorted."""
        ...

    def orphans(self, visible: AbstractSet[str], older_than: timedelta) -> Sequence[str]:
        """Blocks that are not visible and whose writing began longer ago than the grace given."""
        ...

    def delete_block(self, name: str) -> None:
        """Delete a block; nothing happens if it is not there."""
        ...

    def sweep_unfinished(self, older_than: timedelta) -> int:
        """Delete what writes that were killed longer ago than this left outside every listing; returns how many."""
        ...

    def put_bytes(self, key: str, data: bytes) -> None:
        """Write an object: afterwards it is there whole and durable; on error the previous state remains."""
        ...

    def get_bytes(self, key: str) -> bytes: ...

    def exists(self, key: str) -> bool: ...

    def delete(self, key: str) -> None:
        """Delete an object; nothing happens if it is not there."""
        ...

    def list(self, prefix: str) -> Sequence[str]:
        """Keys of the objects in the folder `prefix` and below, sorted."""
        ...

    def stage(self, key: str, arrays: Mapping[str, np.ndarray]) -> None:
        """Put named arrays into staging as one object, replacing what was there.

        It outlasts this process but perhaps not this machine: what it holds can be computed again.
        """
        ...

    def read_staged(self, key: str) -> Mapping[str, np.ndarray]:
        """What was staged; `StoreError` if the object is not as it was written."""
        ...

    def staged_keys(self, prefix: str = "") -> Sequence[str]:
        """Keys in staging, of a folder if given, sorted."""
        ...

    def delete_staged(self, key: str) -> None: ...

    def delete_staged_many(self, keys: Sequence[str]) -> None:
        """Delete many in as few requests as the store needs; those that are not there are no matter."""
        ...
