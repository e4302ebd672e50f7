"""`PageRoute`: everything outside /api/ is the annotation page, from the files that the client's build has made.

A path names a file of the build or is a place within the page, which is `index.html` again. Files under /assets/ carry
a hash of their content in their names, so they may be kept for ever; the build's .br and .gz copies go to whoever takes
them.
"""

from collections.abc import Mapping
from html import escape
from pathlib import Path

from fastapi import FastAPI, Request, Response
from fastapi.responses import FileResponse, HTMLResponse
from starlette.concurrency import run_in_threadpool
from starlette.exceptions import HTTPException
from starlette.routing import BaseRoute, Match
from starlette.types import Receive, Scope, Send

from partwise_service.array_responses import entity_tag, not_modified, takes_coding
from partwise_service.security.middleware import API

INDEX = "index.html"
ASSETS = "assets"
ASSET_CACHE = "public, max-age=31536000, immutable"
PAGE_CACHE = "no-cache"
_CODINGS: Mapping[str, str] = {"br": ".br", "gzip": ".gz"}
"""Codings in order of preference, and how the names of such copies end."""
_METHODS = ("GET", "HEAD")
_UTF8 = "; charset=utf-8"
MEDIA_TYPES: Mapping[str, str] = {
    ".css": f"text/css{_UTF8}",
    ".html": f"text/html{_UTF8}",
    ".ico": "image/vnd.microsoft.icon",
    ".js": f"text/javascript{_UTF8}",
    ".json": "application/json",
    ".map": "application/json",
    ".mjs": f"text/javascript{_UTF8}",
    ".png": "image/png",
    ".svg": "image/svg+xml",
    ".txt": f"text/plain{_UTF8}",
    ".wasm": "application/wasm",
    ".webmanifest": "application/manifest+json",
    ".webp": "image/webp",
    ".woff2": "font/woff2",
}
"""By suffix, never by content; what is not here is only bytes."""
_NOT_BUILT = """<!doctype html>
<html lang="en">
<meta charset="utf-8">
<title>Partwise</title>
<h1>The page has not been built</h1>
<p>The service runs and answers under <code>/api/v1</code>, but {folder} has no files of the page.
<p>In a checkout of Partwise, <code>make web</code> builds them; then load this page again.
</html>
"""


class PageRoute(BaseRoute):
    """Answers GET and HEAD of every path outside /api/.

    folder : what the client's build has made; it may come to be while the service runs.
    """

    def __init__(self, folder: Path) -> None:
        self._folder = folder

    def matches(self, scope: Scope) -> tuple[Match, Scope]:
        is_page = scope["type"] == "http" and not f"{scope['path']}/".startswith(API)
        return (Match.FULL if is_page else Match.NONE), {}

    async def handle(self, scope: Scope, receive: Receive, send: Send) -> None:
        if scope["method"] not in _METHODS:
            raise HTTPException(405, headers={"Allow": ", ".join(_METHODS)})
        response = await run_in_threadpool(self._answer, Request(scope, receive))
        await response(scope, receive, send)

    def _answer(self, request: Request) -> Response:
        steps = request.scope["path"].strip("/").split("/")
        found = _file(self._folder, steps)
        if found is not None and steps != [INDEX]:
            return _file_response(request, found, ASSET_CACHE if steps[0] == ASSETS else PAGE_CACHE)
        if steps[0] == ASSETS:  # of an older build: a page in its place would be run as a script
            raise HTTPException(404)
        index = _file(self._folder, [INDEX])
        if index is None:
            body = "" if request.method == "HEAD" else _NOT_BUILT.format(folder=escape(self._folder.name))
            return HTMLResponse(body, headers={"Cache-Control": PAGE_CACHE})
        return _file_response(request, index, PAGE_CACHE)


def install_page(app: FastAPI, folder: Path) -> None:
    """Serves the page beside the API. Called after all routes of the API are there."""
    app.router.routes.append(PageRoute(folder))


def _file(folder: Path, steps: list[str]) -> Path | None:
    """The file of the build that a path's steps name; None if there is none, whatever else they may mean."""
    if any(step.startswith(".") or not step.isprintable() or not step or "\\" in step or ":" in step for step in steps):
        return None
    path = folder.joinpath(*steps)
    try:
        is_inside = path.resolve().is_relative_to(folder.resolve())  # links out of it lead nowhere
        return path if is_inside and path.is_file() else None
    except OSError:  # such as a name that is too long
        return None


def _file_response(request: Request, path: Path, cache: str) -> Response:
    status = path.stat()
    tag = entity_tag("page", path.name, status.st_mtime_ns, status.st_size)
    held = not_modified(request, tag, cache)
    if held is not None:
        return held
    headers = {"ETag": tag, "Cache-Control": cache, "Vary": "Accept-Encoding"}
    sent = path
    for coding, ending in _CODINGS.items():
        copy = path.with_name(path.name + ending)
        if takes_coding(request, coding) and copy.is_file():
            sent = copy
            headers["Content-Encoding"] = coding
            break
    return FileResponse(sent, media_type=MEDIA_TYPES.get(path.suffix, "application/octet-stream"), headers=headers)
