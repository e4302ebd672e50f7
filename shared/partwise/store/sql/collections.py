"""Collections, the versions of their part schemas, people, and the audit trail."""

from collections.abc import Mapping, Sequence
from dataclasses import replace
from datetime import datetime
from typing import Any

from sqlalchemy import Connection, Row, insert, or_, select, update

from partwise.errors import ConflictError, LabelError, NotFoundError, ParameterError
from partwise.labels.palette import default_colour
from partwise.labels.schema import Part, PartSchema
from partwise.store import tables as t
from partwise.store.records import AuditEntry, Collection, Person


def create_collection(
    connection: Connection, name: str, part_names: Sequence[str], settings: Mapping[str, Any], now: datetime
) -> Collection:
    if not name or name != name.strip():
        raise ParameterError(f"a collection's name must be non-empty without spaces around it but is {name!r}")
    taken = connection.execute(select(t.collection.c.id).where(t.collection.c.name == name)).first()
    if taken:
        raise ConflictError(f"each collection must have its own name but {name!r} is taken; choose another")
    parts = tuple(Part(i, part_name, default_colour(i)) for i, part_name in enumerate(part_names, start=1))
    schema = PartSchema(1, parts)  # validates the names before anything is written
    values: dict[str, Any] = {"name": name, "settings": dict(settings), "schema_version": 1, "created_at": now}
    collection_id = connection.execute(insert(t.collection).values(values).returning(t.collection.c.id)).scalar_one()
    if parts:
        connection.execute(insert(t.part), [part_row(collection_id, part, 1) for part in schema.parts])
    return Collection(id=collection_id, **values)


def part_row(collection_id: int, part: Part, version: int) -> dict[str, Any]:
    """A new part as a row of `part`."""
    return {
        "collection_id": collection_id,
        "id": part.id,
        "name": part.name,
        "colour": part.colour,
        "gloss": part.gloss,
        "ordinal": part.id,
        "schema_version_added": version,
        "schema_version_removed": None,
        "parent_id": part.parent_id,
    }


def get_collection(connection: Connection, name: str) -> Collection:
    row = connection.execute(select(t.collection).where(t.collection.c.name == name)).first()
    if row is None:
        known = connection.execute(select(t.collection.c.name).order_by(t.collection.c.name).limit(10)).scalars().all()
        raise NotFoundError(f"there is no collection {name!r}; there are: {', '.join(known) or 'none yet'}")
    return _collection(row)


def list_collections(connection: Connection) -> Sequence[Collection]:
    return [_collection(row) for row in connection.execute(select(t.collection).order_by(t.collection.c.name))]


def update_settings(
    connection: Connection, collection_id: int, settings: Mapping[str, Any], now: datetime
) -> Collection:
    schema_version(connection, collection_id, for_update=True)
    is_it = t.collection.c.id == collection_id
    before = _collection(connection.execute(select(t.collection).where(is_it)).one())
    changed = {key: value for key, value in settings.items() if before.settings.get(key) != value}
    after = {**before.settings, **changed}
    if changed:
        connection.execute(update(t.collection).where(is_it).values(settings=after))
        was = {key: before.settings.get(key) for key in changed}
        append_audit(connection, "operator", "change settings", before.name, {"from": was, "to": changed}, now)
    return replace(before, settings=after)


def _collection(row: Row[Any]) -> Collection:
    return Collection(**row._mapping)


def schema_version(
    connection: Connection, collection_id: int, *, for_update: bool = False, for_share: bool = False
) -> int:
    """The current schema version.

    `for_update` makes other writers wait until this transaction ends, `for_share` only those that ask for update.
    """
    query = select(t.collection.c.schema_version).where(t.collection.c.id == collection_id)
    if for_update or for_share:
        query = query.with_for_update(read=not for_update, key_share=for_update)  # rows of the collection may be added
    version = connection.execute(query).scalar()
    if version is None:
        raise NotFoundError(f"there is no collection with id {collection_id}")
    return version


def parts(connection: Connection, collection_id: int, version: int | None = None) -> PartSchema:
    current = schema_version(connection, collection_id)
    version = current if version is None else version
    if not 1 <= version <= current:
        raise LabelError(f"the schema version must be 1 to {current} but is {version}; was another collection meant?")
    query = (
        select(t.part.c.id, t.part.c.name, t.part.c.colour, t.part.c.gloss, t.part.c.parent_id)
        .where(t.part.c.collection_id == collection_id, t.part.c.schema_version_added <= version)
        .where(or_(t.part.c.schema_version_removed.is_(None), t.part.c.schema_version_removed > version))
        .order_by(t.part.c.ordinal)
    )
    found = [Part(**row._mapping) for row in connection.execute(query)]
    known = {part.id for part in found}
    found = [part if part.parent_id in known else replace(part, parent_id=None) for part in found]  # an older version's
    return PartSchema(version, _distinct_names(found))


def _distinct_names(parts_of_version: Sequence[Part]) -> tuple[Part, ...]:
    """Parts of an older version that were renamed to a name in use by another get their id behind the name."""
    names = [part.name for part in parts_of_version]
    return tuple(
        part if names.count(part.name) == 1 else replace(part, name=f"{part.name[:56]} ({part.id})")
        for part in parts_of_version
    )


def add_person(connection: Connection, name: str, now: datetime) -> Person:
    if not name or name != name.strip():
        raise ParameterError(f"a person's name must be non-empty without spaces around it but is {name!r}")
    if connection.execute(select(t.person.c.id).where(t.person.c.name == name)).first():
        raise ConflictError(f"each person must have their own name but {name!r} is taken; choose another")
    values = {"name": name, "created_at": now}
    return Person(
        id=connection.execute(insert(t.person).values(values).returning(t.person.c.id)).scalar_one(),
        name=name,
        created_at=now,
    )


def get_person(connection: Connection, name: str) -> Person:
    row = connection.execute(select(t.person).where(t.person.c.name == name)).first()
    if row is None:
        raise NotFoundError(f"there is no person {name!r}; add them first")
    return Person(**row._mapping)


def list_people(connection: Connection) -> Sequence[Person]:
    return [Person(**row._mapping) for row in connection.execute(select(t.person).order_by(t.person.c.name))]


def append_audit(
    connection: Connection, actor: str, action: str, subject: str, detail: Mapping[str, Any], now: datetime
) -> None:
    entry = {"at": now, "actor": actor, "action": action, "subject": subject, "detail": dict(detail)}
    connection.execute(insert(t.audit).values(entry))


def audit(connection: Connection, after: int, limit: int) -> Sequence[AuditEntry]:
    query = select(t.audit).where(t.audit.c.id > after).order_by(t.audit.c.id).limit(limit)
    return [AuditEntry(**row._mapping) for row in connection.execute(query)]


def latest_audit(connection: Connection, before: int | None, limit: int) -> Sequence[AuditEntry]:
    query = select(t.audit).order_by(t.audit.c.id.desc()).limit(limit)
    if before is not None:
        query = query.where(t.audit.c.id < before)
    return [AuditEntry(**row._mapping) for row in connection.execute(query)]
