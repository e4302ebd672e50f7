"""A service on a workspace of three small shapes, made without Ray, and callers of every role."""

import shutil
import socket
import threading
from collections.abc import Iterator
from dataclasses import dataclass, field
from datetime import UTC, datetime, timedelta
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import uvicorn
from fastapi import FastAPI
from fastapi.testclient import TestClient

from partwise.mesh import TriMesh
from partwise.store.records import Collection, NewToken, Role
from partwise.testing.meshes import subdivided
from partwise.testing.postgres import ReusedDatabase, keep_catalog_in, reused_workspace
from partwise.testing.waiting import WITHIN_S, wait_until
from partwise.testing.workspaces import (
    ingest,
    publish_evaluation,
    publish_features,
    publish_meshes,
    publish_refinement,
    save_model,
)
from partwise.workspace.workspace import Workspace, init_workspace, open_workspace
from partwise_cli.serving import server_config
from partwise_service.app import create_app
from partwise_service.settings import ServiceSettings

PARTS = ("body", "handle")
BODY, HANDLE = 1, 2
API = "/api/v1"
DATABASES = ("sqlite", pytest.param("postgres", marks=pytest.mark.again_on_postgres))
ON_SQLITE_ONLY = {
    "test_array_places": "waits for the array store, and for no database",
    "test_compression": "looks at headers and bytes of answers that other modules get on both",
    "test_limits": "is about requests that are refused before anything is asked of the catalog",
    "test_openapi": "compares the document with what problems are made of; generated requests go to both databases",
    "test_page": "serves files",
    "test_problems": "makes documents of errors that it raises itself",
    "test_slow_requests": "is about requests that never come whole",
    "test_tools": "computes on meshes; which shapes and drafts there are is asked as other modules do",
    "test_tools_socket": "as test_tools",
}
"""Modules whose tests need not run on both databases, and why."""
ORIGIN = "http://127.0.0.1:8000"


@dataclass
class Clock:
    """Seconds that pass when a test says so."""

    now_s: float = 1_000.0

    def __call__(self) -> float:
        return self.now_s


@dataclass
class Mugs:
    """The workspace's path, its collection of mugs a.off, b.off and sub/c.off, and another one that has one shape."""

    path: Path
    collection_id: int
    ids: dict[str, int]
    other_id: int
    other_shape_id: int
    meshes: dict[str, TriMesh] = field(default_factory=dict)


class Caller:
    """Requests in the name of a person: `ann.get("/me")`."""

    def __init__(self, client: TestClient, secret: str | None) -> None:
        self._client = client
        self.secret = secret
        self.headers = {} if secret is None else {"Authorization": f"Bearer {secret}"}

    def request(self, method: str, path: str, **given: Any) -> Any:
        headers = {**self.headers, **given.pop("headers", {})}
        return self._client.request(method, f"{API}{path}", headers=headers, **given)

    def get(self, path: str, **given: Any) -> Any:
        return self.request("GET", path, **given)

    def post(self, path: str, **given: Any) -> Any:
        return self.request("POST", path, **given)

    def patch(self, path: str, **given: Any) -> Any:
        return self.request("PATCH", path, **given)

    def delete(self, path: str, **given: Any) -> Any:
        return self.request("DELETE", path, **given)


def pytest_generate_tests(metafunc: pytest.Metafunc) -> None:
    """Databases lock, order and type differently: what runs on SQLite runs on PostgreSQL, unless there is a reason."""
    if "database" in metafunc.fixturenames:
        is_one = metafunc.module.__name__.rpartition(".")[2] in ON_SQLITE_ONLY
        metafunc.parametrize("database", DATABASES[:1] if is_one else DATABASES, indirect=True)


@pytest.fixture(scope="session")
def template(tmp_path_factory: pytest.TempPathFactory) -> Mugs:
    """Evaluated and refined by model version 1: predicted as bodies, refined as handles; c.off is the least certain."""
    return _made(tmp_path_factory.mktemp("service") / "ws")


@pytest.fixture(scope="session")
def postgres_template(tmp_path_factory: pytest.TempPathFactory, postgres: str) -> Iterator[tuple[Mugs, ReusedDatabase]]:
    """The same workspace with its catalog in PostgreSQL, and a copy of that catalog for tests to use in turn."""
    with reused_workspace(postgres, tmp_path_factory.mktemp("service-postgres") / "ws", _made) as reused:
        yield reused


def _made(path: Path) -> Mugs:
    init_workspace(path)
    vertices = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]], dtype=np.float64)
    tetrahedron = TriMesh(vertices, np.array([[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]]))
    meshes = {
        "a.off": tetrahedron,
        "b.off": subdivided(tetrahedron),
        "sub/c.off": TriMesh(vertices * 2.0, tetrahedron.faces),
    }
    with open_workspace(path) as workspace:
        collection = workspace.catalog.create_collection("mugs", PARTS, {"up": "y"})
        ids = _fill(workspace, collection, meshes)
        other = workspace.catalog.create_collection("vases", ["neck"])
        other_ids = ingest(workspace, other, {"v.off": tetrahedron})
        publish_meshes(workspace, {other_ids["v.off"]: tetrahedron})
    return Mugs(path, collection.id, ids, other.id, other_ids["v.off"], meshes)


def _fill(workspace: Workspace, collection: Collection, meshes: dict[str, TriMesh]) -> dict[str, int]:
    ids = ingest(workspace, collection, meshes)
    publish_meshes(workspace, {ids[key]: mesh for key, mesh in meshes.items()})
    publish_features(workspace, list(ids.values()), np.random.default_rng(0))
    model = save_model(workspace, collection)
    certainty = {"a.off": 0.99, "b.off": 0.8, "sub/c.off": 0.6}
    probabilities = {ids[key]: np.tile([p, 1 - p], (meshes[key].n_faces, 1)) for key, p in certainty.items()}
    publish_evaluation(workspace, model, (BODY, HANDLE), probabilities)
    labels = {ids[key]: np.full(mesh.n_faces, HANDLE, dtype=np.uint16) for key, mesh in meshes.items()}
    publish_refinement(workspace, model, labels)
    return ids


@pytest.fixture
def database(request: pytest.FixtureRequest) -> str:
    """`sqlite` or `postgres`: see `pytest_generate_tests`."""
    return str(request.param)


@pytest.fixture
def mugs(database: str, request: pytest.FixtureRequest, tmp_path: Path) -> Iterator[Mugs]:
    """A copy of the template for one test."""
    path = tmp_path / "ws"
    if database == "sqlite":
        template: Mugs = request.getfixturevalue("template")
        path.mkdir()
        for name in ("partwise.toml", "catalog.sqlite"):
            shutil.copy(template.path / name, path / name)
        yield _beside(template, path)
        return
    template, reused = request.getfixturevalue("postgres_template")
    reused.restore()
    keep_catalog_in(path, reused.url)
    yield _beside(template, path)


def _beside(template: Mugs, path: Path) -> Mugs:
    (path / "arrays").symlink_to(template.path / "arrays")  # named by content or afresh, so that tests may share them
    return Mugs(path, template.collection_id, template.ids, template.other_id, template.other_shape_id, template.meshes)


@pytest.fixture
def settings(mugs: Mugs, tmp_path: Path) -> ServiceSettings:
    """Without a page, whether one is built or not. A test that needs other settings overrides this."""
    return ServiceSettings(workspace=mugs.path, page_folder=tmp_path / "no-page")


@pytest.fixture
def clock() -> Clock:
    return Clock()


@pytest.fixture
def app(settings: ServiceSettings, clock: Clock) -> FastAPI:
    return create_app(settings, clock)


@pytest.fixture
def client(app: FastAPI) -> Iterator[TestClient]:
    """Sends what it is told and no credentials of its own."""
    with TestClient(app, base_url=ORIGIN, raise_server_exceptions=False) as started:
        yield started


@pytest.fixture
def served(app: FastAPI, settings: ServiceSettings) -> Iterator[str]:
    """The URL of the application on a port of its own, served as by the command."""
    listener = socket.create_server(("127.0.0.1", 0))
    server = uvicorn.Server(server_config(settings, lambda: app))
    thread = threading.Thread(target=server.run, kwargs={"sockets": [listener]}, daemon=True)
    thread.start()
    wait_until(lambda: server.started)
    yield f"http://127.0.0.1:{listener.getsockname()[1]}/api/v1"
    server.should_exit = True
    thread.join(WITHIN_S)
    listener.close()


@pytest.fixture
def workspace(app: FastAPI, client: TestClient) -> Workspace:
    """The workspace that the running service has open."""
    opened: Workspace = app.state.service.workspace
    return opened


class Issue:
    """Makes callers: `issue("ann", Role.ANNOTATOR)`. The person is added on first use."""

    def __init__(self, client: TestClient, workspace: Workspace) -> None:
        self._client = client
        self._workspace = workspace

    def __call__(
        self, name: str, role: Role, scope: tuple[int, ...] | None = None, ttl: timedelta = timedelta(days=1)
    ) -> Caller:
        catalog = self._workspace.catalog
        known = {person.name: person for person in catalog.list_people()}
        person = known.get(name) or catalog.add_person(name)
        issued = catalog.issue_token(NewToken(person.id, role, datetime.now(UTC) + ttl, scope), "test")
        return Caller(self._client, issued.secret)


@pytest.fixture
def issue(client: TestClient, workspace: Workspace) -> Issue:
    return Issue(client, workspace)


@pytest.fixture
def nobody(client: TestClient) -> Caller:
    return Caller(client, None)


@pytest.fixture
def annotator(issue: Issue, mugs: Mugs) -> Caller:
    """Of mugs only."""
    return issue("ann", Role.ANNOTATOR, (mugs.collection_id,))


@pytest.fixture
def reviewer(issue: Issue, mugs: Mugs) -> Caller:
    """Of mugs only."""
    return issue("rita", Role.REVIEWER, (mugs.collection_id,))


@pytest.fixture
def operator(issue: Issue) -> Caller:
    """Of all collections."""
    return issue("oscar", Role.OPERATOR)


@pytest.fixture
def admin(issue: Issue) -> Caller:
    return issue("ada", Role.ADMIN)
