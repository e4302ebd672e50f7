"""Bodies compressed as callers take them, and what is left as it is."""

import asyncio
import gzip
import json

import pytest
from numcodecs.zstd import decompress

from partwise.store.records import EventKind, NewEvent
from partwise_service.compression import MIN_BYTES, CompressionMiddleware, accepted_coding
from partwise_service.settings import ServiceSettings


@pytest.fixture
def settings(mugs) -> ServiceSettings:
    """Streams of events end once they have told what there is."""
    return ServiceSettings(workspace=mugs.path, event_stream_s=0.0)


def _raw(client, caller, path: str, accept: str):
    with client.stream("GET", f"/api/v1{path}", headers={**caller.headers, "Accept-Encoding": accept}) as answer:
        return answer.headers, b"".join(answer.iter_raw())


@pytest.mark.parametrize(
    ("accept", "coding"),
    [
        ("gzip, deflate, br, zstd", "zstd"), ("gzip", "gzip"), ("*", "gzip"), ("", None), ("br", None),
        ("zstd;q=0, gzip", "gzip"), ("gzip; q=0", None), ("*;q=0", None), ("GZIP;q=0.5", "gzip"),
    ],
)  # fmt: skip
def test_the_coding_is_one_that_the_caller_takes(accept: str, coding: str | None) -> None:
    assert accepted_coding(accept) == coding


@pytest.mark.parametrize(
    ("accept", "coding", "undo"),
    [("zstd", "zstd", decompress), ("gzip", "gzip", gzip.decompress), ("identity", None, bytes)],
)
def test_json_is_compressed(client, annotator, accept, coding, undo) -> None:
    headers, body = _raw(client, annotator, "/openapi.json", accept)
    assert headers.get("content-encoding") == coding
    assert headers["content-length"] == str(len(body))
    assert json.loads(undo(body))["openapi"].startswith("3.")
    assert "Accept-Encoding" in headers["vary"]


def test_short_answers_are_left_as_they_are(client, annotator) -> None:
    headers, body = _raw(client, annotator, "/me", "gzip, zstd")
    assert "content-encoding" not in headers
    assert json.loads(body)


def test_streams_of_events_are_not_held_back(client, annotator, workspace, mugs) -> None:
    for n in range(100):
        workspace.catalog.add_event(NewEvent(EventKind.STAGE, mugs.collection_id, {"n": n}))
    headers, body = _raw(client, annotator, "/events?after=1", "gzip, zstd")
    assert "content-encoding" not in headers
    assert len(body) > MIN_BYTES


@pytest.mark.parametrize("message", [{"more_body": True}, {}])
def test_json_in_pieces_goes_by_as_it_is(message) -> None:
    sent = []

    async def app(scope, receive, send) -> None:
        await send({"type": "http.response.start", "status": 200, "headers": [(b"content-type", b"application/json")]})
        await send({"type": "http.response.body", "body": b" " * 5_000, **message})

    async def send(each) -> None:
        sent.append(each)

    scope = {"type": "http", "headers": [(b"accept-encoding", b"gzip")]}
    asyncio.run(CompressionMiddleware(app)(scope, None, send))
    is_coded = (b"content-encoding", b"gzip") in sent[0]["headers"]
    assert is_coded == (not message)
    assert (len(sent[1]["body"]) < 5_000) == is_coded
