"""The Zarr array store on a real S3 endpoint is an `ArrayStore`; when the endpoint goes, it says so in one line."""

import os
import shutil
import signal
import socket
import subprocess
import sysconfig
import threading
import time
import uuid
from collections.abc import Callable, Iterator
from contextlib import closing, suppress
from dataclasses import dataclass
from datetime import timedelta
from pathlib import Path

import numpy as np
import pytest

from partwise.errors import NotFoundError, StoreError
from partwise.store import large_objects, open_arrays
from partwise.store.array_store import BlockAddress
from partwise.store.block_kinds import REFINEMENT
from partwise.store.open_arrays import open_array_store
from partwise.store.zarr_store import ZarrArrayStore
from partwise.testing.array_store import ArrayStoreConformance

KEY, SECRET = "partwise-test", "a-secret-of-no-value"
STARTED_WITHIN_S = 30.0


@dataclass(frozen=True)
class Endpoint:
    """An S3 server with one bucket, `shapes`, and where it keeps its objects."""

    port: int
    process: subprocess.Popen[bytes]

    def open(self, prefix: str | None = None, url: str | None = None) -> ZarrArrayStore:
        """A store below a prefix, a new one unless given. url : of what stands before the server, if that is meant."""
        endpoint_url = url or f"http://127.0.0.1:{self.port}"
        options = {"key": KEY, "secret": SECRET, "endpoint_url": endpoint_url, "skip_instance_cache": True}
        return open_array_store(f"s3://shapes/{prefix or uuid.uuid4().hex}", options)

    def kill(self) -> None:
        self.process.kill()
        self.process.wait()


def start(folder: Path) -> Endpoint:
    (folder / "shapes").mkdir(exist_ok=True)
    with closing(socket.socket()) as probe:
        probe.bind(("127.0.0.1", 0))
        port = probe.getsockname()[1]
    rclone = shutil.which("rclone", path=sysconfig.get_path("scripts") + os.pathsep + os.environ["PATH"])
    assert rclone, "the dev extra brings rclone"
    command = [rclone, "serve", "s3", "--config", os.devnull, "--addr", f"127.0.0.1:{port}"]
    process = subprocess.Popen(
        [*command, "--auth-key", f"{KEY},{SECRET}", str(folder)], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL
    )
    deadline = time.monotonic() + STARTED_WITHIN_S
    while socket.socket().connect_ex(("127.0.0.1", port)) and time.monotonic() < deadline:
        time.sleep(0.05)
    return Endpoint(port, process)


@pytest.fixture(scope="module")
def endpoint(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Endpoint]:
    started = start(tmp_path_factory.mktemp("s3"))
    yield started
    started.kill()


class TestS3(ArrayStoreConformance):
    @pytest.fixture
    def store(self, endpoint: Endpoint) -> ZarrArrayStore:
        return endpoint.open()


def test_a_large_object_is_whole_or_not_there(endpoint: Endpoint, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(large_objects, "CHUNK_BYTES", 1_000)
    store, data = endpoint.open(), np.random.default_rng(0).bytes(2_500)
    writer = large_objects.LargeObjectWriter(store, "uploads/1/x")
    writer.write(data)
    with pytest.raises(NotFoundError):
        large_objects.find_large_object(store, "uploads/1/x")
    made = writer.finish({"name": "a.zip"})
    assert large_objects.find_large_object(store, "uploads/1/x") == made
    assert b"".join(large_objects.read_chunks(store, made)) == data
    large_objects.delete_large_object(store, made.key)
    assert list(store.list("uploads")) == []


class Relay:
    """Passes bytes on to a server, up to a number of those that clients send; then it cuts all lines, for good."""

    def __init__(self, endpoint: Endpoint) -> None:
        self._to = ("127.0.0.1", endpoint.port)
        self._listener = socket.create_server(("127.0.0.1", 0))
        self._lines: list[socket.socket] = []
        self._left: int | None = None
        self._at_the_cut: Callable[[], object] = lambda: None
        self.n_lines = 0
        threading.Thread(target=self._accept, daemon=True).start()

    @property
    def url(self) -> str:
        return f"http://127.0.0.1:{self._listener.getsockname()[1]}"

    def cut_after(self, n_bytes: int, then: Callable[[], object]) -> None:
        self._left, self._at_the_cut = n_bytes, then

    def close(self) -> None:
        self._listener.close()
        for line in self._lines:
            line.close()

    def _accept(self) -> None:
        while True:
            try:
                near, _ = self._listener.accept()
                far = socket.create_connection(self._to)
            except OSError:  # it was cut
                return
            self.n_lines += 1
            self._lines += [near, far]
            threading.Thread(target=self._pass_on, args=(near, far, True), daemon=True).start()
            threading.Thread(target=self._pass_on, args=(far, near, False), daemon=True).start()

    def _pass_on(self, source: socket.socket, target: socket.socket, is_counted: bool) -> None:
        with suppress(OSError), source, target:
            while data := source.recv(4_096):
                if is_counted and self._left is not None:
                    self._left -= len(data)
                    if self._left < 0:
                        self._at_the_cut()
                        self.close()
                        return
                target.sendall(data)


@pytest.fixture
def relayed(tmp_path: Path) -> Iterator[tuple[Endpoint, Relay]]:
    server = start(tmp_path)
    relay = Relay(server)
    yield server, relay
    relay.close()
    server.kill()


def _block(rng: np.random.Generator) -> list[dict[str, np.ndarray]]:
    """Labels of several shards that no compression makes small."""
    return [{"labels": rng.integers(0, 65_535, n, dtype=np.uint16)} for n in (300_000, 500_000, 524_288)]


@pytest.mark.parametrize("share", [0.5, 0.95])
def test_a_server_that_stops_half_way_costs_the_write_and_leaves_nothing_visible(relayed, tmp_path, share) -> None:
    server, relay = relayed
    store = server.open("blocks-of-a-test", relay.url)
    first = store.write_block(REFINEMENT, [{"labels": np.arange(5, dtype=np.uint16)}])
    second = _block(np.random.default_rng(0))
    relay.cut_after(int(share * sum(each["labels"].nbytes for each in second)), server.kill)
    with pytest.raises(StoreError, match=r"reachable|refused") as refused:
        store.write_block(REFINEMENT, second)
    assert "\n" not in str(refused.value)
    with pytest.raises((StoreError, NotFoundError)):
        store.read(first.name, 0, "labels")

    again = start(tmp_path)
    try:
        _check_after_restart(again.open("blocks-of-a-test"), first)
    finally:
        again.kill()


def _check_after_restart(store: ZarrArrayStore, first: BlockAddress) -> None:
    store.verify(first)
    assert store.read(first.name, 0, "labels").tolist() == [0, 1, 2, 3, 4]
    left = store.orphans({first.name}, timedelta(days=-1))
    assert len(left) == 1
    assert set(store.block_names()) == {first.name, *left}
    for name in left:
        with pytest.raises((StoreError, NotFoundError)):
            store.read(name, 0, "labels")
        store.delete_block(name)
    assert [key for key in store.list("blocks") if not key.startswith(first.name)] == []


@pytest.mark.parametrize("what", ["block", "object"])
def test_a_server_that_hangs_is_given_up_after_a_few_tries(relayed, monkeypatch, what) -> None:
    monkeypatch.setattr(open_arrays, "READ_S", 0.2)
    server, relay = relayed
    store = server.open("blocks-of-a-test", relay.url)
    block = store.write_block(REFINEMENT, [{"labels": np.arange(5, dtype=np.uint16)}])
    store.put_bytes("models/1", b"x")

    def read() -> object:
        return store.read(block.name, 0, "labels").tolist() if what == "block" else store.get_bytes("models/1")

    n_before = relay.n_lines
    server.process.send_signal(signal.SIGSTOP)
    with pytest.raises(StoreError):
        read()
    assert relay.n_lines - n_before <= open_arrays.ATTEMPTS**2
    server.process.send_signal(signal.SIGCONT)
    assert read() in ([0, 1, 2, 3, 4], b"x")
