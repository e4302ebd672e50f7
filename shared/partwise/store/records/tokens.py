"""Tokens: who may do what, for how long. Secrets are never on record, only their hashes."""

from dataclasses import dataclass, field
from datetime import datetime
from enum import StrEnum

from partwise.errors import ParameterError


class Role(StrEnum):
    """What a token allows; each role may do what those before it may."""

    ANNOTATOR = "annotator"
    REVIEWER = "reviewer"
    OPERATOR = "operator"
    ADMIN = "admin"

    def includes(self, other: "Role") -> bool:
        """Whether who has this role may do what `other` may."""
        order = list(Role)
        return order.index(self) >= order.index(other)


@dataclass(frozen=True, slots=True)
class NewToken:
    """A token to issue. scope : ids of the collections that it opens, None for all. note : what it is for.

    Raises
    ------
    ParameterError : a scope without a collection.
    """

    person_id: int
    role: Role
    expires_at: datetime
    scope: tuple[int, ...] | None = None
    note: str = ""

    def __post_init__(self) -> None:
        if self.scope is not None and not self.scope:
            raise ParameterError("a token's scope must name collections, or be None for all, but is empty; name one")


@dataclass(frozen=True, slots=True)
class Token:
    """A token on record, without its secret.

    is_session : it was exchanged for a login code and lives in a browser's cookie; `parent_id` is the token that the
        code was made with, and revoking that one ends it too.
    """

    id: int
    person_id: int
    person_name: str
    role: Role
    scope: tuple[int, ...] | None
    note: str
    is_session: bool
    parent_id: int | None
    created_at: datetime
    expires_at: datetime
    revoked_at: datetime | None
    last_used_at: datetime | None

    def opens(self, collection_id: int) -> bool:
        """Whether the collection is in the token's scope."""
        return self.scope is None or collection_id in self.scope


@dataclass(frozen=True, slots=True)
class IssuedToken:
    """A new token and its secret, which is shown once."""

    token: Token
    secret: str = field(repr=False)


@dataclass(frozen=True, slots=True)
class IssuedCode:
    """A login code, which is shown once and works once, until `expires_at`."""

    code: str = field(repr=False)
    expires_at: datetime
