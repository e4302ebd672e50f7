"""ASGI middleware around every request: headers that browsers obey, faults as problem documents, limits on bodies."""

import math
import re

from anyio import current_time, fail_after
from starlette.datastructures import MutableHeaders
from starlette.exceptions import HTTPException
from starlette.types import ASGIApp, Message, Receive, Scope, Send

from partwise_service.problems import ProblemKind, fault_response, problem_response, request_line

API = "/api/"
_API_POLICY = "default-src 'none'; frame-ancestors 'none'"
_PAGE_POLICY = (
    "default-src 'self'; script-src 'self'; style-src 'self'; img-src 'self' blob: data:; worker-src 'self' blob:; "
    "connect-src 'self'; object-src 'none'; base-uri 'none'; form-action 'self'; frame-ancestors 'none'"
)
_HEADERS = {
    "X-Content-Type-Options": "nosniff",
    "X-Frame-Options": "DENY",
    "Referrer-Policy": "no-referrer",
    "Cross-Origin-Opener-Policy": "same-origin",
    "Cross-Origin-Resource-Policy": "same-origin",
    "Permissions-Policy": "camera=(), geolocation=(), microphone=()",
}
_YEAR_S = 31_536_000
_TOO_SLOW = "A request's body must come in time but did not; send it again"


class HeadersMiddleware:
    """Sets security headers on every answer, and `no-store` on what does not say how it may be cached."""

    def __init__(self, app: ASGIApp, is_https: bool) -> None:
        self._app = app
        self._is_https = is_https

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        if scope["type"] != "http":
            await self._app(scope, receive, send)
            return
        policy = _API_POLICY if scope["path"].startswith(API) else _PAGE_POLICY

        async def send_with_headers(message: Message) -> None:
            if message["type"] == "http.response.start":
                headers = MutableHeaders(scope=message)
                headers.update(_HEADERS)
                headers["Content-Security-Policy"] = policy
                headers.setdefault("Cache-Control", "no-store")
                if self._is_https:
                    headers["Strict-Transport-Security"] = f"max-age={_YEAR_S}"
            await send(message)

        await self._app(scope, receive, send_with_headers)


class FaultMiddleware:
    """Answers what nobody foresaw with a problem document that names an id; the traceback goes to the log only."""

    def __init__(self, app: ASGIApp) -> None:
        self._app = app

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        if scope["type"] != "http":
            await self._app(scope, receive, send)
            return
        has_begun = False

        async def noting_send(message: Message) -> None:
            nonlocal has_begun
            has_begun = has_begun or message["type"] == "http.response.start"
            await send(message)

        try:
            await self._app(scope, receive, noting_send)
        except Exception as error:
            response = fault_response(error, request_line(scope))
            if has_begun:  # too late for another answer: let the server cut the connection
                raise
            await response(scope, receive, send)


class BodyLimitMiddleware:
    """Refuses bodies that are too large: by Content-Length before reading, by counting where there is none.

    Parameters
    ----------
    max_bytes : of most requests. max_upload_bytes : of those whose whole path is like `upload_path`.
    """

    def __init__(self, app: ASGIApp, max_bytes: int, max_upload_bytes: int, upload_path: re.Pattern[str]) -> None:
        self._app = app
        self._max_bytes = max_bytes
        self._max_upload_bytes = max_upload_bytes
        self._upload_path = upload_path

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        if scope["type"] != "http":
            await self._app(scope, receive, send)
            return
        is_upload = self._upload_path.fullmatch(scope["path"])
        limit = self._max_upload_bytes if is_upload else self._max_bytes
        announced = dict(scope["headers"]).get(b"content-length", b"0")
        if not announced.isdigit() or int(announced) > limit:
            await self._refusal(announced, limit)(scope, receive, send)
            return
        received = 0

        async def counting_receive() -> Message:
            nonlocal received
            message = await receive()
            if message["type"] == "http.request":
                received += len(message.get("body", b""))
                if received > limit:
                    raise HTTPException(413, _too_large(limit))
            return message

        await self._app(scope, counting_receive, send)

    @staticmethod
    def _refusal(announced: bytes, limit: int) -> ASGIApp:
        if not announced.isdigit():
            return problem_response(ProblemKind.MALFORMED, "Content-Length must be a number.")
        return problem_response(ProblemKind.TOO_LARGE, f"{_too_large(limit)}.", headers={"Connection": "close"})


class BodyTimeMiddleware:
    """Gives up bodies that do not come: they are read before anybody knows whose they are.

    Parameters
    ----------
    idle_s : seconds of silence. total_s : seconds until the body is whole, but for requests whose whole path is like
        `upload_path`, which read theirs once they know the caller.
    """

    def __init__(self, app: ASGIApp, idle_s: float, total_s: float, upload_path: re.Pattern[str]) -> None:
        self._app = app
        self._idle_s = idle_s
        self._total_s = total_s
        self._upload_path = upload_path

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        if scope["type"] != "http":
            await self._app(scope, receive, send)
            return
        total_s = math.inf if self._upload_path.fullmatch(scope["path"]) else self._total_s
        until, is_whole = current_time() + total_s, False

        async def timely_receive() -> Message:
            nonlocal is_whole
            if is_whole:  # what comes now is that the client goes, whenever it likes
                return await receive()
            try:
                with fail_after(min(self._idle_s, until - current_time())):
                    message = await receive()
            except TimeoutError as error:
                raise HTTPException(408, _TOO_SLOW, {"Connection": "close"}) from error
            is_whole = not message.get("more_body", False)
            return message

        await self._app(scope, timely_receive, send)


def _too_large(limit: int) -> str:
    return f"A body may have at most {limit:,} bytes here; send less at a time"
