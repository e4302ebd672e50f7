"""`RecentlyGood`: secrets that were good lately, by fingerprint. In memory, bounded."""

import math
from collections import OrderedDict
from collections.abc import Callable, Sequence
from datetime import UTC, datetime
from threading import Lock

from partwise.store.records import Event, Token

TRUST_S = 60.0
"""Seconds for which a secret that was good is not looked up again, unless one was revoked meanwhile."""
ASSURED_S = 5.0
"""Seconds since the last look at what was revoked, after which nothing is trusted: the database may be out of reach."""


class RecentlyGood:
    """Says which secrets need not wait for a limit that others have used up, and whose those are that were so just now.

    Nobody is trusted but by a process that hears of revocations: see `hear`. Holds hashes only, the `max_secrets` used
    last. Threads may share it. clock : seconds, monotone.
    """

    def __init__(self, clock: Callable[[], float], max_secrets: int = 10_000) -> None:
        self._clock = clock
        self._max_secrets = max_secrets
        self._tokens: OrderedDict[bytes, tuple[Token, float]] = OrderedDict()
        self._distrusted_at = self._assured_at = -math.inf
        self._lock = Lock()

    def holds(self, fingerprint: bytes) -> bool:
        with self._lock:
            return fingerprint in self._tokens

    def trusted(self, fingerprint: bytes) -> Token | None:
        """The token of a secret that was looked up less than `TRUST_S` ago, and neither expired nor was revoked."""
        with self._lock:
            token, looked_up_at = self._tokens.get(fingerprint, (None, 0.0))
            now = self._clock()
            is_assured = now - self._assured_at < ASSURED_S
            is_fresh = is_assured and looked_up_at > self._distrusted_at and now - looked_up_at < TRUST_S
        return token if token is not None and is_fresh and datetime.now(UTC) < token.expires_at else None

    def remember(self, fingerprint: bytes, token: Token, looked_up_at: float) -> None:
        """looked_up_at : by the clock, before it was: what is revoked in between is not trusted."""
        with self._lock:
            self._tokens[fingerprint] = (token, looked_up_at)
            self._tokens.move_to_end(fingerprint)
            while len(self._tokens) > self._max_secrets:
                self._tokens.popitem(last=False)

    def forget(self, fingerprint: bytes) -> None:
        with self._lock:
            self._tokens.pop(fingerprint, None)

    def hear(self, events: Sequence[Event], looked_at: float, *, is_all: bool) -> None:
        """Events that are new, as they were read when the clock said `looked_at`. is_all : there were no more."""
        if any(event.is_revocation for event in events):
            self.distrust_all()
        if is_all:
            with self._lock:
                self._assured_at = looked_at

    def distrust_all(self) -> None:
        """Has every secret looked up again: something was revoked."""
        with self._lock:
            self._distrusted_at = self._clock()
