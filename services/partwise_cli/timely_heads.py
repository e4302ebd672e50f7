"""`TimelyHeads`: HTTP on connections that do not wait for ever for a request to begin."""

import asyncio
from typing import Any

from uvicorn.protocols.http.httptools_impl import HttpToolsProtocol


class TimelyHeads(HttpToolsProtocol):
    """The server's protocol, which ends a connection on which no request is under way and none comes.

    head_s : seconds for the line and headers of a request, from the connection's beginning or the answer before on. The
        server itself bounds silence after an answer only, and not what comes a byte at a time.
    """

    def __init__(self, *arguments: Any, head_s: float, **named: Any) -> None:
        super().__init__(*arguments, **named)
        self._head_s = head_s
        self._timer: asyncio.TimerHandle | None = None

    def connection_made(self, transport: asyncio.Transport) -> None:  # type: ignore[override] # as its base does
        super().connection_made(transport)
        self._wait_for_head()

    def on_headers_complete(self) -> None:
        self._wait_no_more()
        super().on_headers_complete()

    def on_response_complete(self) -> None:
        super().on_response_complete()
        self._wait_for_head()

    def connection_lost(self, exc: Exception | None) -> None:
        self._wait_no_more()
        super().connection_lost(exc)

    def _wait_for_head(self) -> None:
        self._wait_no_more()
        self._timer = self.loop.call_later(self._head_s, self._end_if_idle)

    def _wait_no_more(self) -> None:
        if self._timer is not None:
            self._timer.cancel()
            self._timer = None

    def _end_if_idle(self) -> None:
        if self.cycle is None or self.cycle.response_complete:  # else a request that came meanwhile is answered
            self.transport.close()
