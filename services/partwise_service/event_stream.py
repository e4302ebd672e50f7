"""Catalog events as a stream of server-sent events."""

import json
from collections.abc import AsyncIterator, Awaitable, Callable, Sequence

from partwise.store.records import Event, EventBounds
from partwise_service.event_hub import PAGE

HEARTBEAT_TURNS = 15
RECONNECT_MS = 2_000


async def event_stream(
    bounds: Callable[[], Awaitable[EventBounds]],
    read: Callable[[int], Awaitable[Sequence[Event]]],
    go_on: Callable[[], Awaitable[bool]],
    after: int | None,
) -> AsyncIterator[str]:
    """Events after an id, as they come; a comment now and then, so that neither side mistakes silence for an end.

    It begins with `begin`, which carries the id to resume from, or with `missed` if events since `after` were
    forgotten and the client must read everything anew.

    Parameters
    ----------
    read : the next events after an id; what is left is read in the next turn, which comes at once after `PAGE` of them.
    go_on : waits for the next turn; False ends the stream.
    after : the last id that the client has; None for what comes from now on.
    """
    known = await bounds()
    has_missed = after is not None and (after < known.oldest - 1 or after > known.newest)
    last = known.newest if after is None or has_missed else after
    yield f"retry: {RECONNECT_MS}\n{formatted(last, 'missed' if has_missed else 'begin', {})}"
    n_silent = 0
    while True:
        found = await read(last)
        for event in found:
            yield formatted(event.id, event.kind.value, _document(event))
        last = found[-1].id if found else last
        n_silent = 0 if found else n_silent + 1
        if n_silent >= HEARTBEAT_TURNS:
            yield ": nothing new\n\n"
            n_silent = 0
        if len(found) < PAGE and not await go_on():
            return


def formatted(event_id: int, kind: str, document: object) -> str:
    """One server-sent event."""
    return f"id: {event_id}\nevent: {kind}\ndata: {json.dumps(document, separators=(',', ':'))}\n\n"


def _document(event: Event) -> dict[str, object]:
    return {"at": event.at.isoformat(), "collection_id": event.collection_id, "payload": dict(event.payload)}
