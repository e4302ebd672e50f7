"""The stream of events: in order, from where the client was, of what it may see."""

import asyncio
import json
from datetime import UTC, datetime

import pytest

from partwise.store.records import Event, EventBounds, EventKind, NewEvent
from partwise_service.event_stream import HEARTBEAT_TURNS, PAGE, event_stream
from partwise_service.routes.events import is_still_good
from partwise_service.security.identity import Identity
from partwise_service.settings import ServiceSettings


@pytest.fixture
def settings(mugs) -> ServiceSettings:
    """Streams that end once they have told what there is."""
    return ServiceSettings(workspace=mugs.path, event_stream_s=0.0)


def _events(text: str) -> list[tuple[int, str, dict]]:
    """(id, kind, data) of each event in a stream."""
    found = []
    for block in text.split("\n\n"):
        lines = dict(line.split(": ", 1) for line in block.splitlines() if not line.startswith(":"))
        if "id" in lines:
            found.append((int(lines["id"]), lines["event"], json.loads(lines["data"])))
    return found


def _add(workspace, collection_id: int | None, n: int) -> int:
    return workspace.catalog.add_event(NewEvent(EventKind.STAGE, collection_id, {"n": n})).id


def _numbers(answer) -> list[int]:
    return [data["payload"]["n"] for _, kind, data in _events(answer.text) if kind == "stage"]


def test_a_stream_begins_now(annotator, workspace, mugs) -> None:
    last = _add(workspace, mugs.collection_id, 1)
    answer = annotator.get("/events")
    assert answer.headers["content-type"].startswith("text/event-stream")
    assert _events(answer.text) == [(last, "begin", {})]


@pytest.mark.parametrize("how", ["header", "query"])
def test_it_resumes_after_the_last_id(annotator, workspace, mugs, how) -> None:
    first = _add(workspace, mugs.collection_id, 1)
    _add(workspace, mugs.collection_id, 2)
    given = {"headers": {"Last-Event-ID": str(first)}} if how == "header" else {"params": {"after": first}}
    assert _numbers(annotator.get("/events", **given)) == [2]


def test_other_collections_are_not_told_of(annotator, admin, workspace, mugs) -> None:
    first = _add(workspace, mugs.collection_id, 0)
    _add(workspace, mugs.other_id, 1)
    _add(workspace, None, 2)
    _add(workspace, mugs.collection_id, 3)
    told = {"headers": {"Last-Event-ID": str(first)}}
    assert _numbers(annotator.get("/events", **told)) == [2, 3]
    assert _numbers(admin.get("/events", **told)) == [1, 2, 3]


def test_a_claim_is_told(annotator, mugs) -> None:
    first = _events(annotator.get("/events").text)[0][0]
    annotator.post("/queue/claim", json={"collection_id": mugs.collection_id})
    told = _events(annotator.get("/events", params={"after": first}).text)
    assert [(kind, data["payload"]["what"]) for _, kind, data in told[1:]] == [("queue", "claimed")]


def test_who_missed_forgotten_events_is_told_to_begin_anew(annotator, workspace, mugs) -> None:
    first = _add(workspace, mugs.collection_id, 1)
    _add(workspace, mugs.collection_id, 2)
    workspace.catalog.prune_events(datetime.now(UTC))
    last = _add(workspace, mugs.collection_id, 3)
    assert _events(annotator.get("/events", params={"after": first}).text)[0] == (last, "missed", {})


@pytest.mark.parametrize("unknown", ["999", "x", "-1", "9" * 30])
def test_who_names_an_event_that_never_was_is_told_to_begin_anew(annotator, workspace, mugs, unknown) -> None:
    last = _add(workspace, mugs.collection_id, 1)
    answer = annotator.get("/events", headers={"Last-Event-ID": unknown})
    assert _events(answer.text) == [(last, "missed", {})]


def test_strangers_hear_nothing(nobody) -> None:
    assert nobody.get("/events").status_code == 401


def test_a_stream_ends_with_its_token(annotator, workspace) -> None:
    token = workspace.catalog.authenticate(annotator.secret)
    assert is_still_good(workspace.catalog, Identity(token))
    workspace.catalog.revoke_token(token.id, "test")
    assert not is_still_good(workspace.catalog, Identity(token))


def _streamed(stored: list[Event], n_turns: int, after: int | None = 0) -> list[str]:
    """What a stream over these events says in so many turns."""

    async def collect() -> list[str]:
        left = n_turns

        async def bounds() -> EventBounds:
            return EventBounds(stored[0].id, stored[-1].id) if stored else EventBounds(0, 0)

        async def read(last: int) -> list[Event]:
            return [event for event in stored if event.id > last][:PAGE]

        async def go_on() -> bool:
            nonlocal left
            left -= 1
            return left > 0

        return [piece async for piece in event_stream(bounds, read, go_on, after)]

    return asyncio.run(collect())


def _event(event_id: int) -> Event:
    return Event(event_id, datetime(2026, 1, 1, tzinfo=UTC), EventKind.JOB, None, {"line": "a\nb"})


def test_silence_is_broken_now_and_then() -> None:
    pieces = _streamed([], 2 * HEARTBEAT_TURNS)
    assert [piece.startswith(":") for piece in pieces] == [False, True, True]


def test_more_than_a_page_comes_without_waiting() -> None:
    told = _events("".join(_streamed([_event(n) for n in range(1, PAGE + 3)], 1)))
    assert [event_id for event_id, _, _ in told] == [0, *range(1, PAGE + 3)]


def test_an_event_is_one_line_of_data_whatever_it_holds() -> None:
    assert _streamed([_event(1)], 1)[1].count("\n") == 4
