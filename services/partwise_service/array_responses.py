"""Arrays as safetensors and pictures as PNG, with entity tags, compressed where the caller takes that."""

import hashlib
from collections.abc import Mapping
from typing import Any

import numpy as np
from fastapi import Request, Response
from safetensors.numpy import save

from partwise_service.compression import MIN_BYTES, accepted_coding, allowed_codings, compressed
from partwise_service.response_headers import ETAG

SAFETENSORS = "application/vnd.safetensors"
IMMUTABLE = "private, max-age=31536000, immutable"
"""Of what is addressed by its content."""
REVALIDATE = "private, no-cache"
"""Of what may change: the caller keeps it and asks whether its tag still holds."""

SAFETENSORS_RESPONSES: dict[int | str, dict[str, Any]] = {
    200: {"content": {SAFETENSORS: {"schema": {"type": "string", "format": "binary"}}}, "headers": ETAG},
    304: {"description": "What the caller holds is current", "headers": ETAG},
}
PNG_RESPONSES: dict[int | str, dict[str, Any]] = {
    200: {"content": {"image/png": {"schema": {"type": "string", "format": "binary"}}}, "headers": ETAG},
    304: {"description": "What the caller holds is current", "headers": ETAG},
}


def entity_tag(*what: object) -> str:
    """A weak tag (compressed or not, it is the same entity) from all that shapes the content."""
    return f'W/"{hashlib.sha256(repr(what).encode()).hexdigest()[:40]}"'


def not_modified(request: Request, tag: str, cache: str = REVALIDATE) -> Response | None:
    """The answer if the caller holds this entity already, else None."""
    held = {each.strip().removeprefix("W/") for each in request.headers.get("if-none-match", "").split(",")}
    if tag.removeprefix("W/") in held or "*" in held:
        return Response(status_code=304, headers=_headers(tag, cache))
    return None


def safetensors_response(
    request: Request,
    arrays: Mapping[str, np.ndarray],
    tag: str,
    cache: str = REVALIDATE,
    metadata: Mapping[str, str] | None = None,
) -> Response:
    """The arrays as one safetensors file, compressed if the caller takes that."""
    # safetensors writes an array's memory as it lies
    data = save({name: np.ascontiguousarray(array) for name, array in arrays.items()}, dict(metadata or {}))
    headers = _headers(tag, cache)
    coding = accepted_coding(request.headers.get("accept-encoding", ""))
    if coding is not None and len(data) >= MIN_BYTES:
        data = compressed(data, coding)
        headers["Content-Encoding"] = coding
    return Response(data, media_type=SAFETENSORS, headers=headers)


def png_response(data: bytes, tag: str, cache: str = REVALIDATE) -> Response:
    """A PNG file."""
    return Response(data, media_type="image/png", headers={"ETag": tag, "Cache-Control": cache})


def _headers(tag: str, cache: str) -> dict[str, str]:
    return {"ETag": tag, "Cache-Control": cache, "Vary": "Accept-Encoding"}


def takes_coding(request: Request, wanted: str) -> bool:
    """Whether the caller takes bodies of this content coding."""
    allowed = allowed_codings(request.headers.get("accept-encoding", ""))
    return allowed.get(wanted, allowed.get("*", False))
