"""Rows that belong to a person: who may know of one."""

from collections.abc import Callable
from typing import Protocol, TypeVar

from partwise.errors import NotFoundError
from partwise.store.records import Role
from partwise_service.security.identity import Identity


class Owned(Protocol):
    """A person's row in a collection."""

    @property
    def person_id(self) -> int: ...
    @property
    def collection_id(self) -> int: ...


Row = TypeVar("Row", bound=Owned)


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
