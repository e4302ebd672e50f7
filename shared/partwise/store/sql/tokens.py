"""Tokens and login codes: random, and on record as hashes only."""

import hashlib
import secrets
from collections.abc import Sequence
from dataclasses import replace
from datetime import datetime, timedelta
from typing import Any

from sqlalchemy import Connection, Row, Select, bindparam, insert, or_, select, update

from partwise.errors import ConflictError, NotFoundError, ParameterError
from partwise.store import tables as t
from partwise.store.records import REVOKED, IssuedCode, IssuedToken, NewToken, Role, Token
from partwise.store.sql.collections import append_audit
from partwise.store.sql.events import append_events
from partwise.store.sql.leases import person_name

SECRET_PREFIX = "pw_"  # noqa: S105 # what secrets begin with, so that they are recognised where they should not be
_SECRET_BYTES = 32
_USE_NOTED_EVERY = timedelta(minutes=1)
_LONGEST_CODE_S = 3600.0


def issue_token(connection: Connection, new: NewToken, actor: str, now: datetime) -> IssuedToken:
    name = person_name(connection, new.person_id)
    if new.expires_at <= now:
        raise ParameterError(f"a token must expire in the future but was to expire at {new.expires_at.isoformat()}")
    _refuse_unknown_collections(connection, new.scope or ())
    issued = _insert(connection, new, None, now)
    detail = {"person": name, "role": new.role.value, "scope": None if new.scope is None else list(new.scope)}
    append_audit(connection, actor, "issue token", f"token {issued.token.id}", detail, now)
    return issued


def _insert(connection: Connection, new: NewToken, parent_id: int | None, now: datetime) -> IssuedToken:
    secret = SECRET_PREFIX + secrets.token_urlsafe(_SECRET_BYTES)
    values = {
        "person_id": new.person_id,
        "role": new.role.value,
        "scope": None if new.scope is None else list(new.scope),
        "note": new.note,
        "secret_sha256": _sha256(secret),
        "is_session": parent_id is not None,
        "parent_id": parent_id,
        "created_at": now,
        "expires_at": new.expires_at,
    }
    token_id = connection.execute(insert(t.token).values(values).returning(t.token.c.id)).scalar_one()
    return IssuedToken(token(connection, token_id), secret)


def _refuse_unknown_collections(connection: Connection, scope: Sequence[int]) -> None:
    known = set(connection.execute(select(t.collection.c.id).where(t.collection.c.id.in_(scope))).scalars())
    for collection_id in scope:
        if collection_id not in known:
            raise NotFoundError(f"there is no collection with id {collection_id}; a scope names those there are")


def authenticate(connection: Connection, secret: str, now: datetime) -> Token | None:
    if not secret.startswith(SECRET_PREFIX):
        return None
    row = connection.execute(_GOOD_TOKEN, {"sha256": _sha256(secret), "now": now}).first()
    return None if row is None else _token(row)


def note_token_use(connection: Connection, token_id: int, now: datetime) -> None:
    used = t.token.c.last_used_at
    is_old = or_(used.is_(None), used < now - _USE_NOTED_EVERY)
    connection.execute(update(t.token).where(t.token.c.id == token_id, is_old).values(last_used_at=now))


def is_use_noted(connection: Connection, token_id: int, now: datetime) -> bool:
    """Whether its use in the last minute is on record: then nothing needs writing."""
    used = connection.execute(select(t.token.c.last_used_at).where(t.token.c.id == token_id)).scalar()
    return used is not None and used >= now - _USE_NOTED_EVERY


def token(connection: Connection, token_id: int) -> Token:
    row = connection.execute(_tokens().where(t.token.c.id == token_id)).first()
    if row is None:
        raise NotFoundError(f"there is no token {token_id}")
    return _token(row)


def tokens(connection: Connection, person_id: int | None, after: int, limit: int) -> list[Token]:
    query = _tokens().where(t.token.c.id > after).order_by(t.token.c.id).limit(limit)
    if person_id is not None:
        query = query.where(t.token.c.person_id == person_id)
    return [_token(row) for row in connection.execute(query)]


def revoke_token(connection: Connection, token_id: int, actor: str, now: datetime) -> Token:
    known = token(connection, token_id)
    if known.revoked_at is not None:
        return known
    is_it = or_(t.token.c.id == token_id, t.token.c.parent_id == token_id)
    connection.execute(update(t.token).where(is_it, t.token.c.revoked_at.is_(None)).values(revoked_at=now))
    append_audit(connection, actor, "revoke token", f"token {token_id}", {"person": known.person_name}, now)
    append_events(connection, [REVOKED], now)
    return replace(known, revoked_at=now)


def issue_login_code(connection: Connection, token_id: int, valid_s: float, now: datetime) -> IssuedCode:
    if not 0 < valid_s <= _LONGEST_CODE_S:
        raise ParameterError(f"a login code must be valid for more than 0 and at most {_LONGEST_CODE_S:g} s: {valid_s}")
    known = token(connection, token_id)
    if known.revoked_at is not None or known.expires_at <= now:
        raise ConflictError(f"a login code is made with a token that has not ended but token {token_id} has")
    code, expires_at = secrets.token_urlsafe(_SECRET_BYTES), now + timedelta(seconds=valid_s)
    values = {"token_id": token_id, "code_sha256": _sha256(code), "created_at": now, "expires_at": expires_at}
    connection.execute(insert(t.login_code).values(values))
    return IssuedCode(code, expires_at)


def exchange_login_code(connection: Connection, code: str, session_s: float, now: datetime) -> IssuedToken | None:
    if not session_s > 0:
        raise ParameterError(f"a session must last more than 0 s but was to last {session_s}; 43200 is usual")
    is_it = t.login_code.c.code_sha256 == _sha256(code)
    is_valid = t.login_code.c.used_at.is_(None) & (t.login_code.c.expires_at > now)
    statement = update(t.login_code).where(is_it, is_valid).values(used_at=now).returning(t.login_code.c.token_id)
    token_id = connection.execute(statement).scalar()
    if token_id is None:
        return None
    parent = token(connection, token_id)
    if parent.revoked_at is not None or parent.expires_at <= now:
        return None
    expires_at = min(parent.expires_at, now + timedelta(seconds=session_s))
    new = NewToken(parent.person_id, parent.role, expires_at, parent.scope, "session")
    append_audit(connection, parent.person_name, "log in", f"token {token_id}", {}, now)
    return _insert(connection, new, token_id, now)


def _sha256(secret: str) -> str:
    """Plain and fast: what is hashed are 256 random bits, not a word that somebody could guess."""
    return hashlib.sha256(secret.encode()).hexdigest()


def _tokens() -> Select[Any]:
    columns = [column for column in t.token.c if column.name != "secret_sha256"]
    return select(*columns, t.person.c.name.label("person_name")).join_from(
        t.token, t.person, t.person.c.id == t.token.c.person_id
    )


def _token(row: Row[Any]) -> Token:
    scope = None if row.scope is None else tuple(row.scope)
    return Token(**{**row._mapping, "role": Role(row.role), "scope": scope})


def _good_token() -> Select[Any]:
    """The token of a secret that is good now; a session no longer than the token it was begun with."""
    parent, now = t.token.alias("parent"), bindparam("now", type_=t.token.c.expires_at.type)
    is_parent_good = (parent.c.revoked_at.is_(None)) & (parent.c.expires_at > now)
    return (
        _tokens()
        .join(parent, parent.c.id == t.token.c.parent_id, isouter=True)
        .where(t.token.c.secret_sha256 == bindparam("sha256"))
        .where(t.token.c.revoked_at.is_(None), t.token.c.expires_at > now)
        .where(or_(t.token.c.parent_id.is_(None), is_parent_good))
    )


_GOOD_TOKEN = _good_token()
"""Built once: every request begins with it."""
