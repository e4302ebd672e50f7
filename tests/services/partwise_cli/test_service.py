"""serve, token, reviews."""

import json
import os
import re
import signal
import socket
import subprocess
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from datetime import UTC, datetime, timedelta
from pathlib import Path

import httpx
import numpy as np
import psutil
import pytest

from partwise.errors import ConfigError, NotFoundError
from partwise.store.records import NewRevision, RevisionKind
from partwise.store.reviews import NewReview, ReviewReason
from partwise.workspace.workspace import open_workspace


@pytest.fixture
def waiting(described) -> Path:
    """A workspace in which labels of a.off, by eve, wait for a review."""
    with open_workspace(described) as workspace:
        catalog = workspace.catalog
        shape = catalog.shape_by_key(catalog.get_collection("mugs").id, "a.off")
        author = catalog.add_person("eve")
        revision = NewRevision(shape.id, shape.mesh_hash, RevisionKind.HUMAN, author.id, 1, np.ones(4, dtype=np.uint16))
        catalog.add_revision(revision, NewReview(ReviewReason.CHECK))
    return described


def test_a_new_token_is_shown_once_and_lets_its_person_in(invoke, empty) -> None:
    made = invoke("token", "create", empty, "--person", "ann", "--role", "reviewer", "--ttl", "2h", "-c", "mugs")
    with open_workspace(empty) as workspace:
        token = workspace.catalog.authenticate(made.stdout.strip())
        collection_id = workspace.catalog.get_collection("mugs").id
    assert (token.person_name, token.role, token.scope) == ("ann", "reviewer", (collection_id,))
    assert abs(token.expires_at - datetime.now(UTC) - timedelta(hours=2)) < timedelta(minutes=5)
    assert made.stdout.strip() not in invoke("token", "list", empty).stdout


def test_a_second_token_is_for_the_same_person(invoke, empty) -> None:
    for _ in range(2):
        invoke("token", "create", empty, "--person", "ann")
    with open_workspace(empty) as workspace:
        assert [person.name for person in workspace.catalog.list_people()] == ["ann"]


@pytest.mark.parametrize("ttl", ["", "d", "30", "3y", "-1d", "0d", "1.5h"])
def test_a_time_that_is_none_is_refused(invoke, empty, ttl) -> None:
    result = invoke("token", "create", empty, "--person", "ann", "--ttl", ttl)
    assert result.exit_code == 2
    assert "30d, 12h or 45m" in result.output


def test_a_token_for_a_collection_that_is_not(invoke, empty) -> None:
    result = invoke("token", "create", empty, "--person", "ann", "-c", "lamps")
    assert isinstance(result.exception, NotFoundError)


def test_a_revoked_token_has_ended(invoke, empty) -> None:
    secret = json.loads(invoke("token", "create", empty, "--person", "ann", "--json").stdout)["secret"]
    assert "has ended" in invoke("token", "revoke", empty, 1).stdout
    assert json.loads(invoke("token", "list", empty, "--json").stdout)[0]["revoked_at"] is not None
    with open_workspace(empty) as workspace:
        assert workspace.catalog.authenticate(secret) is None


def test_what_waits_for_review_is_listed(invoke, waiting) -> None:
    rows = json.loads(invoke("reviews", "list", waiting, "--json").stdout)
    assert [(row["shape"], row["reason"]) for row in rows] == [("a.off", "check")]


def test_accepting_a_review(invoke, waiting) -> None:
    review_id = json.loads(invoke("reviews", "list", waiting, "--json").stdout)[0]["id"]
    assert "accepted by rita" in invoke("reviews", "accept", waiting, review_id, "--person", "rita").stdout
    assert json.loads(invoke("reviews", "list", waiting, "--json").stdout) == []


def test_accepting_all_reviews_of_a_reason(invoke, waiting) -> None:
    options = ("--all", "--reason", "check", "--person", "rita")
    assert "1 review of reason check accepted by rita" in invoke("reviews", "accept", waiting, *options).stdout
    assert json.loads(invoke("reviews", "list", waiting, "--json").stdout) == []


@pytest.mark.parametrize("options", [(), ("1", "--all", "--reason", "check"), ("--all",), ("1", "--reason", "check")])
def test_one_review_or_all_of_a_reason_are_accepted(invoke, waiting, options) -> None:
    assert invoke("reviews", "accept", waiting, *options, "--person", "rita").exit_code == 2
    assert len(json.loads(invoke("reviews", "list", waiting, "--json").stdout)) == 1


def test_a_port_that_is_taken_is_named(invoke, empty) -> None:
    with socket.create_server(("127.0.0.1", 0)) as taken:
        port = taken.getsockname()[1]
        result = invoke("serve", empty, "--port", port)
    assert isinstance(result.exception, ConfigError)
    assert str(port) in str(result.exception)
    with open_workspace(empty) as workspace:
        assert workspace.catalog.tokens() == []


@contextmanager
def _serving(workspace: Path, *options: str) -> Iterator[tuple[subprocess.Popen, str]]:
    """A running `partwise serve`, and the first line that it prints; killed if the block leaves it running."""
    with socket.create_server(("127.0.0.1", 0)) as probe:
        port = probe.getsockname()[1]
    program = str(Path(sys.executable).with_name("partwise"))
    command = [program, "serve", str(workspace), "--port", str(port), "--person", "ada", *options]
    with subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True) as process:
        try:
            yield process, process.stdout.readline()
        finally:
            if process.poll() is None:
                process.kill()


@contextmanager
def _logged_in(address: str) -> Iterator[httpx.Client]:
    """A browser, logged in by the address that `serve` has printed."""
    origin, code = re.fullmatch(r"(http://\S+)/#code=(\S+)\n", address).groups()
    transport = httpx.HTTPTransport(retries=20)  # the socket listens already; the application may be starting
    with httpx.Client(base_url=f"{origin}/api/v1", transport=transport, timeout=60) as browser:
        assert browser.post("/login", json={"code": code}).status_code == 200
        yield browser


def test_the_address_that_serve_shows_logs_one_in_and_ctrl_c_ends_it(empty) -> None:
    with _serving(empty) as (process, address):
        with _logged_in(address) as browser:
            me = browser.get("/me").json()
        assert (me["name"], me["role"], me["is_session"]) == ("ada", "admin", True)
        process.send_signal(signal.SIGINT)
        assert (process.wait(60), process.stderr.read()) == (0, "")


def _served_by(process: subprocess.Popen) -> set[int]:
    """Ids of the processes that serve."""
    running = (each for each in psutil.Process(process.pid).children() if each.status() != psutil.STATUS_ZOMBIE)
    return {each.pid for each in running if "spawn_main" in " ".join(each.cmdline())}


@pytest.mark.parametrize("how", [signal.SIGINT, signal.SIGTERM])
def test_several_processes_let_one_in_and_end_together(empty, how) -> None:
    with _serving(empty, "--processes", "2") as (process, address):
        with _logged_in(address) as browser:
            cookies = dict(browser.cookies)
            for _ in range(8):  # each on a connection of its own, which either process takes
                with httpx.Client(base_url=browser.base_url, cookies=cookies, timeout=60) as again:
                    assert again.get("/me").json()["name"] == "ada"
        serving = _served_by(process)
        assert len(serving) == 2
        process.send_signal(how)
        assert (process.wait(60), process.stderr.read()) == (0, "")
        assert not any(psutil.pid_exists(each) for each in serving)


def test_a_process_that_is_killed_is_started_again(empty) -> None:
    with _serving(empty, "--processes", "2") as (process, address), _logged_in(address):
        killed = _served_by(process).pop()
        os.kill(killed, signal.SIGKILL)
        while killed in (serving := _served_by(process)) or len(serving) < 2:
            psutil.wait_procs(psutil.Process(process.pid).children(), timeout=0.05)
        process.terminate()
        assert process.wait(60) == 0


def test_processes_end_with_the_one_that_started_them(empty) -> None:
    with _serving(empty, "--processes", "2") as (process, address), _logged_in(address):
        serving = [psutil.Process(each) for each in _served_by(process)]
        process.kill()
        _, left = psutil.wait_procs(serving, timeout=60)
    assert left == []
