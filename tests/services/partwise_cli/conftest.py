"""Workspaces of three small shapes for commands to work on, made without Ray, and ways to run commands."""

import logging
import shutil
import subprocess
import sys
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from typer.testing import CliRunner

from partwise.mesh import TriMesh
from partwise.testing.meshes import subdivided
from partwise.testing.postgres import ReusedDatabase, reused_workspace
from partwise.testing.workspaces import (
    ingest,
    publish_evaluation,
    publish_features,
    publish_meshes,
    publish_refinement,
    save_model,
)
from partwise.workspace.workspace import init_collection, open_workspace
from partwise_cli.main import app

PARTS = ("body", "handle")
Invoke = Callable[..., Any]
Run = Callable[..., "subprocess.CompletedProcess[str]"]


@pytest.fixture(autouse=True)
def _logging_as_before() -> Iterator[None]:
    """Commands configure logging for the whole process: what tests elsewhere see must not depend on it."""
    root = logging.getLogger()
    loggers = [root, *(logging.getLogger(name) for name in ("partwise", "partwise_workers", "partwise_cli"))]
    handlers, levels = list(root.handlers), [logger.level for logger in loggers]
    yield
    root.handlers[:] = handlers
    for logger, level in zip(loggers, levels, strict=True):
        logger.setLevel(level)
    logging.captureWarnings(False)


@pytest.fixture
def invoke() -> Invoke:
    """Runs a command in this process; an exception it ends with is in the result."""
    return lambda *args: CliRunner().invoke(app, [str(arg) for arg in args])


@pytest.fixture
def run(tmp_path: Path) -> Run:
    """Runs the true command in a process of its own, in `tmp_path`, through `main`."""
    executable = Path(sys.executable).with_name("partwise")

    def run(*args: object, timeout_s: float = 120, **options: Any) -> "subprocess.CompletedProcess[str]":
        command = [str(executable), *(str(arg) for arg in args)]
        return subprocess.run(
            command, cwd=tmp_path, capture_output=True, text=True, timeout=timeout_s, check=False, **options
        )

    return run


@pytest.fixture(scope="session")
def tetrahedron() -> TriMesh:
    vertices = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]], dtype=np.float64)
    return TriMesh(vertices, np.array([[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]]))


@pytest.fixture(scope="session")
def templates(tmp_path_factory: pytest.TempPathFactory, tetrahedron: TriMesh) -> dict[str, Path]:
    """Workspaces by how far they are, each with a collection of mugs."""
    folder = tmp_path_factory.mktemp("templates")
    made = {}
    init_collection(folder / "empty", "mugs", PARTS, {"up": "y"})
    for name, before in (("ingested", "empty"), ("described", "ingested"), ("refined", "described")):
        shutil.copytree(folder / before, folder / name)
        _bring(folder / name, name, tetrahedron)
    for name in ("empty", "ingested", "described", "refined"):
        made[name] = folder / name
    return made


@pytest.fixture(scope="session")
def postgres_described(
    tmp_path_factory: pytest.TempPathFactory, postgres: str, tetrahedron: TriMesh
) -> Iterator[tuple[Path, ReusedDatabase]]:
    """The described workspace with its catalog in PostgreSQL, and a copy of that catalog for tests to use in turn."""

    def make(path: Path) -> Path:
        init_collection(path, "mugs", PARTS, {"up": "y"})
        for name in ("ingested", "described"):
            _bring(path, name, tetrahedron)
        return path

    with reused_workspace(postgres, tmp_path_factory.mktemp("postgres") / "ws", make) as reused:
        yield reused


def _bring(path: Path, name: str, tetrahedron: TriMesh) -> None:
    meshes = {
        "a.off": tetrahedron,
        "b.off": subdivided(tetrahedron),
        "c.off": TriMesh(tetrahedron.vertices * 2, tetrahedron.faces),
    }
    with open_workspace(path) as workspace:
        collection = workspace.catalog.get_collection("mugs")
        if name == "ingested":
            ingest(workspace, collection, meshes)
            return
        ids = {shape.source_key: shape.id for shape in workspace.catalog.shapes(collection.id)}
        if name == "described":
            publish_meshes(workspace, {ids[key]: mesh for key, mesh in meshes.items()})
            publish_features(workspace, list(ids.values()), np.random.default_rng(0))
            return
        model = save_model(workspace, collection)
        certainty = {"a.off": 0.99, "b.off": 0.8, "c.off": 0.6}
        publish_evaluation(
            workspace,
            model,
            (1, 2),
            {ids[k]: np.tile([p, 1 - p], (meshes[k].n_faces, 1)) for k, p in certainty.items()},
        )
        publish_refinement(workspace, model, {ids[k]: np.full(m.n_faces, 2, np.uint16) for k, m in meshes.items()})


@pytest.fixture
def empty(templates: dict[str, Path], tmp_path: Path) -> Path:
    return Path(shutil.copytree(templates["empty"], tmp_path / "ws"))


@pytest.fixture
def ingested(templates: dict[str, Path], tmp_path: Path) -> Path:
    return Path(shutil.copytree(templates["ingested"], tmp_path / "ws"))


@pytest.fixture
def described(templates: dict[str, Path], tmp_path: Path) -> Path:
    return Path(shutil.copytree(templates["described"], tmp_path / "ws"))


@pytest.fixture
def refined(templates: dict[str, Path], tmp_path: Path) -> Path:
    """Evaluated and refined by model version 1: c.off is the least certain; predicted as body, refined as handle."""
    return Path(shutil.copytree(templates["refined"], tmp_path / "ws"))
