"""Events."""

from collections.abc import Sequence
from datetime import datetime

from partwise.store import records as r
from partwise.store.engine import reading, writing
from partwise.store.sql import events
from partwise.store.sql_catalog.base import SqlBase


class SqlEventCatalog(SqlBase):
    def add_event(self, event: r.NewEvent) -> r.Event:
        with writing(self._engine) as connection:
            return events.append_events(connection, [event], self._clock())[0]

    def events(
        self, *, after: int, collection_ids: Sequence[int] | None = None, limit: int = 1000
    ) -> Sequence[r.Event]:
        with reading(self._engine) as connection:
            return events.events(connection, after, collection_ids, limit)

    def event_bounds(self) -> r.EventBounds:
        with reading(self._engine) as connection:
            return events.event_bounds(connection)

    def prune_events(self, before: datetime, *, limit: int = 10000) -> int:
        with writing(self._engine) as connection:
            return events.prune_events(connection, before, limit)
