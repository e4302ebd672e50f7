"""/events: changes in the queue, training, stages, jobs, people and shapes, pushed to open pages."""

import time
from collections.abc import AsyncIterator, Sequence
from dataclasses import replace
from datetime import UTC, datetime
from typing import Annotated, Any

from anyio.to_thread import run_sync
from fastapi import APIRouter, Depends, Header, Query, Request
from fastapi.responses import StreamingResponse

from partwise.store.catalog import Catalog
from partwise.store.records import Event, EventKind, Role
from partwise_service.answering import AnswerRoute
from partwise_service.dependencies import Caller, CatalogDep, ServiceDep
from partwise_service.event_hub import POLL_S, Listener
from partwise_service.event_stream import event_stream
from partwise_service.security.identity import Identity

CHECK_S = 30.0
MAX_EVENT_ID = 2**53
_ID_DIGITS = 15
router = APIRouter(route_class=AnswerRoute, tags=["events"])
EVENT_STREAM = "text/event-stream"
_EVENT = {
    "type": "object",
    "properties": {
        "id": {"type": "string", "description": "To resume from."},
        "event": {"type": "string", "enum": ["begin", "missed", *(kind.value for kind in EventKind)]},
        "data": {"type": "string", "description": "A JSON object: `at`, `collection_id` and `payload`, or empty."},
        "retry": {"type": "integer"},
    },
    "required": ["id", "event", "data"],
}
_RESPONSES: dict[int | str, dict[str, Any]] = {
    200: {"content": {EVENT_STREAM: {"schema": _EVENT}}, "description": "Events until the client goes."}
}
LastId = Annotated[str | None, Header(description="The last id that the client has.")]
AfterId = Annotated[int | None, Query(ge=0, le=MAX_EVENT_ID, description="The same, for clients without the header.")]


async def stream_place(caller: Caller, service: ServiceDep) -> AsyncIterator[None]:
    """One of the streams that a token may have open, until it ends. Problems: 429 if it has as many."""
    with service.streams.one_more(caller.token.id):
        yield


@router.get("/events", dependencies=[Depends(stream_place)], responses=_RESPONSES, response_class=StreamingResponse)
async def stream_events(
    request: Request,
    caller: Caller,
    service: ServiceDep,
    catalog: CatalogDep,
    last_event_id: LastId = None,
    after: AfterId = None,
) -> StreamingResponse:
    """Server-sent events of the collections that the caller may see, after `Last-Event-ID`, or from now on.

    The first is `begin`, or `missed` if some since then are forgotten: then read everything anew.
    """
    hub = service.events
    begun = checked = time.monotonic()

    async def go_on() -> bool:
        nonlocal checked
        if time.monotonic() - begun >= service.settings.event_stream_s:
            return False
        await hub.news(POLL_S)
        if time.monotonic() - checked >= CHECK_S:
            checked = time.monotonic()
            if not await run_sync(lambda: is_still_good(catalog, caller)):
                return False
        return not await request.is_disconnected()

    async def told() -> AsyncIterator[str]:
        listener = Listener(hub, catalog, caller.token.scope)

        async def read(last: int) -> Sequence[Event]:
            found = await listener.read(last)
            return [as_told(event, caller) for event in found if not event.is_revocation]

        async for piece in event_stream(lambda: run_sync(catalog.event_bounds), read, go_on, resumed):
            yield piece

    resumed = after if last_event_id is None else _event_id(last_event_id)
    return StreamingResponse(told(), media_type=EVENT_STREAM, headers={"X-Accel-Buffering": "no"})


def as_told(event: Event, caller: Identity) -> Event:
    """Who does what is for themselves and for operators to know: others hear which shape it is about, and no more."""
    if event.payload.get("person_id") in (None, caller.person_id) or caller.role.includes(Role.OPERATOR):
        return event
    return replace(event, payload={name: event.payload[name] for name in ("shape_id",) if name in event.payload})


def is_still_good(catalog: Catalog, caller: Identity) -> bool:
    """Whether the token that opened a stream has neither ended nor been revoked since."""
    token = catalog.token(caller.token.id)
    return token.revoked_at is None and token.expires_at > datetime.now(UTC)


def _event_id(text: str) -> int:
    """The id that a client resumes from; one that this service never gave is beyond all, so they begin anew."""
    is_id = text.isascii() and text.isdigit() and len(text) <= _ID_DIGITS
    return int(text) if is_id else MAX_EVENT_ID
