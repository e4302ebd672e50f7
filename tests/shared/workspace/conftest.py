"""A workspace of three small shapes, brought as far as each test needs without Ray, on SQLite and on PostgreSQL.

The empty workspace is made once and copied, because migrating its catalog takes longest.
"""

import shutil
from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
import pytest

from partwise.mesh import TriMesh
from partwise.store.records import Collection, Model, Shape
from partwise.testing.meshes import subdivided
from partwise.testing.postgres import ReusedDatabase, keep_catalog_in, reused_workspace
from partwise.testing.workspaces import (
    ingest,
    publish_evaluation,
    publish_features,
    publish_meshes,
    publish_refinement,
    save_model,
)
from partwise.workspace.workspace import Workspace, init_workspace, open_workspace

DATABASES = ("sqlite", pytest.param("postgres", marks=pytest.mark.again_on_postgres))
ON_SQLITE_ONLY = {
    "test_export": "is about the files of every format; test_export_archive selects the same labels on both",
    "test_original_faces": "moves labels between meshes",
    "test_partnet_folders": "reads folders",
    "test_uploads": "keeps files in the array store",
    "test_workspace": "is about the workspace's files, its catalog among them",
}
"""Modules whose tests need not run on both databases, and why."""
PARTS = ("body", "handle")
BODY, HANDLE = 1, 2


@dataclass
class Filled:
    """A workspace with a collection of shapes a.off, b.off and sub/c.off; `meshes` are theirs, by source key."""

    workspace: Workspace
    collection: Collection
    meshes: dict[str, TriMesh]
    ids: dict[str, int] = field(default_factory=dict)

    def shape(self, source_key: str) -> Shape:
        return self.workspace.catalog.shape(self.ids[source_key])

    def preprocessed(self) -> "Filled":
        publish_meshes(self.workspace, {self.ids[key]: mesh for key, mesh in self.meshes.items()})
        return self

    def described(self) -> "Filled":
        self.preprocessed()
        publish_features(self.workspace, list(self.ids.values()), np.random.default_rng(0))
        return self

    def evaluated(self) -> Model:
        """c.off is the least certain, then b.off; every face of each is predicted as its body."""
        model = save_model(self.workspace, self.collection)
        certainty = {"a.off": 0.99, "b.off": 0.8, "sub/c.off": 0.6}
        probabilities = {
            self.ids[key]: np.tile([p, 1 - p], (self.meshes[key].n_faces, 1)) for key, p in certainty.items()
        }
        publish_evaluation(self.workspace, model, (BODY, HANDLE), probabilities)
        return model

    def refined(self, model: Model) -> None:
        """Every face is a handle."""
        labels = {self.ids[key]: np.full(mesh.n_faces, HANDLE, dtype=np.uint16) for key, mesh in self.meshes.items()}
        publish_refinement(self.workspace, model, labels)


def pytest_generate_tests(metafunc: pytest.Metafunc) -> None:
    if "database" in metafunc.fixturenames:
        is_one = metafunc.module.__name__.rpartition(".")[2] in ON_SQLITE_ONLY
        metafunc.parametrize("database", DATABASES[:1] if is_one else DATABASES, indirect=True)


@pytest.fixture
def database(request: pytest.FixtureRequest) -> str:
    """`sqlite` or `postgres`."""
    return str(request.param)


@pytest.fixture(scope="session")
def empty_workspace(tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("template") / "ws"
    init_workspace(path)
    return path


@pytest.fixture(scope="session")
def reused(tmp_path_factory: pytest.TempPathFactory, postgres: str) -> Iterator[ReusedDatabase]:
    """The catalog of an empty workspace."""
    with reused_workspace(postgres, tmp_path_factory.mktemp("postgres") / "ws", init_workspace) as (_, database):
        yield database


@pytest.fixture
def path(database: str, request: pytest.FixtureRequest, tmp_path: Path) -> Path:
    path = tmp_path / "ws"
    if database == "sqlite":
        return Path(shutil.copytree(request.getfixturevalue("empty_workspace"), path))
    reused: ReusedDatabase = request.getfixturevalue("reused")
    reused.restore()
    keep_catalog_in(path, reused.url)
    return path


@pytest.fixture
def workspace(path: Path) -> Iterator[Workspace]:
    with open_workspace(path) as opened:
        yield opened


@pytest.fixture
def collection(workspace: Workspace) -> Collection:
    return workspace.catalog.create_collection("mugs", PARTS, {"up": "y"})


@pytest.fixture
def tetrahedron() -> TriMesh:
    vertices = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]], dtype=np.float64)
    return TriMesh(vertices, np.array([[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]]))


@pytest.fixture
def filled(workspace: Workspace, collection: Collection, tetrahedron: TriMesh) -> Filled:
    """Ingested, no more."""
    meshes = {
        "a.off": tetrahedron,
        "b.off": subdivided(tetrahedron),
        "sub/c.off": TriMesh(tetrahedron.vertices * 2.0, tetrahedron.faces),
    }
    return Filled(workspace, collection, meshes, ingest(workspace, collection, meshes))
