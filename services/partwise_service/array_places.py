"""Places for what waits for the array store: fewer than there are threads.

A store that hangs then holds up what shows shapes, and leaves threads to those who claim, stroke and say that they are
still there.
"""

from collections.abc import AsyncIterator, Callable, Iterator
from functools import partial
from typing import TypeVar

from anyio import CapacityLimiter
from anyio.lowlevel import RunVar
from anyio.to_thread import current_default_thread_limiter, run_sync

Made = TypeVar("Made")
_PLACES: RunVar[CapacityLimiter] = RunVar("places of what waits for the array store")


async def in_array_place(make: Callable[[], Made]) -> Made:
    """What `make` makes, on a thread, as soon as there is a place."""
    async with _places():
        return await run_sync(make)


async def in_array_places(pieces: Iterator[Made]) -> AsyncIterator[Made]:
    """The pieces, each as soon as there is a place: none is held while the last one is on its way."""
    while (piece := await in_array_place(partial(next, pieces, None))) is not None:
        yield piece


def _places() -> CapacityLimiter:
    """Those of this event loop: two thirds of its threads, and at least one."""
    found = _PLACES.get(None)
    if found is None:
        found = CapacityLimiter(max(1, int(2 * current_default_thread_limiter().total_tokens / 3)))
        _PLACES.set(found)
    return found
