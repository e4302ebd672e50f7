"""Tokens and login codes."""

from collections.abc import Sequence
from typing import Protocol

from partwise.store.records import IssuedCode, IssuedToken, NewToken, Token


class TokenCatalog(Protocol):
    """Who may come in. Only hashes of secrets are on record."""

    def issue_token(self, new: NewToken, actor: str) -> IssuedToken:
        """A token with a new secret, which nobody can see again; put on the audit trail as done by `actor`.

        Raises `ParameterError` if it would expire in the past, `NotFoundError` for a person or collection that is not.
        """
        ...

    def authenticate(self, secret: str) -> Token | None:
        """The token of a secret; None if there is none, or it or its parent is expired or revoked."""
        ...

    def note_token_use(self, token_id: int) -> None:
        """Record that it was used now. Writes at most once a minute."""
        ...

    def token(self, token_id: int) -> Token: ...

    def tokens(self, *, person_id: int | None = None, after: int = 0, limit: int = 1000) -> Sequence[Token]:
        """A page of tokens by id, ended ones too."""
        ...

    def revoke_token(self, token_id: int, actor: str) -> Token:
        """End a token and the sessions that came from it. As it is if it has ended already."""
        ...

    def issue_login_code(self, token_id: int, valid_s: float = 300.0) -> IssuedCode:
        """A code that a browser exchanges for a session of this token, once, within `valid_s` seconds.

        Raises `ConflictError` if the token has ended, `ParameterError` for a time outside (0, 3600].
        """
        ...

    def exchange_login_code(self, code: str, session_s: float) -> IssuedToken | None:
        """A session token with the rights of the code's token, for `session_s` seconds but no longer than that lives.

        None if the code is unknown, used or expired, or its token has ended.
        """
        ...
