"""Remeshing as a stage, on real Ray: a clean shape, a soup, a broken file, and a shape that nothing can make whole."""

from collections.abc import Iterator
from dataclasses import dataclass, replace
from datetime import timedelta
from pathlib import Path

import numpy as np
import pytest

from partwise.features.parameters import LightFieldParameters
from partwise.geometry.manifold import manifold_report
from partwise.io.read import read_mesh
from partwise.io.write import write_mesh
from partwise.mesh import TriMesh
from partwise.remesh.parameters import AlphaWrap, ImplicitContour, RemeshParameters
from partwise.simulate.collection import CATEGORIES, simulate_shape
from partwise.store.levels import read_level
from partwise.store.records import Collection, StageRun
from partwise.workspace.garbage import collect_garbage
from partwise.workspace.ingest import ingest_folder
from partwise.workspace.progress import RunProgress
from partwise.workspace.provenance import provenance
from partwise.workspace.settings import change_settings
from partwise.workspace.shapes import find_shape, load_mesh
from partwise.workspace.workspace import Workspace, init_workspace, open_workspace
from partwise_workers.passes import preprocess
from partwise_workers.plan import description_stages, plan_tasks

QUICK = RemeshParameters(
    wraps=(AlphaWrap(2.0, 0.4),), contours=(ImplicitContour(48),), levels=(3_000, 1_000), max_distance=0.6
)
STAGES = ("mesh", "remesh", "describe")


@dataclass(frozen=True)
class Remeshed:
    """The workspace after a first pass for 1,000 faces, and what the pass reported."""

    workspace: Workspace
    collection: Collection
    folder: Path
    first: RunProgress

    def run(self, name: str, stage: str) -> StageRun:
        shape = find_shape(self.workspace, self.collection, name)
        return self.workspace.catalog.stage_runs([shape.id], stage)[shape.id]

    def needs(self, collection: Collection) -> dict[str, list[str]]:
        tasks = plan_tasks(self.workspace, collection, description_stages(self.workspace, collection))
        return {task.source_key: [stage for stage, _ in task.stage_keys] for task in tasks}


def unheard(progress: RunProgress) -> None:
    """The result is enough."""


@pytest.fixture(scope="module")
def remeshed(local_ray: None, tmp_path_factory: pytest.TempPathFactory) -> Iterator[Remeshed]:
    root = tmp_path_factory.mktemp("remeshing")
    folder = root / "shapes"
    clean = simulate_shape("mugs", 3, "clean", n_faces=1_000).mesh
    write_mesh(clean, folder / "clean.off")
    write_mesh(simulate_shape("mugs", 3, "soup", n_faces=1_000, dirty=True).mesh, folder / "soup.off")
    apart = np.ptp(clean.vertices, axis=0).max() * 3
    two = TriMesh(
        np.concatenate([clean.vertices, clean.vertices + apart]),
        np.concatenate([clean.faces, clean.faces + clean.n_vertices]),
    )
    write_mesh(two, folder / "two.off")
    (folder / "broken.off").write_bytes(b"OFF\n4 4 0\n0 0 0\n1 0 0\n0 1 0\n")
    init_workspace(root / "ws")
    with open_workspace(root / "ws") as opened:
        config = replace(
            opened.config,
            remesh=QUICK,
            workers=replace(opened.config.workers, n_actors=1),
            describe=replace(opened.config.describe, light_field=LightFieldParameters(renderer="raycast")),
        )
        workspace = replace(opened, config=config)
        settings = {"working_faces": 1_000}
        collection = workspace.catalog.create_collection("mugs", CATEGORIES["mugs"].part_names, settings)
        ingest_folder(workspace, collection, folder)
        yield Remeshed(workspace, collection, folder, preprocess(workspace, collection, unheard))


def test_good_shapes_are_done_and_bad_ones_cost_only_themselves(remeshed: Remeshed) -> None:
    assert remeshed.first == RunProgress(2, 2, 4)
    failures = remeshed.workspace.catalog.failures(remeshed.collection.id)
    assert {failure.source_key: failure.run.stage for failure in failures} == {
        "broken.off": "mesh",
        "two.off": "remesh",
    }


def test_a_clean_shape_is_described_on_its_files_own_faces(remeshed: Remeshed) -> None:
    shape = find_shape(remeshed.workspace, remeshed.collection, "clean.off")
    mesh = remeshed.workspace.catalog.meshes([shape.id])[shape.id]
    assert mesh.mesh_hash == read_mesh(remeshed.folder / "clean.off").content_hash()
    assert remeshed.run("clean.off", "describe").summary["mesh_hash"] == mesh.mesh_hash
    assert remeshed.run("clean.off", "remesh").summary["is_as_is"]


def test_a_soup_is_described_on_a_closed_mesh_of_the_working_resolution(remeshed: Remeshed) -> None:
    shape = find_shape(remeshed.workspace, remeshed.collection, "soup.off")
    original = remeshed.workspace.catalog.original_meshes([shape.id])[shape.id]
    mesh = remeshed.workspace.catalog.meshes([shape.id])[shape.id]
    assert original.mesh_hash == read_mesh(remeshed.folder / "soup.off").content_hash() != mesh.mesh_hash
    assert abs(mesh.n_faces - 1_000) <= 50
    assert manifold_report(load_mesh(remeshed.workspace, mesh)).is_clean
    assert remeshed.run("soup.off", "describe").summary["mesh_hash"] == mesh.mesh_hash


def test_every_level_is_in_the_store_or_absent_with_its_reason(remeshed: Remeshed) -> None:
    run = remeshed.run("soup.off", "remesh")
    for level in run.summary["levels"]:
        if level["absent"] is None:
            mesh = read_level(remeshed.workspace.arrays, run.block_name, run.row, level["n_faces"])
            assert (mesh.content_hash(), mesh.n_faces) == (level["mesh_hash"], level["reached"])
            assert manifold_report(mesh).is_clean
    finest = remeshed.run("clean.off", "remesh").summary["levels"][0]
    assert "faces only" in finest["absent"]


def test_what_no_attempt_makes_whole_is_on_record_with_all_attempts(remeshed: Remeshed) -> None:
    card = provenance(remeshed.workspace, find_shape(remeshed.workspace, remeshed.collection, "two.off"))
    assert [attempt.method for attempt in card.attempts] == ["as is", "alpha wrap", "implicit contour"]
    assert all(attempt.refused for attempt in card.attempts)
    assert "all 2 attempts were refused" in card.stages[-1].failure.reason
    assert (card.stages[-1].failure.kind, card.working) == ("error", None)


def test_a_second_pass_has_nothing_to_do(remeshed: Remeshed) -> None:
    assert preprocess(remeshed.workspace, remeshed.collection, unheard) == RunProgress(0, 0, 0)


def test_another_resolution_redoes_remeshing_and_what_follows(remeshed: Remeshed) -> None:
    finer = replace(remeshed.collection, settings={"working_faces": 2_000})
    assert remeshed.needs(finer) == {name: ["remesh", "describe"] for name in ("clean.off", "soup.off", "two.off")}


def test_changed_attempts_redo_remeshing_and_what_follows(remeshed: Remeshed) -> None:
    config = replace(remeshed.workspace.config, remesh=replace(QUICK, wraps=()))
    other = replace(remeshed, workspace=replace(remeshed.workspace, config=config))
    assert set(map(tuple, other.needs(remeshed.collection).values())) == {("remesh", "describe")}


def test_taken_as_they_are_shapes_change_their_mesh_and_keep_their_original(remeshed: Remeshed) -> None:
    """Last in this module: it changes the collection."""
    workspace = remeshed.workspace
    shape = find_shape(workspace, remeshed.collection, "soup.off")
    before = workspace.catalog.original_meshes([shape.id])[shape.id]
    never = change_settings(workspace, remeshed.collection, {"remesh": "never"})
    assert preprocess(workspace, never, unheard) == RunProgress(3, 0, 3)
    assert workspace.catalog.meshes([shape.id])[shape.id].mesh_hash == before.mesh_hash
    auto = change_settings(workspace, never, {"remesh": "auto"})
    assert preprocess(workspace, auto, unheard) == RunProgress(2, 1, 3)
    collect_garbage(workspace, timedelta(0))
    after = workspace.catalog.original_meshes([shape.id])[shape.id]
    assert load_mesh(workspace, after).content_hash() == before.mesh_hash
    assert workspace.catalog.meshes([shape.id])[shape.id].mesh_hash != before.mesh_hash
