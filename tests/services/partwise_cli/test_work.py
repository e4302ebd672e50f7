"""work and up: what they say and how they end."""

import re
import signal
import socket
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import httpx
import psutil
import pytest

from partwise.errors import NotFoundError, ParameterError
from partwise.store.records import JobKind, JobState
from partwise.workspace.workspace import open_workspace

PARTWISE = str(Path(sys.executable).with_name("partwise"))


def _enqueue(path: Path, kind: JobKind) -> int:
    with open_workspace(path) as workspace:
        return workspace.catalog.enqueue_job(workspace.catalog.get_collection("mugs").id, kind).id


def _state(path: Path, job_id: int) -> JobState:
    with open_workspace(path) as workspace:
        return workspace.catalog.job(job_id).state


def test_once_ends_when_nothing_waits(invoke, described: Path) -> None:
    job_id = _enqueue(described, JobKind.REFILL)
    result = invoke("work", described, "--once")
    assert result.exit_code == 0
    assert f"job {job_id}, refill of collection 1: running" in result.stderr
    assert f"job {job_id}, refill of collection 1: done: the queue has as many places" in result.stderr
    assert _state(described, job_id) is JobState.DONE


def test_other_kinds_and_collections_are_left(invoke, described: Path) -> None:
    job_id = _enqueue(described, JobKind.REFILL)
    assert invoke("work", described, "--once", "--kinds", "train, export").exit_code == 0
    assert _state(described, job_id) is JobState.PENDING


@pytest.mark.parametrize(
    ("options", "error"),
    [
        (("--kinds", "dance"), ParameterError),
        (("--kinds", ""), ParameterError),
        (("--collection", "vases"), NotFoundError),
    ],
)
def test_what_is_not_there_is_refused(invoke, described: Path, options, error) -> None:
    assert isinstance(invoke("work", described, "--once", *options).exception, error)


def test_sigterm_ends_a_worker_cleanly(described: Path) -> None:
    with subprocess.Popen([PARTWISE, "work", described], stderr=subprocess.PIPE, text=True) as process:
        assert "waits for jobs" in process.stderr.readline()
        process.send_signal(signal.SIGTERM)
        assert process.wait(timeout=60) == 0


@pytest.fixture
def up(described: Path) -> Iterator["subprocess.Popen[str]"]:
    with socket.create_server(("127.0.0.1", 0)) as free:
        port = free.getsockname()[1]
    command = [PARTWISE, "up", str(described), "--port", str(port)]
    with subprocess.Popen(command, stdout=subprocess.PIPE, text=True, bufsize=1) as process:
        yield process
        if process.poll() is None:
            process.kill()


def _read_until(process: "subprocess.Popen[str]", text: str) -> list[str]:
    lines: list[str] = []
    for line in process.stdout:
        lines.append(line)
        if text in line:
            return lines
    raise AssertionError(f"{text!r} was never said: {lines}")


def test_up_serves_and_works_and_ends_both(described: Path, up: "subprocess.Popen[str]") -> None:
    job_id = _enqueue(described, JobKind.REFILL)
    said = _read_until(up, f"job {job_id}, refill of collection 1: done")
    address = re.search(r"service \| (http://127.0.0.1:\d+)/#code=", "".join(said))
    assert address is not None
    assert httpx.get(f"{address[1]}/api/v1/openapi.json").status_code == 200
    children = psutil.Process(up.pid).children(recursive=True)
    up.send_signal(signal.SIGTERM)
    assert up.wait(timeout=60) == 0
    assert not any(child.is_running() for child in children)
    assert "code=" not in up.stdout.read()


def test_up_starts_a_worker_again_that_was_killed(described: Path, up: "subprocess.Popen[str]") -> None:
    _read_until(up, "waits for jobs")
    (worker,) = [child for child in psutil.Process(up.pid).children() if "work" in child.cmdline()]
    worker.kill()
    _read_until(up, "worker  | ended with exit code -9; starts again")
    _read_until(up, "waits for jobs")
    up.send_signal(signal.SIGINT)
    assert up.wait(timeout=60) == 0


def test_up_ends_where_the_port_is_taken(described: Path) -> None:
    with socket.create_server(("127.0.0.1", 0)) as taken:
        command = [PARTWISE, "up", str(described), "--port", str(taken.getsockname()[1])]
        done = subprocess.run(command, capture_output=True, text=True, check=False, timeout=120)
    assert done.returncode == 3
    assert "service | error: the service must be able to listen" in done.stdout
