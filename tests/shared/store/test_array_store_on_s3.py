"""The Zarr array store on a real S3 endpoint is an `ArrayStore`; when the endpoint goes, it says so in one line."""

import os
import shutil
import signal
import socket
import subprocess
import sysconfig
import time
import uuid
from collections.abc import Iterator
from contextlib import closing
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pytest

from partwise.errors import NotFoundError, StoreError
from partwise.store.block_kinds import REFINEMENT
from partwise.store.open_arrays import open_array_store
from partwise.store.zarr_store import ZarrArrayStore
from partwise.testing.array_store import ArrayStoreConformance

KEY, SECRET = "partwise-test", "a-secret-of-no-value"
STARTED_WITHIN_S = 30.0


@dataclass(frozen=True)
class Endpoint:
    """An S3 server with one bucket, `shapes`, and where it keeps its objects."""

    url: str
    process: subprocess.Popen[bytes]

    def open(self) -> ZarrArrayStore:
        options = {"key": KEY, "secret": SECRET, "endpoint_url": self.url, "skip_instance_cache": True}
        return open_array_store(f"s3://shapes/{uuid.uuid4().hex}", options)


def start(folder: Path) -> Endpoint:
    (folder / "shapes").mkdir()
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
    return Endpoint(f"http://127.0.0.1:{port}", process)


@pytest.fixture(scope="module")
def endpoint(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Endpoint]:
    started = start(tmp_path_factory.mktemp("s3"))
    yield started
    started.process.kill()
    started.process.wait()


class TestS3(ArrayStoreConformance):
    @pytest.fixture
    def store(self, endpoint: Endpoint) -> ZarrArrayStore:
        return endpoint.open()


def test_a_server_that_stops_half_way_costs_the_write_and_leaves_nothing_visible(tmp_path: Path) -> None:
    server = start(tmp_path)
    store = server.open()
    written = store.write_block(REFINEMENT, [{"labels": np.arange(5, dtype=np.uint16)}])
    server.process.send_signal(signal.SIGKILL)
    server.process.wait()
    with pytest.raises(StoreError, match=r"reachable|refused") as refused:
        store.write_block(REFINEMENT, [{"labels": np.arange(9, dtype=np.uint16)}])
    assert "\n" not in str(refused.value)
    with pytest.raises((StoreError, NotFoundError)):
        store.read(written.name, 0, "labels")
