"""HTTP/1.1 on one kept connection, no more than measuring takes: the client must not need the cores of the service."""

import asyncio
import json
import time
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, Self

from partwise.errors import StoreError

API = "/api/v1"


@dataclass(frozen=True, slots=True)
class Answered:
    """An answer. ms : from sending the request to having read the whole of it."""

    status: int
    body: bytes
    ms: float

    def json(self) -> Any:
        return json.loads(self.body)


class LoadClient:
    """Requests in the name of one person, one after another, on a connection that is made on first use.

    Raises
    ------
    StoreError : the service closed the connection in the middle, or speaks something else.
    """

    def __init__(self, host: str, port: int, secret: str) -> None:
        self._address = (host, port)
        self._headers = f"Host: {host}:{port}\r\nAuthorization: Bearer {secret}\r\n"
        self._streams: tuple[asyncio.StreamReader, asyncio.StreamWriter] | None = None

    async def __aenter__(self) -> Self:
        return self

    async def __aexit__(self, *_: object) -> None:
        if self._streams is not None:
            self._streams[1].close()

    async def get(self, path: str) -> Answered:
        return await self._send("GET", path, b"", {})

    async def post(self, path: str, body: object, headers: Mapping[str, str] | None = None) -> Answered:
        data = json.dumps(body, separators=(",", ":")).encode()
        return await self._send("POST", path, data, {"Content-Type": "application/json", **(headers or {})})

    async def _send(self, method: str, path: str, data: bytes, headers: Mapping[str, str]) -> Answered:
        if self._streams is None:
            self._streams = await asyncio.open_connection(*self._address)
        reader, writer = self._streams
        more = "".join(f"{name}: {value}\r\n" for name, value in headers.items())
        head = f"{method} {API}{path} HTTP/1.1\r\n{self._headers}{more}Content-Length: {len(data)}\r\n\r\n"
        started = time.perf_counter()
        writer.write(head.encode() + data)
        try:
            status, answered = _parsed_head(await reader.readuntil(b"\r\n\r\n"))
            body = await reader.readexactly(int(answered["content-length"]))
        except (asyncio.IncompleteReadError, ConnectionError, KeyError, ValueError) as error:
            self._streams = None
            raise StoreError(
                f"{method} {path} must be answered in full but: {error!r}; see the service's log"
            ) from error
        return Answered(status, body, 1000 * (time.perf_counter() - started))


def _parsed_head(head: bytes) -> tuple[int, dict[str, str]]:
    first, *lines = head.decode("latin-1").split("\r\n")
    pairs = (line.partition(":") for line in lines if line)
    return int(first.split(" ")[1]), {name.lower(): value.strip() for name, _, value in pairs}
