"""Tokens and login codes."""

from collections.abc import Sequence

from partwise.store import records as r
from partwise.store.engine import reading, writing
from partwise.store.sql import tokens
from partwise.store.sql_catalog.base import SqlBase


class SqlTokenCatalog(SqlBase):
    def issue_token(self, new: r.NewToken, actor: str) -> r.IssuedToken:
        with writing(self._engine) as connection:
            return tokens.issue_token(connection, new, actor, self._clock())

    def authenticate(self, secret: str) -> r.Token | None:
        with reading(self._engine) as connection:
            return tokens.authenticate(connection, secret, self._clock())

    def note_token_use(self, token_id: int) -> None:
        with reading(self._engine) as connection:
            is_noted = tokens.is_use_noted(connection, token_id, self._clock())
        if not is_noted:
            with writing(self._engine) as connection:
                tokens.note_token_use(connection, token_id, self._clock())

    def token(self, token_id: int) -> r.Token:
        with reading(self._engine) as connection:
            return tokens.token(connection, token_id)

    def tokens(self, *, person_id: int | None = None, after: int = 0, limit: int = 1000) -> Sequence[r.Token]:
        with reading(self._engine) as connection:
            return tokens.tokens(connection, person_id, after, limit)

    def revoke_token(self, token_id: int, actor: str) -> r.Token:
        with writing(self._engine) as connection:
            return tokens.revoke_token(connection, token_id, actor, self._clock())

    def issue_login_code(self, token_id: int, valid_s: float = 300.0) -> r.IssuedCode:
        with writing(self._engine) as connection:
            return tokens.issue_login_code(connection, token_id, valid_s, self._clock())

    def exchange_login_code(self, code: str, session_s: float) -> r.IssuedToken | None:
        with writing(self._engine) as connection:
            return tokens.exchange_login_code(connection, code, session_s, self._clock())
