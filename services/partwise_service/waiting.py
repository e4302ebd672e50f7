"""Waiting for the tools' processes on behalf of a request: no longer than its client waits, and never on a thread."""

import asyncio
from collections.abc import Callable
from functools import partial

import numpy as np
from fastapi import Request, Response
from jaxtyping import UInt16

from partwise.workspace.confirming import DraftWork
from partwise_service.array_places import in_array_place
from partwise_service.problems import ProblemError, ProblemKind
from partwise_service.service import Service
from partwise_service.tool_calls import DraftLog, LabelsCall, ToolCall
from partwise_service.tool_pool import ToolPool


async def unless_gone(request: Request, tools: ToolPool, call: ToolCall, person_id: int) -> np.ndarray:
    """The result, unless the client goes away first: then the call is dropped and whatever is answered goes nowhere."""
    running = asyncio.ensure_future(tools.run(call, person_id))
    gone = asyncio.ensure_future(_disconnected(request))
    try:
        await asyncio.wait((running, gone), return_when=asyncio.FIRST_COMPLETED)
        if not running.done():
            raise ProblemError(ProblemKind.UNAVAILABLE, "The client went away, so the tool was not run.")
        return running.result()
    finally:
        running.cancel()
        gone.cancel()


async def _disconnected(request: Request) -> None:
    while (await request.receive())["type"] != "http.disconnect":
        pass


async def with_draft_labels(
    request: Request,
    service: Service,
    person_id: int,
    read: Callable[[], DraftWork | Response],
    answer: Callable[[DraftWork, UInt16[np.ndarray, " m"]], Response],
) -> Response:
    """The answer that a draft and the labels (m,) that its strokes leave make, or what reading it answers instead.

    Both functions run on a thread. So does replaying, on the same visit, if it is quick; else it runs in a
    process for such: a single stroke of many seeds may take minutes.

    Problems: as `ToolPool.run`; 429 if too many drafts of this person's are being read.
    """

    def begin() -> DraftWork | Response:
        found = read()
        if isinstance(found, DraftWork) and found.is_quickly_replayed:
            return answer(found, found.replayed())
        return found

    with service.replays.one_more(person_id):
        found = await in_array_place(begin)
        if isinstance(found, Response):
            return found
        call = LabelsCall(found.stored, DraftLog(found.base_labels, found.log))
        labels = await unless_gone(request, service.replaying, call, person_id)
        return await in_array_place(partial(answer, found, labels))
