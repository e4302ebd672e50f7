"""Rows that belong to a person: who may know of one."""

from collections.abc import Callable
from dataclasses import dataclass
from functools import lru_cache
from typing import Protocol, TypeVar

from partwise.errors import NotFoundError
from partwise.store.catalog import Catalog
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
class KnownDraft:
    """What never changes of a draft: whose it is, in which collection, and how many faces its mesh has."""

    person_id: int
    collection_id: int
    n_faces: int


def known_drafts(catalog: Catalog) -> Callable[[int], KnownDraft]:
    """What never changes of drafts, by id, so that the catalog is asked once for each of the last 10,000.

    The function raises NotFoundError for a draft that is not there.
    """

    @lru_cache(_DRAFTS)
    def known(draft_id: int) -> KnownDraft:
        draft = catalog.draft(draft_id)
        return KnownDraft(draft.person_id, draft.collection_id, catalog.mesh(draft.shape_id, draft.mesh_hash).n_faces)

    return known


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
