"""`AnswerRoute`: a handler's answer becomes JSON on the handler's own thread."""

from collections.abc import Callable
from functools import wraps
from inspect import iscoroutinefunction
from typing import Any

from fastapi import Response
from fastapi.routing import APIRoute
from pydantic import BaseModel

_JSON = "application/json"


class AnswerRoute(APIRoute):
    """A route whose plain `def` handler returns a schema, which was validated when it was made and is not again.

    The framework would look at each answer a second time, on another visit to the thread pool, which costs more than
    making most answers does. Handlers that return a response, or are `async`, are left alone.
    """

    def __init__(self, path: str, endpoint: Callable[..., Any], **options: Any) -> None:
        is_plain = not iscoroutinefunction(endpoint)
        super().__init__(path, _encoding(endpoint, options.get("status_code")) if is_plain else endpoint, **options)


def _encoding(endpoint: Callable[..., Any], status_code: int | None) -> Callable[..., Any]:
    """The handler, returning its answer as a response with headers that it has set on a `Response` it was given."""

    @wraps(endpoint)
    def encoded(**arguments: Any) -> Any:
        answer = endpoint(**arguments)
        if not isinstance(answer, BaseModel):
            return answer
        response = Response(answer.__pydantic_serializer__.to_json(answer), status_code or 200, media_type=_JSON)
        for given in arguments.values():
            if isinstance(given, Response):
                response.headers.raw.extend(given.headers.raw)
        return response

    return encoded
