"""Collections, their parts, people, and the audit trail."""

from collections.abc import Mapping, Sequence
from typing import Any, Protocol

from partwise.labels.schema import PartSchema
from partwise.store.records import AuditEntry, Collection, Person


class CollectionCatalog(Protocol):
    """Collections, their parts, and people."""

    def create_collection(
        self, name: str, part_names: Sequence[str], settings: Mapping[str, Any] | None = None
    ) -> Collection:
        """A collection with schema version 1: parts 1 … n in the order given, in default colours.

        Raises `ConflictError` if the name is taken, `LabelError` for a bad or repeated part name.
        """
        ...

    def get_collection(self, name: str) -> Collection: ...

    def list_collections(self) -> Sequence[Collection]:
        """Every collection, by name."""
        ...

    def update_collection_settings(self, collection_id: int, settings: Mapping[str, Any]) -> Collection:
        """Set the keys given, leave the others, and put the change on the audit trail."""
        ...

    def parts(self, collection_id: int, version: int | None = None) -> PartSchema:
        """The part schema, the current version unless another is named."""
        ...

    def add_part(
        self,
        collection_id: int,
        name: str,
        colour: str | None = None,
        gloss: str = "",
        parent_id: int | None = None,
    ) -> PartSchema:
        """Add a part under the next free id and make the next schema version.

        Human and imported labels of older versions wait in a review of reason schema from then on: whether the part
        is missing in them is for somebody to say. An open one stays, and is then about the newer version.

        Raises `ConflictError` if the name is taken, `LabelError` for a parent that is not in the schema.
        """
        ...

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
        """Rename, recolour or explain a part or put it below another; the schema version stays.

        What is None stays as it is; a `parent_id` of 0 puts the part at the top. Raises `ConflictError` if the name is
        taken, `LabelError` for a parent that is not in the schema or is below the part itself.
        """
        ...

    def remove_part(self, collection_id: int, part_id: int) -> PartSchema:
        """Leave a part out of the next schema version. Its id is never used again. Reviews open as in `add_part`.

        Raises `ConflictError` for a part that other parts are below, that the newest human or imported labels of any
        shape use, or that independent labels use which may yet become a shape's; the message says of how many.
        """
        ...

    def add_person(self, name: str) -> Person:
        """`ConflictError` if the name is taken."""
        ...

    def get_person(self, name: str) -> Person: ...

    def list_people(self) -> Sequence[Person]:
        """Every person, by name."""
        ...


class AuditCatalog(Protocol):
    """The audit trail."""

    def append_audit(self, actor: str, action: str, subject: str, detail: Mapping[str, Any] | None = None) -> None: ...

    def audit(self, *, after: int = 0, limit: int = 1000) -> Sequence[AuditEntry]:
        """A page of the trail, oldest first."""
        ...

    def latest_audit(self, *, before: int | None = None, limit: int = 1000) -> Sequence[AuditEntry]:
        """A page of the trail, newest first: entries older than that with the id `before`, if one is given."""
        ...
