"""Headers that answers come with, as the document tells them."""

from typing import Any

Headers = dict[str, dict[str, Any]]

ETAG: Headers = {
    "ETag": {
        "description": "Tells this entity from all others; goes into `If-None-Match`.",
        "required": True,
        "schema": {"type": "string"},
    }
}
DRAFT_ETAG: Headers = {
    "ETag": {
        "description": "The draft's number of strokes; goes into `If-Match` of its confirmation.",
        "required": True,
        "schema": {"type": "string", "pattern": '^"[0-9]+"$'},
    }
}
RETRY_AFTER: Headers = {
    "Retry-After": {
        "description": "In how many seconds the same may be asked again, where that is known.",
        "schema": {"type": "integer", "minimum": 0},
    }
}
WWW_AUTHENTICATE: Headers = {
    "WWW-Authenticate": {"description": "How a request proves who sends it.", "schema": {"type": "string"}}
}

OF_DRAFT: dict[int | str, dict[str, Any]] = {200: {"headers": DRAFT_ETAG}}
"""For `responses` of a route that answers with a draft's tag."""
