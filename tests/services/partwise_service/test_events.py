"""The stream of events: in order, from where the client was, of what it may see."""

import asyncio
import json
from contextlib import ExitStack
from datetime import UTC, datetime, timedelta

import pytest
from anyio.to_thread import current_default_thread_limiter

from partwise.errors import StoreError
from partwise.store.records import REVOKED, Event, EventBounds, EventKind, NewEvent, Role
from partwise_service import event_hub
from partwise_service.event_hub import PAGE, EventHub, Listener
from partwise_service.event_stream import HEARTBEAT_TURNS, event_stream
from partwise_service.routes.events import is_still_good
from partwise_service.security.identity import Identity
from partwise_service.security.recent import RecentlyGood
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


def test_who_holds_a_shape_and_operators_hear_that_it_was_taken_away_others_only_which_shape(
    annotator, operator, issue, mugs
) -> None:
    other = issue("ben", Role.ANNOTATOR, (mugs.collection_id,))
    first = _events(annotator.get("/events").text)[0][0]
    lease = annotator.post("/queue/claim", json={"collection_id": mugs.collection_id}).json()["items"][0]
    operator.post(f"/leases/{lease['id']}/clear")

    def payloads(caller) -> list[dict]:
        told = _events(caller.get("/events", params={"after": first}).text)
        return [data["payload"] for _, kind, data in told if kind == "queue"]

    about = {"shape_id": lease["shape_id"]}
    full = [{**about, "person_id": lease["person_id"], "what": what} for what in ("claimed", "cleared")]
    assert payloads(annotator) == payloads(operator) == full
    assert payloads(other) == [about, about]


def test_streams_do_not_tell_that_somebody_logged_out(annotator, admin, workspace, mugs, issue) -> None:
    first = _add(workspace, mugs.collection_id, 0)
    workspace.catalog.revoke_token(workspace.catalog.authenticate(issue("ben", Role.ANNOTATOR, None).secret).id, "ben")
    _add(workspace, mugs.collection_id, 1)
    for caller in (annotator, admin):
        told = _events(caller.get("/events", params={"after": first}).text)
        assert [kind for _, kind, _ in told] == ["begin", "stage"]


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


def test_a_token_has_only_so_many_streams(annotator, reviewer, workspace, app, settings) -> None:
    token, streams = workspace.catalog.authenticate(annotator.secret), app.state.service.streams
    with ExitStack() as opened:
        for _ in range(settings.max_event_streams):
            opened.enter_context(streams.one_more(token.id))
        assert annotator.get("/events").status_code == 429
        assert reviewer.get("/events").status_code == 200


def test_a_stream_that_has_ended_counts_no_more(annotator, settings) -> None:
    answers = [annotator.get("/events").status_code for _ in range(settings.max_event_streams + 1)]
    assert set(answers) == {200}


def test_strangers_hear_nothing(nobody) -> None:
    assert nobody.get("/events").status_code == 401


def test_a_stream_ends_with_its_token(annotator, workspace) -> None:
    token = workspace.catalog.authenticate(annotator.secret)
    assert is_still_good(workspace.catalog, Identity(token))
    workspace.catalog.revoke_token(token.id, "test")
    assert not is_still_good(workspace.catalog, Identity(token))


class _CountingCatalog:
    """Events in memory, and how often they were asked for."""

    def __init__(self, *events: Event) -> None:
        self.stored = list(events)
        self.n_reads = 0
        self.pruned_before: list[datetime] = []

    def events(self, *, after: int, collection_ids=None, limit: int = 1000) -> list[Event]:
        self.n_reads += 1
        theirs = [e for e in self.stored if collection_ids is None or e.collection_id in (None, *collection_ids)]
        return [event for event in theirs if event.id > after][:limit]

    def event_bounds(self) -> EventBounds:
        return EventBounds(self.stored[0].id, self.stored[-1].id) if self.stored else EventBounds(0, 0)

    def prune_events(self, before: datetime, *, limit: int = 10_000) -> int:
        self.pruned_before.append(before)
        return 0

    def add(self, collection_id: int | None = None) -> int:
        event_id = self.stored[-1].id + 1 if self.stored else 1
        self.stored.append(Event(event_id, datetime(2026, 1, 1, tzinfo=UTC), EventKind.JOB, collection_id, {}))
        return event_id


def _hub(catalog: _CountingCatalog) -> EventHub:
    return EventHub(catalog, timedelta(hours=1), RecentlyGood(lambda: 0.0), lambda: 0.0)


def _ids(events) -> list[int]:
    return [event.id for event in events]


def test_events_are_read_once_for_all_streams() -> None:
    catalog = _CountingCatalog()

    async def listen() -> None:
        hub = _hub(catalog)
        await hub.begin_now()
        listeners = [Listener(hub, catalog, None) for _ in range(50)]
        assert [_ids(await each.read(0)) for each in listeners] == [[]] * 50
        before = catalog.n_reads
        catalog.add()
        await hub.read_on()
        assert [_ids(await each.read(0)) for each in listeners] == [[1]] * 50
        assert catalog.n_reads == before + 1
        assert [_ids(await each.read(1)) for each in listeners] == [[]] * 50

    asyncio.run(listen())


def test_a_stream_hears_of_its_collections_and_of_none() -> None:
    catalog = _CountingCatalog()

    async def listen() -> None:
        hub = _hub(catalog)
        await hub.begin_now()
        listener = Listener(hub, catalog, (7,))
        await listener.read(0)
        for collection_id in (7, 8, None):
            catalog.add(collection_id)
        await hub.read_on()
        assert _ids(await listener.read(0)) == [1, 3]

    asyncio.run(listen())


def test_a_stream_that_falls_behind_reads_on_from_the_catalog(monkeypatch) -> None:
    monkeypatch.setattr(event_hub, "MAX_RECENT", 2)
    catalog = _CountingCatalog()

    async def listen() -> None:
        hub = _hub(catalog)
        await hub.begin_now()
        listener = Listener(hub, catalog, (7,))
        await listener.read(0)
        for _ in range(3):
            catalog.add(7)
        catalog.add(8)
        await hub.read_on()
        before = catalog.n_reads
        assert _ids(await listener.read(0)) == [1, 2, 3]
        assert catalog.n_reads == before + 1
        assert _ids(await listener.read(3)) == []
        assert catalog.n_reads == before + 1

    asyncio.run(listen())


def test_nothing_is_missed_when_the_hub_begins_after_a_stream() -> None:
    catalog = _CountingCatalog()

    async def listen() -> None:
        hub = _hub(catalog)
        listener = Listener(hub, catalog, None)
        catalog.add()
        assert _ids(await listener.read(0)) == [1]
        catalog.add()
        await hub.begin_now()
        catalog.add()
        await hub.read_on()
        assert _ids(await listener.read(1)) == [2, 3]

    asyncio.run(listen())


@pytest.mark.parametrize("fault", [StoreError("the database is away"), RuntimeError("nobody thought of it")])
def test_a_reader_goes_on_where_it_was_when_the_catalog_was_away(monkeypatch, caplog, fault) -> None:
    monkeypatch.setattr(event_hub, "POLL_S", 0.0)
    catalog = _CountingCatalog()
    read = catalog.events

    left = [3]

    def away(**_given) -> list[Event]:
        left[0] -= 1
        if not left[0]:
            catalog.add()  # which must not be passed over
            catalog.events = read
        raise fault

    async def run() -> list[int]:
        async with _hub(catalog).running() as hub:
            while not catalog.n_reads:
                await asyncio.sleep(0.001)
            catalog.events = away
            while not hub.since(0):
                await hub.news(60)
            return _ids(hub.since(0))

    assert asyncio.run(run()) == [1]
    assert [record.getMessage() for record in caplog.records] == ["events cannot be read"]


def test_the_reader_hears_of_revocations(annotator, workspace) -> None:
    now = [1.0]
    catalog, recent = _CountingCatalog(), RecentlyGood(lambda: now[0])
    token = workspace.catalog.authenticate(annotator.secret)

    async def listen() -> None:
        hub = EventHub(catalog, timedelta(hours=1), recent, lambda: now[0])
        await hub.begin_now()
        now[0] = 2.0
        recent.remember(b"a", token, now[0])
        await hub.read_on()
        assert recent.trusted(b"a") == token
        catalog.stored.append(Event(1, datetime(2026, 1, 1, tzinfo=UTC), REVOKED.kind, None, dict(REVOKED.payload)))
        await hub.read_on()
        assert recent.trusted(b"a") is None

    asyncio.run(listen())


def test_what_was_looked_up_before_the_reader_began_is_not_trusted(annotator, workspace) -> None:
    catalog, recent = _CountingCatalog(), RecentlyGood(lambda: 1.0)

    async def listen() -> None:
        hub = EventHub(catalog, timedelta(hours=1), recent, lambda: 1.0)
        recent.remember(b"a", workspace.catalog.authenticate(annotator.secret), 0.5)
        await hub.begin_now()
        await hub.read_on()
        assert recent.trusted(b"a") is None

    asyncio.run(listen())


def test_the_reader_does_not_wait_for_busy_handlers() -> None:
    catalog = _CountingCatalog()

    async def read_while_busy() -> int:
        hub = _hub(catalog)
        limiter = current_default_thread_limiter()
        limiter.total_tokens = 1
        async with limiter:
            await hub.begin_now()
            catalog.add()
            return await asyncio.wait_for(hub.read_on(), 60)

    assert asyncio.run(read_while_busy()) == 1


def test_old_events_are_forgotten() -> None:
    catalog = _CountingCatalog()

    async def run() -> None:
        async with _hub(catalog).running():
            while not catalog.pruned_before:
                await asyncio.sleep(0.001)

    asyncio.run(run())
    age = datetime.now(UTC) - catalog.pruned_before[0]
    assert timedelta(minutes=59) < age < timedelta(minutes=61)


def test_who_waits_hears_of_news_at_once() -> None:
    catalog = _CountingCatalog()

    async def run() -> list[int]:
        async with _hub(catalog).running() as hub:
            listener = Listener(hub, catalog, None)
            await listener.read(0)
            catalog.add()
            found: list[Event] = []
            while not found:
                await hub.news(60)
                found = list(await listener.read(0))
            return _ids(found)

    assert asyncio.run(run()) == [1]


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
