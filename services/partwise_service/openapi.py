"""The OpenAPI document, with every problem that every operation may answer with."""

from collections.abc import Sequence
from typing import Any

from fastapi import FastAPI
from fastapi.openapi.utils import get_openapi

from partwise_service.problems import MEDIA_TYPE, ProblemKind

_METHODS = frozenset({"get", "put", "post", "delete", "patch"})
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
        }
    for operations in document.get("paths", {}).values():
        for method, operation in operations.items():
            if method in _METHODS:
                responses = operation.setdefault("responses", {})
                responses.update({str(s): {"$ref": f"#/components/responses/Problem{s}"} for s in by_status})
    return document


def _schema(status: int, kinds: Sequence[ProblemKind]) -> dict[str, Any]:
    fields = {
        **_PROBLEM_FIELDS,
        "type": {"type": "string", "enum": [kind.type for kind in kinds]},
        "status": {"type": "integer", "enum": [status]},
    }
    return {"type": "object", "properties": fields, "required": ["type", "title", "status", "detail"]}
