"""Rows that belong to a person: who may know of one."""

from collections.abc import Callable
from dataclasses import dataclass
from functools import lru_cache
from typing import Protocol, TypeVar

from partwise.errors import NotFoundError
from partwise.store.catalog import DraftCatalog
from partwise.store.records import Role
from partwise_service.security.identity import Identity


class Owned(Protocol):
    """A person's row in a collection."""

    @property
    def person_id(self) -> int: ...
    @property
    def collection_id(self) -> int: ...


Row = TypeVar("Row", bound=Owned)
_DRAFTS = 10_000


@dataclass(frozen=True, slots=True)
class Owner:
    """Whose something is, and in which collection."""

    person_id: int
    collection_id: int


def draft_owners(catalog: DraftCatalog) -> Callable[[int], Owner]:
    """Whose drafts are, by id. That never changes, so that the catalog is asked once for each of the last 10,000.

    The function raises NotFoundError for a draft that is not there.
    """

    @lru_cache(_DRAFTS)
    def owner(draft_id: int) -> Owner:
        draft = catalog.draft(draft_id)
        return Owner(draft.person_id, draft.collection_id)

    return owner


def visible_row(caller: Identity, find: Callable[[], Row], missing: str) -> Row:
    """What `find` finds, if it is the caller's, or the caller is an operator of its collection.

    missing : what is said where it is not there, and as well where it is not for them.

    Raises
    ------
    NotFoundError : with that message.
    """
    try:
        found = find()
    except NotFoundError as error:
        raise NotFoundError(missing) from error
    is_theirs = found.person_id == caller.person_id or caller.role.includes(Role.OPERATOR)
    if not is_theirs or not caller.may_see(found.collection_id):
        raise NotFoundError(missing)
    return found
