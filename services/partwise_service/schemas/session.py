"""Logging in, and who one is."""

from datetime import datetime
from typing import Annotated, Self

from pydantic import Field, model_validator

from partwise.store.records import Role
from partwise_service.schemas.base import Answer, Request
from partwise_service.security.identity import Identity

Secret = Annotated[str, Field(min_length=1, max_length=200)]


class Login(Request):
    """Either a one-time code, as in the address that `partwise serve` shows, or a token."""

    code: Secret | None = None
    token: Secret | None = None

    @model_validator(mode="after")
    def _one_of_both(self) -> Self:
        if (self.code is None) is (self.token is None):
            raise ValueError("give a code or a token, and not both")
        return self


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
