"""`authenticate`: a secret becomes an identity, or a problem; guessing is slow.

Secrets are 256 random bits, so that guessing them is hopeless and limits only keep the attempts cheap to refuse. They
count by address, and by how the secret begins. An address over its limit may go on with secrets that were good lately,
so that nobody is locked out by a neighbour's attempts.
"""

import hashlib
import math
from dataclasses import dataclass, field
from datetime import UTC, datetime, timedelta

from partwise_service.problems import ProblemError, ProblemKind
from partwise_service.security.identity import Identity
from partwise_service.service import Service

SESSION_COOKIE = "partwise_session"
MAX_SECRET = 200  # characters; those that are issued have 46
_USE_NOTED_EVERY = timedelta(minutes=1)
_PREFIX = 10  # characters of a secret: its "pw_" and seven more


@dataclass(frozen=True, slots=True)
class Credential:
    """What the caller sent. is_session : in a cookie, where scripts of a page cannot read it."""

    secret: str = field(repr=False)
    is_session: bool


def recognise(service: Service, credential: Credential) -> Identity | None:
    """Who the secret belongs to, if it was good a moment ago; None says that `authenticate` must look it up."""
    token = service.recent.trusted(_fingerprint(credential.secret))
    return None if token is None or token.is_session is not credential.is_session else Identity(token)


def authenticate(service: Service, credential: Credential, address: str) -> Identity:
    """Who the secret belongs to.

    Problems: 401 for a secret that was never issued, has expired or was revoked (the answer does not say which) or that
    came in the wrong place; 429 after too many of those.
    """
    known = _fingerprint(credential.secret)
    if not service.recent.holds(known):
        refuse_too_many(service, address, credential.secret)
    catalog, asked_at = service.workspace.catalog, service.clock()
    token = None if len(credential.secret) > MAX_SECRET else catalog.authenticate(credential.secret)
    if token is None or token.is_session is not credential.is_session:
        service.recent.forget(known)
        record_failure(service, address, credential.secret)
        raise refused()
    service.recent.remember(known, token, asked_at)
    if token.last_used_at is None or datetime.now(UTC) - token.last_used_at >= _USE_NOTED_EVERY:
        catalog.note_token_use(token.id)
    return Identity(token)


def refused() -> ProblemError:
    """The one answer to any secret that is not good."""
    return ProblemError(
        ProblemKind.UNAUTHENTICATED,
        "The token, session or code is not valid, or no longer; ask an operator for a new token, or log in again.",
        headers={"WWW-Authenticate": "Bearer"},
    )


def refuse_too_many(service: Service, address: str, secret: str) -> None:
    """429 if the address, or whoever tries secrets that begin like this one, has failed too often."""
    wait_s = max(service.limiter.wait_s(key) for key in _keys(address, secret))
    if wait_s > 0:
        raise ProblemError(
            ProblemKind.TOO_MANY,
            "Too many attempts to log in failed; wait, then try again.",
            headers={"Retry-After": str(math.ceil(wait_s))},
        )


def record_failure(service: Service, address: str, secret: str) -> None:
    """Counts a secret that was not good."""
    for key in _keys(address, secret):
        service.limiter.record(key)


def _keys(address: str, secret: str) -> tuple[tuple[str, str], tuple[str, str]]:
    return ("address", address), ("secret", secret[:_PREFIX])


def _fingerprint(secret: str) -> bytes:
    return hashlib.sha256(secret.encode(errors="replace")).digest()
