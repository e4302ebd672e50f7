"""Arrays of many shapes as one: checked against the block's kind, and cut into shards without joining them all."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from partwise.errors import ParameterError
from partwise.store.blocks import BlockKind, Domain, Quantity

CHUNK_ROWS = 4_096
"""Faces or vertices in an inner chunk: what a read fetches at least."""
_CHUNKS_PER_SHARD = 128
_MIN_ROW_CHUNK_BYTES = 4_096  # a shape's row this large is a chunk of its own


@dataclass(frozen=True, slots=True, eq=False)
class Ragged:
    """One quantity of all shapes of a block; rows `ptr[i]` to `ptr[i + 1]` are shape i's. ptr is (n + 1,) int64."""

    quantity: Quantity
    pieces: Sequence[np.ndarray]
    ptr: np.ndarray

    @property
    def shape(self) -> tuple[int, ...]:
        return (int(self.ptr[-1]), *self.pieces[0].shape[1:])

    @property
    def chunk_rows(self) -> int:
        if self.quantity.domain != Domain.SHAPE:
            return CHUNK_ROWS
        row_bytes = self.pieces[0].nbytes
        return 1 if row_bytes >= _MIN_ROW_CHUNK_BYTES else len(self.pieces)

    @property
    def shard_rows(self) -> int:
        """Rows of a shard: whole chunks, no more than the array needs."""
        n_chunks = -(-self.shape[0] // self.chunk_rows)
        return self.chunk_rows * max(1, min(_CHUNKS_PER_SHARD, n_chunks))

    def shards(self) -> Iterator[tuple[slice, np.ndarray]]:
        """The rows in runs of one shard, so that only one is joined in memory at a time."""
        for start in range(0, self.shape[0], self.shard_rows):
            stop = min(start + self.shard_rows, self.shape[0])
            first = int(np.searchsorted(self.ptr, start, side="right")) - 1
            last = int(np.searchsorted(self.ptr, stop, side="left"))
            rows = [self.pieces[i][max(start - self.ptr[i], 0) : stop - self.ptr[i]] for i in range(first, last)]
            yield slice(start, stop), np.concatenate(rows)


def ragged_quantities(kind: BlockKind, shapes: Sequence[Mapping[str, np.ndarray]]) -> list[Ragged]:
    """The arrays of each shape, quantity by quantity.

    Raises
    ------
    ParameterError : no shapes; a quantity missing or unknown; a wrong dtype, width, or number of rows.
    """
    if not shapes:
        raise ParameterError(f"a block of kind {kind.name!r} must hold at least one shape but holds none")
    wanted = {quantity.name for quantity in kind.quantities}
    for i, shape in enumerate(shapes):
        if set(shape) != wanted:
            odd = ", ".join(sorted(wanted ^ set(shape)))
            raise ParameterError(f"shape {i} of a {kind.name!r} block must have exactly its quantities; look at: {odd}")
    found = [_ragged(quantity, [shape[quantity.name] for shape in shapes]) for quantity in kind.quantities]
    _refuse_uneven(found)
    return found


def _ragged(quantity: Quantity, arrays: Sequence[np.ndarray]) -> Ragged:
    rows = [array[None] if quantity.domain == Domain.SHAPE else array for array in map(np.asarray, arrays)]
    width = tuple(
        rows[0].shape[1 + k] if extent is None and rows[0].ndim > 1 + k else extent
        for k, extent in enumerate(quantity.width)
    )
    for i, array in enumerate(rows):
        is_empty = array.size == 0 and not quantity.domain.may_be_empty
        if array.dtype != np.dtype(quantity.dtype) or array.ndim < 1 or array.shape[1:] != width or is_empty:
            raise ParameterError(
                f"{quantity.name} must be {quantity.dtype} rows of shape {width} but that of shape {i} is "
                f"{array.dtype} of shape {array.shape}"
            )
    ptr = np.concatenate(([0], np.cumsum([len(array) for array in rows], dtype=np.int64)))
    return Ragged(quantity, rows, ptr)


def _refuse_uneven(found: Sequence[Ragged]) -> None:
    """All face quantities of a shape have as many rows as it has faces; likewise for vertices."""
    by_domain: dict[Domain, Ragged] = {}
    for ragged in found:
        first = by_domain.setdefault(ragged.quantity.domain, ragged)
        if not np.array_equal(first.ptr, ragged.ptr):
            i = int(np.argmax(np.diff(first.ptr) != np.diff(ragged.ptr)))
            raise ParameterError(
                f"shape {i} must have one number of {first.quantity.domain} rows but has {len(first.pieces[i])} in "
                f"{first.quantity.name} and {len(ragged.pieces[i])} in {ragged.quantity.name}; are they of one mesh?"
            )
