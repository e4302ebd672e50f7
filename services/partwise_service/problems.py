"""Problem documents (RFC 9457): every error answer of the service is one, `application/problem+json`.

`ProblemError` is what a handler raises; `install_problems` turns everything else that may be raised into a document,
which never tells a path, a database's words or a traceback: what nobody foresaw gets an id that is also in the log.
"""

import json
import logging
import secrets
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from enum import Enum
from http import HTTPStatus
from typing import Any

from fastapi import FastAPI, Request
from fastapi.exceptions import RequestValidationError
from fastapi.responses import JSONResponse
from sqlalchemy.exc import SQLAlchemyError
from starlette.exceptions import HTTPException

from partwise.errors import (
    ConfigError,
    ConflictError,
    FileFormatError,
    LabelError,
    MeshError,
    NotEnoughDataError,
    NotFoundError,
    ParameterError,
    PartwiseError,
    StoreError,
    WorkerError,
)

MEDIA_TYPE = "application/problem+json"
_log = logging.getLogger(__name__)


class ProblemKind(Enum):
    """Each kind of problem: the last part of its type, the status it comes with, and its title."""

    MALFORMED = ("malformed", 400, "The request cannot be read")
    UNAUTHENTICATED = ("unauthenticated", 401, "A valid token or session is needed")
    FORBIDDEN = ("forbidden", 403, "Your role does not allow this")
    FOREIGN_ORIGIN = ("foreign-origin", 403, "Pages of this origin may not do this")
    NOT_FOUND = ("not-found", 404, "There is no such thing")
    METHOD = ("method-not-allowed", 405, "This path does not take this method")
    TOO_SLOW = ("too-slow", 408, "The request took too long to come")
    CONFLICT = ("conflict", 409, "This contradicts what is committed")
    TOO_LARGE = ("too-large", 413, "The request's body is too large")
    MEDIA = ("unsupported-media-type", 415, "The request's body has the wrong type")
    INVALID = ("invalid", 422, "A value breaks a rule")
    TOO_MANY = ("too-many", 429, "Too many requests")
    FAULT = ("fault", 500, "A fault in the service")
    UNAVAILABLE = ("unavailable", 503, "A store cannot be reached")

    def __init__(self, slug: str, status: int, title: str) -> None:
        self.type = f"urn:partwise:problem:{slug}"
        self.status = status
        self.title = title


@dataclass(eq=False)
class ProblemError(Exception):
    """Raise it in a handler or dependency. `extensions` are further members of the document, such as both sides of a
    conflict; `detail` is one sentence for people.
    """

    kind: ProblemKind
    detail: str
    extensions: Mapping[str, Any] = field(default_factory=dict)
    headers: Mapping[str, str] = field(default_factory=dict)


class _ProblemResponse(JSONResponse):
    """JSON in ASCII: what was sent is told back as it came, also text that cannot be written as UTF-8."""

    media_type = MEDIA_TYPE

    def render(self, content: Any) -> bytes:
        return json.dumps(content, allow_nan=False, separators=(",", ":")).encode("ascii")


def problem_response(
    kind: ProblemKind,
    detail: str,
    extensions: Mapping[str, Any] | None = None,
    headers: Mapping[str, str] | None = None,
) -> JSONResponse:
    """The document as a response."""
    own = {"type": kind.type, "title": kind.title, "status": kind.status, "detail": detail}
    return _ProblemResponse(
        {**(extensions or {}), **own}, kind.status, {"Cache-Control": "no-store", **(headers or {})}
    )


def fault_response(error: BaseException, request_line: str) -> JSONResponse:
    """A fault, logged with its traceback under an id that the document names."""
    fault_id = secrets.token_hex(8)
    _log.error("fault", exc_info=error, extra={"fault_id": fault_id, "request": request_line})
    return problem_response(
        ProblemKind.FAULT,
        "The service met a fault that nobody foresaw; tell the operator the fault_id, which is in the log.",
        {"fault_id": fault_id},
    )


_KINDS: Sequence[tuple[type[PartwiseError], ProblemKind]] = (
    (NotFoundError, ProblemKind.NOT_FOUND),
    (ConflictError, ProblemKind.CONFLICT),
    (LabelError, ProblemKind.INVALID),
    (ParameterError, ProblemKind.INVALID),
    (MeshError, ProblemKind.INVALID),
    (FileFormatError, ProblemKind.INVALID),
    (NotEnoughDataError, ProblemKind.INVALID),
    (StoreError, ProblemKind.UNAVAILABLE),
    (WorkerError, ProblemKind.UNAVAILABLE),
)
_BY_STATUS = {
    400: ProblemKind.MALFORMED,
    401: ProblemKind.UNAUTHENTICATED,
    403: ProblemKind.FORBIDDEN,
    404: ProblemKind.NOT_FOUND,
    405: ProblemKind.METHOD,
    408: ProblemKind.TOO_SLOW,
    413: ProblemKind.TOO_LARGE,
    415: ProblemKind.MEDIA,
    429: ProblemKind.TOO_MANY,
}


def problem_of(error: PartwiseError, request_line: str) -> JSONResponse:
    """The answer to what the domain refuses. What names places on the server is logged, not told."""
    kind = next((kind for known, kind in _KINDS if isinstance(error, known)), ProblemKind.FAULT)
    if kind is ProblemKind.FAULT or isinstance(error, ConfigError):
        return fault_response(error, request_line)
    if kind is ProblemKind.UNAVAILABLE:
        fault_id = secrets.token_hex(8)
        _log.error("unavailable: %s", error, extra={"fault_id": fault_id, "request": request_line})
        detail = "What is stored cannot be reached or read now; try again, then tell the operator the fault_id."
        return problem_response(kind, detail, {"fault_id": fault_id}, {"Retry-After": "5"})
    if isinstance(error.__cause__, SQLAlchemyError):  # the message repeats the database's, with names of tables
        _log.warning("refused by the database: %s", error, extra={"request": request_line})
        return problem_response(kind, "The catalog must stay consistent and refused this; reload and try again.")
    return problem_response(kind, str(error))


def install_problems(app: FastAPI) -> None:
    """Makes every error answer of the app a problem document, except faults: see `FaultMiddleware`."""

    async def of_problem(_request: Request, error: Exception) -> JSONResponse:
        if not isinstance(error, ProblemError):
            raise error
        return problem_response(error.kind, error.detail, error.extensions, error.headers)

    async def of_domain(request: Request, error: Exception) -> JSONResponse:
        if not isinstance(error, PartwiseError):
            raise error
        return problem_of(error, request_line(request.scope))

    async def of_http(_request: Request, error: Exception) -> JSONResponse:
        if not isinstance(error, HTTPException):
            raise error
        kind = _BY_STATUS.get(error.status_code, ProblemKind.FAULT)
        return problem_response(kind, _http_detail(error), headers=error.headers)

    async def of_validation(_request: Request, error: Exception) -> JSONResponse:
        if not isinstance(error, RequestValidationError):
            raise error
        errors = [
            {"in": str(each["loc"][0]), "at": _pointer(each["loc"][1:]), "why": each["msg"]} for each in error.errors()
        ]
        first = errors[0] if errors else {"in": "request", "at": "", "why": "invalid"}
        detail = f"{first['in']} {first['at']}: {first['why']}"
        return problem_response(ProblemKind.INVALID, detail, {"errors": errors})

    app.add_exception_handler(ProblemError, of_problem)
    app.add_exception_handler(PartwiseError, of_domain)
    app.add_exception_handler(HTTPException, of_http)
    app.add_exception_handler(RequestValidationError, of_validation)


def request_line(scope: Mapping[str, Any]) -> str:
    """`GET /api/v1/shapes/7`, for the log: as one printable line, and without the query, which may hold secrets."""
    return f"{scope.get('method', '')} {scope.get('path', '')!a}"


def _http_detail(error: HTTPException) -> str:
    usual = HTTPStatus(error.status_code).phrase
    return f"{error.detail or usual}."


def _pointer(location: Sequence[str | int]) -> str:
    return "/".join(str(step) for step in location)
