"""A workspace whose jobs are what a test says, and workers on it; on SQLite and on PostgreSQL."""

import shutil
from collections.abc import Callable, Iterator
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

from partwise.config import JobsConfig
from partwise.store.records import Job, JobKind
from partwise.testing.postgres import keep_catalog_in
from partwise.workspace.workspace import Workspace, open_workspace
from partwise_cli.jobs.cluster import Cluster
from partwise_cli.jobs.work import Handler
from partwise_cli.jobs.worker import Worker

QUICK = JobsConfig(poll_s=0.01, pulse_s=0.02, lost_after_s=1.0)
MakeWorker = Callable[..., Worker]


@pytest.fixture(params=["sqlite", pytest.param("postgres", marks=pytest.mark.again_on_postgres)])
def described(request: pytest.FixtureRequest, tmp_path: Path) -> Path:
    path = tmp_path / "ws"
    if request.param == "sqlite":
        return Path(shutil.copytree(request.getfixturevalue("templates")["described"], path))
    template, reused = request.getfixturevalue("postgres_described")
    reused.restore()
    keep_catalog_in(path, reused.url)
    shutil.copytree(template / "arrays", path / "arrays")
    return path


@pytest.fixture
def workspace(described: Path) -> Iterator[Workspace]:
    """Three described mugs; jobs are looked for, and kept alive, many times a second."""
    with open_workspace(described) as opened:
        yield replace(opened, config=replace(opened.config, jobs=QUICK))


@pytest.fixture
def collection_id(workspace: Workspace) -> int:
    return workspace.catalog.get_collection("mugs").id


@pytest.fixture
def enqueue(workspace: Workspace, collection_id: int) -> Callable[[JobKind], Job]:
    return lambda kind: workspace.catalog.enqueue_job(collection_id, kind)


@pytest.fixture
def worker(workspace: Workspace) -> MakeWorker:
    """`worker({kind: handler}, owner="w1")`."""

    def make(handlers: dict[JobKind, Handler], **given: Any) -> Worker:
        return Worker(workspace, handlers, Cluster(), **given)

    return make
