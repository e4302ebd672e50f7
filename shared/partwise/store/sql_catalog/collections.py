"""Collections, parts, people, audit."""

from collections.abc import Mapping, Sequence
from typing import Any

from partwise.labels.schema import PartSchema
from partwise.store import records as r
from partwise.store.engine import reading, writing
from partwise.store.sql import collections, part_changes
from partwise.store.sql_catalog.base import SqlBase


class SqlCollectionCatalog(SqlBase):
    def create_collection(
        self, name: str, part_names: Sequence[str], settings: Mapping[str, Any] | None = None
    ) -> r.Collection:
        with writing(self._engine) as connection:
            return collections.create_collection(connection, name, part_names, settings or {}, self._clock())

    def get_collection(self, name: str) -> r.Collection:
        with reading(self._engine) as connection:
            return collections.get_collection(connection, name)

    def list_collections(self) -> Sequence[r.Collection]:
        with reading(self._engine) as connection:
            return collections.list_collections(connection)

    def update_collection_settings(self, collection_id: int, settings: Mapping[str, Any]) -> r.Collection:
        with writing(self._engine) as connection:
            return collections.update_settings(connection, collection_id, settings, self._clock())

    def parts(self, collection_id: int, version: int | None = None) -> PartSchema:
        with reading(self._engine) as connection:
            return collections.parts(connection, collection_id, version)

    def add_part(
        self,
        collection_id: int,
        name: str,
        colour: str | None = None,
        gloss: str = "",
        parent_id: int | None = None,
    ) -> PartSchema:
        with writing(self._engine) as connection:
            schema = part_changes.add_part(connection, collection_id, name, colour, gloss, parent_id, self._clock())
        self._renew_states(collection_id)
        return schema

    def update_part(
        self,
        collection_id: int,
        part_id: int,
        *,
        name: str | None = None,
        colour: str | None = None,
        gloss: str | None = None,
        parent_id: int | None = None,
    ) -> PartSchema:
        with writing(self._engine) as connection:
            return part_changes.update_part(connection, collection_id, part_id, name, colour, gloss, parent_id)

    def remove_part(self, collection_id: int, part_id: int) -> PartSchema:
        with writing(self._engine) as connection:
            schema = part_changes.remove_part(connection, collection_id, part_id, self._clock())
        self._renew_states(collection_id)
        return schema

    def _renew_states(self, collection_id: int) -> None:
        """Of more shapes than were renewed with the change: a transaction each time, as others wait meanwhile."""
        is_more = True
        while is_more:
            with writing(self._engine) as connection:
                is_more = part_changes.renew_states(connection, collection_id)

    def add_person(self, name: str) -> r.Person:
        with writing(self._engine) as connection:
            return collections.add_person(connection, name, self._clock())

    def get_person(self, name: str) -> r.Person:
        with reading(self._engine) as connection:
            return collections.get_person(connection, name)

    def list_people(self) -> Sequence[r.Person]:
        with reading(self._engine) as connection:
            return collections.list_people(connection)

    def append_audit(self, actor: str, action: str, subject: str, detail: Mapping[str, Any] | None = None) -> None:
        with writing(self._engine) as connection:
            collections.append_audit(connection, actor, action, subject, detail or {}, self._clock())

    def audit(self, *, after: int = 0, limit: int = 1000) -> Sequence[r.AuditEntry]:
        with reading(self._engine) as connection:
            return collections.audit(connection, after, limit)

    def latest_audit(self, *, before: int | None = None, limit: int = 1000) -> Sequence[r.AuditEntry]:
        with reading(self._engine) as connection:
            return collections.latest_audit(connection, before, limit)
