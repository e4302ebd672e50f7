"""`AnswerRoute`: a handler's answer becomes JSON on the handler's own thread. `waits_for_arrays`: in which places."""

from collections.abc import Callable
from functools import partial, wraps
from inspect import iscoroutinefunction
from typing import Any

from fastapi import Response
from fastapi.routing import APIRoute
from pydantic import BaseModel

from partwise_service.array_places import in_array_place

_JSON = "application/json"


class AnswerRoute(APIRoute):
    """A route whose plain `def` handler returns a schema, which was validated when it was made and is not again.

    The framework would look at each answer a second time, on another visit to the thread pool, which costs more than
    making most answers does. Handlers that return a response, or are `async`, are left alone.
    """

    def __init__(self, path: str, endpoint: Callable[..., Any], **options: Any) -> None:
        is_plain = not iscoroutinefunction(endpoint)
        super().__init__(path, _encoding(endpoint, options.get("status_code")) if is_plain else endpoint, **options)


def waits_for_arrays(endpoint: Callable[..., Any]) -> Callable[..., Any]:
    """A plain handler or dependency that reads or writes arrays, so that it runs in one of the places for that.

    It goes below the router's decorator. The answer has status 200, or none is returned.
    """
    encoded = _encoding(endpoint, None)

    @wraps(endpoint)
    async def placed(**arguments: Any) -> Any:
        return await in_array_place(partial(encoded, **arguments))

    return placed


def _encoding(endpoint: Callable[..., Any], status_code: int | None) -> Callable[..., Any]:
    """The handler, returning its answer as a response with headers that it has set on a `Response` it was given."""

    @wraps(endpoint)
    def encoded(**arguments: Any) -> Any:
        answer = endpoint(**arguments)
        if not isinstance(answer, BaseModel):
            return answer
        response = json_answer(answer, status_code or 200)
        for given in arguments.values():
            if isinstance(given, Response):
                response.headers.raw.extend(given.headers.raw)
        return response

    return encoded


def json_answer(answer: BaseModel, status_code: int = 200) -> Response:
    """The answer as it is sent."""
    return Response(answer.__pydantic_serializer__.to_json(answer), status_code, media_type=_JSON)
