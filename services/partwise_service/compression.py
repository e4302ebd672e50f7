"""Bodies compressed as the caller takes them: zstd before gzip, neither where it is not worth it.

Secrets and what a caller chose are in one compressed body here and there; that is what BREACH guesses secrets from, by
having a victim's browser send guesses with its credentials. A page of another origin cannot: the session cookie is
`SameSite=Strict`, scripts send a bearer token, and secrets (a new token) are told once. So lengths tell nothing here.
"""

import gzip
from collections.abc import Iterable, Sequence
from typing import Final

from numcodecs.zstd import compress as compress_zstd  # type: ignore[import-untyped]  # ships no types
from starlette.datastructures import Headers, MutableHeaders
from starlette.types import ASGIApp, Message, Receive, Scope, Send

ZSTD: Final = "zstd"
GZIP: Final = "gzip"
MIN_BYTES = 1024
"""Below, a packet is a packet."""
_ZSTD_LEVEL = 3
_GZIP_LEVEL = 1  # what the service sends shrinks by nearly as much as at 6, in a fifth of the time
_TYPES: Sequence[bytes] = (b"application/json", b"application/problem+json")


def allowed_codings(accept_encoding: str) -> dict[str, bool]:
    """By coding, in lower case, whether the header allows it; `*` stands for those that it does not name."""
    allowed: dict[str, bool] = {}
    for each in accept_encoding.lower().split(","):
        coding, _, quality = each.partition(";")
        allowed[coding.strip()] = quality.strip().replace(" ", "") not in ("q=0", "q=0.0", "q=0.00", "q=0.000")
    return allowed


def accepted_coding(accept_encoding: str) -> str | None:
    """The coding to use of those that an Accept-Encoding header allows: zstd, else gzip, else None."""
    allowed = allowed_codings(accept_encoding)
    for coding in (ZSTD, GZIP):
        if allowed.get(coding, coding == GZIP and allowed.get("*", False)):
            return coding
    return None


def compressed(data: bytes, coding: str) -> bytes:
    """The bytes in this coding."""
    if coding == ZSTD:
        return bytes(compress_zstd(data, _ZSTD_LEVEL))
    return gzip.compress(data, _GZIP_LEVEL, mtime=0)


class CompressionMiddleware:
    """Compresses JSON that is sent in one piece. Streams go by as they are, so that events are not held back."""

    def __init__(self, app: ASGIApp) -> None:
        self._app = app

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        if scope["type"] != "http":
            await self._app(scope, receive, send)
            return
        start: Message | None = None

        async def send_compressed(message: Message) -> None:
            nonlocal start
            if message["type"] == "http.response.start" and _is_json(message["headers"]):
                start = message
                return
            if start is not None and message["type"] == "http.response.body":
                begun, start = start, None
                if len(message.get("body", b"")) >= MIN_BYTES:  # most are not, and are spared the rest
                    begun, message = _compressed_answer(scope, begun, message)
                await send(begun)
            await send(message)

        await self._app(scope, receive, send_compressed)


def _compressed_answer(scope: Scope, start: Message, message: Message) -> tuple[Message, Message]:
    """The beginning and the body of an answer, as the caller of this request takes them."""
    headers = MutableHeaders(raw=start["headers"])
    headers.add_vary_header("Accept-Encoding")
    coding = accepted_coding(Headers(scope=scope).get("accept-encoding", ""))
    if coding is not None and not message.get("more_body", False):
        body = compressed(message["body"], coding)
        headers["Content-Encoding"] = coding
        headers["Content-Length"] = str(len(body))
        message = {**message, "body": body}
    return {**start, "headers": headers.raw}, message


def _is_json(headers: Iterable[tuple[bytes, bytes]]) -> bool:
    """headers : as servers send them, names in lower case."""
    given = dict(headers)
    is_coded = b"content-encoding" in given
    return given.get(b"content-type", b"").partition(b";")[0].strip() in _TYPES and not is_coded
