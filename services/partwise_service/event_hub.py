"""`EventHub`: reads new events for all streams of the process, and forgets old ones."""

import asyncio
import logging
from collections import deque
from collections.abc import AsyncIterator, Callable, Sequence
from contextlib import asynccontextmanager, suppress
from datetime import UTC, datetime, timedelta

from anyio import CapacityLimiter
from anyio.to_thread import run_sync

from partwise.store.catalog import EventCatalog
from partwise.store.records import Event
from partwise_service.security.recent import RecentlyGood

POLL_S = 1.0
PAGE = 500
MAX_RECENT = 5_000
"""Events in memory. A stream that falls behind them reads on from the catalog."""
_PRUNED_AT_ONCE = 10_000
_log = logging.getLogger(__name__)


class EventHub:
    """One reader of events for the whole process, however many streams there are.

    All of it happens on the event loop; only the catalog is read on threads.

    Parameters
    ----------
    keep : how old events get before they are forgotten. prune_every_s : how often that is looked after.
    recent : hears of all events, and so of revocations by other processes. clock : its clock.
    """

    def __init__(
        self,
        catalog: EventCatalog,
        keep: timedelta,
        recent: RecentlyGood,
        clock: Callable[[], float],
        prune_every_s: float = 600.0,
    ) -> None:
        self._catalog = catalog
        self._keep = keep
        self._recently_good = recent
        self._clock = clock
        self._prune_every_s = prune_every_s
        self._recent: deque[Event] = deque(maxlen=MAX_RECENT)
        self._floor = 0  # the id after which all events are in `_recent`
        self._newest = 0
        self._has_news = asyncio.Event()
        self._thread = CapacityLimiter(1)  # its own: word of a revocation does not wait behind busy handlers

    @asynccontextmanager
    async def running(self) -> AsyncIterator["EventHub"]:
        """Reads and prunes until the block ends."""
        tasks = [asyncio.create_task(self._poll()), asyncio.create_task(self._prune())]
        try:
            yield self
        finally:
            for task in tasks:
                task.cancel()
            for task in tasks:
                with suppress(asyncio.CancelledError):
                    await task

    @property
    def newest(self) -> int:
        """The id of the last event taken in."""
        return self._newest

    def since(self, last: int) -> Sequence[Event] | None:
        """All events after this id that are known here; None if some may be known to the catalog only."""
        if last < self._floor:
            return None
        return [event for event in self._recent if event.id > last]

    async def news(self, timeout_s: float) -> None:
        """Returns when there are new events, or after this time."""
        with suppress(TimeoutError):
            await asyncio.wait_for(self._has_news.wait(), timeout_s)

    async def read_on(self) -> int:
        """Takes in what is new; how many events that are."""
        looked_at = self._clock()
        found = await run_sync(lambda: self._catalog.events(after=self._newest, limit=PAGE), limiter=self._thread)
        self._recently_good.hear(found, looked_at, is_all=len(found) < PAGE)
        for event in found:
            if len(self._recent) == MAX_RECENT:
                self._floor = self._recent[0].id
            self._recent.append(event)
        if found:
            self._newest = found[-1].id
            waiting, self._has_news = self._has_news, asyncio.Event()
            waiting.set()
        return len(found)

    async def begin_now(self) -> None:
        """Goes on from the newest event on record; of those before it, it may have missed a revocation."""
        self._newest = self._floor = (await run_sync(self._catalog.event_bounds, limiter=self._thread)).newest
        self._recently_good.distrust_all()

    async def _poll(self) -> None:
        has_begun = is_away = False
        while True:
            try:
                if not has_begun:
                    await self.begin_now()
                    has_begun = True
                is_behind = await self.read_on() == PAGE
                is_away = False
            except Exception:  # noqa: BLE001 # the task's edge: streams are silent until the catalog is back
                if not is_away:  # said once, not every second
                    _log.exception("events cannot be read")
                is_away, is_behind = True, False
            if not is_behind:
                await asyncio.sleep(POLL_S)

    async def _prune(self) -> None:
        while True:
            try:
                before = datetime.now(UTC) - self._keep
                while await run_sync(lambda: self._catalog.prune_events(before, limit=_PRUNED_AT_ONCE)):  # noqa: B023 # awaited in the loop
                    pass
            except Exception:  # noqa: BLE001 # as above
                _log.exception("old events cannot be forgotten")
            await asyncio.sleep(self._prune_every_s)


class Listener:
    """What one stream has read: from the hub, or from the catalog where the hub's memory does not reach back.

    scope : the collections that the stream may tell of; None for all. Events of no collection are for all.
    """

    def __init__(self, hub: EventHub, catalog: EventCatalog, scope: Sequence[int] | None) -> None:
        self._hub = hub
        self._catalog = catalog
        self._scope = scope
        self._position: int | None = None

    async def read(self, last: int) -> Sequence[Event]:
        """The next events that the stream tells, after those of the last call; after this id in the first."""
        known = None if self._position is None else self._hub.since(self._position)
        if known is None:
            return await self._read_catalog(last if self._position is None else self._position)
        self._position = known[-1].id if known else self._position
        return [event for event in known if self._is_theirs(event)]

    async def _read_catalog(self, after: int) -> Sequence[Event]:
        newest = self._hub.newest
        found = await run_sync(lambda: self._catalog.events(after=after, collection_ids=self._scope, limit=PAGE))
        last = found[-1].id if found else after
        self._position = last if len(found) == PAGE else max(last, newest)
        return found

    def _is_theirs(self, event: Event) -> bool:
        return self._scope is None or event.collection_id is None or event.collection_id in self._scope
