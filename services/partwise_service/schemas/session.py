"""Logging in, and who one is."""

from datetime import datetime
from typing import Annotated

from pydantic import Field

from partwise.store.records import Role
from partwise_service.schemas.base import Answer, Request
from partwise_service.security.identity import Identity

Secret = Annotated[str, Field(min_length=1, max_length=200)]


class CodeLogin(Request):
    """A one-time code, as in the address that `partwise serve` shows."""

    code: Secret


class TokenLogin(Request):
    """A token."""

    token: Secret


Login = CodeLogin | TokenLogin


class Me(Answer):
    """Who one is. `scope` lists the collections that exist for one; null for all."""

    person_id: int
    name: str
    role: Role
    scope: list[int] | None
    is_session: bool
    expires_at: datetime

    @classmethod
    def of(cls, identity: Identity) -> "Me":
        """The identity as it is told."""
        token = identity.token
        return cls(
            person_id=token.person_id,
            name=token.person_name,
            role=token.role,
            scope=None if token.scope is None else list(token.scope),
            is_session=token.is_session,
            expires_at=token.expires_at,
        )
