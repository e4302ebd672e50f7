"""Tools through a real server: a client that hangs up takes its call out of the line."""

import socket
import threading
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager
from dataclasses import replace
from datetime import UTC, datetime, timedelta

import httpx
import pytest

from partwise.store.records import NewToken, Role
from partwise.testing.waiting import WITHIN_S, wait_until
from partwise_service.settings import ServiceSettings
from partwise_service.tool_pool import answer_calls

N_THREADS = 3


@pytest.fixture
def settings(mugs) -> ServiceSettings:
    return ServiceSettings(workspace=mugs.path, tool_processes=1, threads=N_THREADS)


def test_a_client_that_hangs_up_takes_its_call_out_of_the_line(served, app, mugs) -> None:
    service = app.state.service
    catalog, tools = service.workspace.catalog, service.tools
    headers = _headers(catalog)
    path, body = f"/shapes/{mugs.ids['b.off']}/patches", {"n_patches": 5, "method": "k_means"}
    process = tools._idle.popleft()  # busy with something that takes long
    with _asked(served, headers, path, body):
        wait_until(lambda: tools.n_waiting == 1)
    wait_until(lambda: tools.n_waiting == 0)
    tools._idle.append(process)
    with httpx.Client(base_url=served, headers=headers, timeout=WITHIN_S) as client:
        answer = client.post(path, json=body)
    assert (answer.status_code, answer.json()["n_faces"]) == (200, mugs.meshes["b.off"].n_faces)
    assert tools.n_idle == 1


def test_people_go_on_while_tools_wait_for_a_big_shape(served, app, mugs) -> None:
    service = app.state.service
    catalog, tools = service.workspace.catalog, service.tools
    path, body = f"/shapes/{mugs.ids['b.off']}/patches", {"n_patches": 5, "method": "k_means"}
    process = tools._idle.popleft()  # busy with something that takes long
    with ExitStack() as waiting:
        for place in range(2 * N_THREADS):
            waiting.enter_context(_asked(served, _headers(catalog, f"waiting {place}"), path, body))
        wait_until(lambda: tools.n_waiting == 2 * N_THREADS)
        with httpx.Client(base_url=served, headers=_headers(catalog), timeout=WITHIN_S) as client:
            claimed = client.post("/queue/claim", json={"collection_id": mugs.collection_id})
            assert claimed.status_code == 200
            draft = client.post(f"/leases/{claimed.json()['items'][0]['id']}/draft", json={})
        assert draft.status_code in (200, 201)
        assert tools.n_waiting == 2 * N_THREADS
    wait_until(lambda: tools.n_waiting == 0)
    tools._idle.append(process)


def test_a_client_that_hangs_up_ends_its_call_that_runs(served, app, mugs) -> None:
    service = app.state.service
    catalog, tools = service.workspace.catalog, service.tools
    tools.limits = replace(tools.limits, abandoned_s=0.01)
    process = tools._processes[0]
    process._answering = never_answer
    headers = _headers(catalog)
    path, body = f"/shapes/{mugs.ids['b.off']}/patches", {"n_patches": 5, "method": "k_means"}
    with _asked(served, headers, path, body):
        wait_until(lambda: tools.n_idle == 0)
    wait_until(lambda: tools.n_idle == 1)
    process._answering = answer_calls
    with httpx.Client(base_url=served, headers=headers, timeout=WITHIN_S) as client:
        assert client.post(path, json=body).status_code == 200


def never_answer(connection, _array_url: str, _max_prepared: int) -> None:
    """The life of a tool's process that is at its call for ever."""
    connection.recv()
    threading.Event().wait()


def _headers(catalog, name: str = "ann") -> dict[str, str]:
    new = NewToken(catalog.add_person(name).id, Role.ANNOTATOR, datetime.now(UTC) + timedelta(days=1))
    return {"Authorization": f"Bearer {catalog.issue_token(new, 'test').secret}", "Accept": "application/json"}


@contextmanager
def _asked(url: str, headers: dict, path: str, body: dict) -> Iterator[None]:
    """A request that was sent, whose client hangs up without having read an answer."""
    address = httpx.URL(url)
    request = httpx.Client().build_request("POST", url + path, headers=headers, json=body)
    lines = [f"POST {address.path}{path} HTTP/1.1", *(f"{name}: {value}" for name, value in request.headers.items())]
    with socket.create_connection((address.host, address.port), timeout=WITHIN_S) as connection:
        connection.sendall("\r\n".join([*lines, "", ""]).encode() + request.content)
        yield
