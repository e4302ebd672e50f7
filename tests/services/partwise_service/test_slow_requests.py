"""Requests that come slowly or not at all are given up, through a real server; those that are whole may take long."""

import json
import socket
from contextlib import ExitStack, closing
from datetime import UTC, datetime, timedelta
from urllib.parse import urlsplit

import httpx
import pytest

from partwise.store.records import NewToken, Role
from partwise.testing.waiting import WITHIN_S, wait_until
from partwise_service.settings import ServiceSettings

IDLE_S = 0.2


@pytest.fixture
def settings(mugs) -> ServiceSettings:
    return ServiceSettings(workspace=mugs.path, request_idle_s=IDLE_S, request_total_s=1.0, max_connections=3)


def _connected(url: str) -> socket.socket:
    return socket.create_connection(("127.0.0.1", urlsplit(url).port), WITHIN_S)


def _all_of(line: socket.socket) -> bytes:
    """What comes until the other side ends the connection."""
    return b"".join(iter(lambda: line.recv(65_536), b""))


def _head(n_bytes: int) -> bytes:
    about = f"Host: x\r\nContent-Type: application/json\r\nContent-Length: {n_bytes}"
    return f"POST /api/v1/login HTTP/1.1\r\n{about}\r\n\r\n".encode()


@pytest.mark.parametrize("sent", [b"", b"GET /api", b"GET /api/v1/me HTTP/1.1\r\nHost: x\r\n"])
def test_a_connection_on_which_no_request_comes_is_ended(served, sent) -> None:
    with _connected(served) as line:
        line.sendall(sent)
        assert _all_of(line) == b""


def test_a_connection_is_ended_though_an_answer_was_had_and_something_comes(served) -> None:
    with _connected(served) as line:
        line.sendall(b"GET /api/v1/me HTTP/1.1\r\nHost: x\r\n\r\nGET /api")
        assert _all_of(line).startswith(b"HTTP/1.1 401")


def test_a_body_that_stops_is_given_up_before_anybody_is_known(served) -> None:
    with _connected(served) as line:
        line.sendall(_head(100) + b'{"code"')
        head, _, body = _all_of(line).partition(b"\r\n\r\n")
    assert head.startswith(b"HTTP/1.1 408")
    assert json.loads(body)["type"] == "urn:partwise:problem:too-slow"


def test_a_body_that_never_ends_is_given_up(served) -> None:
    with _connected(served) as line:
        line.sendall(_head(1_000_000))
        line.settimeout(IDLE_S / 4)
        answer = b""
        while not answer:
            line.sendall(b" ")
            try:
                answer = line.recv(65_536)
            except TimeoutError:
                continue
    assert answer.startswith(b"HTTP/1.1 408")


def test_a_stream_of_events_may_be_silent(served, app, mugs) -> None:
    catalog = app.state.service.workspace.catalog
    new = NewToken(catalog.add_person("ann").id, Role.ANNOTATOR, datetime.now(UTC) + timedelta(days=1))
    headers = {"Authorization": f"Bearer {catalog.issue_token(new, 'test').secret}"}
    with httpx.stream("GET", f"{served}/events", headers=headers, timeout=WITHIN_S) as stream:
        lines = stream.iter_lines()
        assert "event: begin" in lines
        with _connected(served) as line:
            assert _all_of(line) == b""  # by now a connection without a request is over
        claim = {"collection_id": mugs.collection_id}
        assert httpx.post(f"{served}/queue/claim", headers=headers, json=claim).status_code == 200
        assert "event: queue" in lines


def test_more_connections_than_it_takes_are_told_to_come_back(served) -> None:
    request = b"GET /api/v1/me HTTP/1.1\r\nHost: x\r\nConnection: close\r\n\r\n"
    with ExitStack() as opened:
        for _ in range(2):
            line = opened.enter_context(closing(_connected(served)))
            line.sendall(_head(100) + b"{")  # each is answered once it is given up
        with _connected(served) as line:
            line.sendall(request)
            assert _all_of(line).startswith(b"HTTP/1.1 503")

    def is_served() -> bool:
        with _connected(served) as line:
            line.sendall(request)
            return _all_of(line).startswith(b"HTTP/1.1 401")

    wait_until(is_served)
