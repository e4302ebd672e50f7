"""Events: what open pages are told, in order."""

from collections.abc import Sequence
from datetime import datetime
from typing import Protocol

from partwise.store.records import Event, EventBounds, NewEvent


class EventCatalog(Protocol):
    """Events. Claims, confirmations, reviews and jobs add theirs in their own transaction."""

    def add_event(self, event: NewEvent) -> Event: ...

    def events(self, *, after: int, collection_ids: Sequence[int] | None = None, limit: int = 1000) -> Sequence[Event]:
        """A page of events by id: of these collections and of none, or all if None.

        No event with a lower id appears later, so reading on from the last id misses nothing.
        """
        ...

    def event_bounds(self) -> EventBounds: ...

    def prune_events(self, before: datetime, *, limit: int = 10_000) -> int:
        """Forget the oldest events from before then, at most `limit`; how many."""
        ...
