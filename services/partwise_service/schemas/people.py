"""People, their tokens, and the audit trail."""

from datetime import datetime
from typing import Annotated

from pydantic import Field, JsonValue

from partwise.store.records import Role, Token
from partwise_service.schemas.base import NO_NUL, Answer, AnyId, Request


class PersonOut(Answer):
    id: int
    name: str
    created_at: datetime


class PeopleOut(Answer):
    items: list[PersonOut]


class NewPerson(Request):
    name: Annotated[str, Field(min_length=1, max_length=200)]


class TokenOut(Answer):
    """A token on record, without its secret. `scope` lists the collections it opens; null for all."""

    id: int
    person_id: int
    person_name: str
    role: Role
    scope: list[int] | None
    note: str
    is_session: bool
    created_at: datetime
    expires_at: datetime
    revoked_at: datetime | None
    last_used_at: datetime | None

    @classmethod
    def of(cls, token: Token) -> "TokenOut":
        """The token as it is told."""
        known = {name: getattr(token, name) for name in cls.model_fields if name != "scope"}
        return cls(**known, scope=None if token.scope is None else list(token.scope))


class NewTokenIn(Request):
    """A token for a person. `scope` : collections that it opens; null for all. `days` : how long it is good."""

    person_id: AnyId
    role: Annotated[Role, Field(strict=False)]
    scope: Annotated[list[AnyId], Field(min_length=1, max_length=1_000)] | None = None
    days: Annotated[float, Field(gt=0, le=3_660, strict=False)] = 30.0
    note: Annotated[str, NO_NUL, Field(max_length=500)] = ""


class IssuedTokenOut(Answer):
    """A new token. `secret` is told this once."""

    token: TokenOut
    secret: str


class AuditOut(Answer):
    """Who did what to what."""

    id: int
    at: datetime
    actor: str
    action: str
    subject: str
    detail: dict[str, JsonValue]
