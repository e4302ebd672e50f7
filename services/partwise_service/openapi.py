"""The OpenAPI document, with every problem that every operation may answer with, and what tags and retries need.

A route says under `responses` what its problems tell beyond the common members: `{409: {"model": EndedLease}}`.
"""

from collections.abc import Mapping, Sequence
from typing import Any

from fastapi import FastAPI
from fastapi.openapi.utils import get_openapi

from partwise_service.problems import MEDIA_TYPE, ProblemKind
from partwise_service.response_headers import RETRY_AFTER, WWW_AUTHENTICATE, Headers

_METHODS = frozenset({"get", "put", "post", "delete", "patch"})
_HEADERS: Mapping[int, Headers] = {401: WWW_AUTHENTICATE, 429: RETRY_AFTER, 503: RETRY_AFTER}
_IF_NONE_MATCH = {
    "name": "If-None-Match",
    "in": "header",
    "required": False,
    "schema": {"type": "string"},
    "description": "Tags of what the caller holds, as `ETag` told them: 304 if one is current.",
}
_PROBLEM_FIELDS = {
    "type": {"type": "string", "format": "uri"},
    "title": {"type": "string", "description": "What kind of problem it is, in words."},
    "status": {"type": "integer"},
    "detail": {"type": "string", "description": "What is wrong here and what to do, in one sentence."},
    "fault_id": {"type": "string", "description": "Of a fault: under which id it is in the service's log."},
    "errors": {
        "type": "array",
        "description": "Of an invalid request: what is wrong where.",
        "items": {
            "type": "object",
            "properties": {"in": {"type": "string"}, "at": {"type": "string"}, "why": {"type": "string"}},
            "required": ["in", "at", "why"],
        },
    },
}


def install_openapi(app: FastAPI) -> None:
    """Gives the app a document in which each operation names all its problems. Made on first use."""

    def document() -> dict[str, Any]:
        if app.openapi_schema is None:
            made = get_openapi(title=app.title, version=app.version, description=app.description, routes=app.routes)
            app.openapi_schema = _with_problems(made)
        return app.openapi_schema

    app.openapi = document  # type: ignore[method-assign] # as FastAPI's documentation says


def _with_problems(document: dict[str, Any]) -> dict[str, Any]:
    components = document.setdefault("components", {})
    schemas = components.setdefault("schemas", {})
    for unused in ("HTTPValidationError", "ValidationError"):
        schemas.pop(unused, None)
    by_status: dict[int, list[ProblemKind]] = {}
    for kind in ProblemKind:
        by_status.setdefault(kind.status, []).append(kind)
    for status, kinds in by_status.items():
        schemas[f"Problem{status}"] = _schema(status, kinds)
        components.setdefault("responses", {})[f"Problem{status}"] = {
            "description": " or ".join(kind.title for kind in kinds),
            "content": {MEDIA_TYPE: {"schema": {"$ref": f"#/components/schemas/Problem{status}"}}},
            "headers": _HEADERS.get(status, {}),
        }
    for operations in document.get("paths", {}).values():
        for method, operation in operations.items():
            if method in _METHODS:
                responses = operation.setdefault("responses", {})
                responses.update({str(status): _problem(status, responses.get(str(status))) for status in by_status})
                if "304" in responses:
                    operation.setdefault("parameters", []).append(_IF_NONE_MATCH)
    return document


def _problem(status: int, own: Mapping[str, Any] | None) -> dict[str, Any]:
    """The response of an operation to a problem: the common one, or with members of its own, where the route has some.

    own : what the framework made of the route's `responses`. What it adds by itself of invalid requests is ours to say.
    """
    common = f"#/components/responses/Problem{status}"
    if own is None:
        return {"$ref": common}
    extension = own.get("content", {}).get("application/json", {}).get("schema")
    if extension is None or extension.get("$ref", "").endswith("/HTTPValidationError"):
        return {"$ref": common}
    plain = {"$ref": f"#/components/schemas/Problem{status}"}
    schema = {"anyOf": [{"allOf": [plain, extension]}, plain]}
    return {"description": own["description"], "content": {MEDIA_TYPE: {"schema": schema}}}


def _schema(status: int, kinds: Sequence[ProblemKind]) -> dict[str, Any]:
    fields = {
        **_PROBLEM_FIELDS,
        "type": {"type": "string", "enum": [kind.type for kind in kinds]},
        "status": {"type": "integer", "enum": [status]},
    }
    return {"type": "object", "properties": fields, "required": ["type", "title", "status", "detail"]}
