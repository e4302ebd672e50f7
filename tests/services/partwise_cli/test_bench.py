"""bench: core-seconds of describing, and leave one out, on small things and without Ray."""

import json
from pathlib import Path

import numpy as np
import pytest

from partwise.errors import NotEnoughDataError, NotFoundError, ParameterError
from partwise.io.write import write_mesh
from partwise.learning.recipe import Recipe
from partwise.mesh import TriMesh
from partwise.simulate.collection import simulate_shape
from partwise.store.records import RevisionKind
from partwise.testing.meshes import subdivided
from partwise.testing.workspaces import ingest, publish_features, publish_meshes, publish_remeshed
from partwise.workspace.labelling import commit_labels
from partwise.workspace.workspace import init_collection, open_workspace
from partwise_cli.bench import describing
from partwise_cli.bench.leave_one_out import (
    HeldOut,
    Prepared,
    evenly_spaced,
    leave_one_out,
    part_names_of,
    prepare,
    summarise,
)
from partwise_workers.plan import chain_keys, description_stages


def test_describing_is_timed_file_by_file(invoke, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(describing, "WARM_UP_FACES", 1000)
    write_mesh(simulate_shape("mugs", 0, "mug", n_faces=1000).mesh, tmp_path / "mug.off")
    result = invoke("bench", "describe", tmp_path / "mug.off", tmp_path / "mug.off", "--json")
    lines = [json.loads(line) for line in result.stdout.splitlines()]
    assert [line["file"] for line in lines] == [str(tmp_path / "mug.off")] * 2
    assert lines[0]["core_s"]["total"] > 0
    assert {"shape_context", "spin_image", "shape_diameter", "light_field", "total"} <= set(lines[0]["core_s"])
    assert lines[0]["peak_mb"] > 0


@pytest.mark.parametrize(
    ("n", "limit", "chosen"),
    [(20, 4, [0, 6, 13, 19]), (5, None, [0, 1, 2, 3, 4]), (3, 9, [0, 1, 2]), (7, 1, [0])],
)
def test_held_out_shapes_are_evenly_spaced(n: int, limit: int | None, chosen: list[int]) -> None:
    assert evenly_spaced(n, limit) == chosen


def test_a_summary_has_the_means() -> None:
    results = [
        HeldOut("a", 4, 0.5, 0.6, 0.7, 0.8, 1.0, 10.0),
        HeldOut("b", 4, 0.7, 0.8, 0.9, 1.0, 1.0, 20.0),
    ]
    summary = summarise(results, "Airplane", "paper", 20)
    assert (summary.n_held_out, summary.n_shapes) == (2, 20)
    assert (summary.accuracy_raw, summary.accuracy_refined) == (0.6, 0.7)
    assert (summary.accuracy_raw_by_area, summary.accuracy_refined_by_area) == (0.8, 0.9)
    assert summary.train_s == 15.0


def test_part_names_are_those_of_all_files(tmp_path: Path, tetrahedron: TriMesh) -> None:
    for name, part in (("1", "wing"), ("2", "body"), ("3", None)):
        write_mesh(tetrahedron, tmp_path / f"{name}.off")
        if part:
            (tmp_path / f"{name}_labels.txt").write_text(f"{part}\n1 2 3 4\n")
    assert part_names_of(tmp_path) == ["body", "wing"]


def test_a_missing_folder_makes_no_workspace(tmp_path: Path) -> None:
    with pytest.raises(NotFoundError, match="missing"):
        prepare(tmp_path / "missing", tmp_path / "ws", lambda run: None)
    assert not (tmp_path / "ws").exists()


def test_a_folder_without_labels_makes_no_workspace(tmp_path: Path, tetrahedron: TriMesh) -> None:
    write_mesh(tetrahedron, tmp_path / "in" / "1.off")
    with pytest.raises(NotEnoughDataError, match=r"<id>_labels\.txt"):
        prepare(tmp_path / "in", tmp_path / "ws", lambda run: None)
    assert not (tmp_path / "ws").exists()


def test_a_recipe_that_cannot_be_is_refused_before_any_work(invoke, tmp_path: Path) -> None:
    result = invoke("bench", "loo", tmp_path, "--category", "x", "--iterations", "7")
    assert isinstance(result.exception, ParameterError)


@pytest.fixture
def labelled(tmp_path: Path, tetrahedron: TriMesh) -> Path:
    """Four labelled shapes of 64 faces."""
    mesh = subdivided(subdivided(tetrahedron))
    init_collection(tmp_path / "ws", "chairs", ["body", "wing"], {})
    with open_workspace(tmp_path / "ws") as workspace:
        collection = workspace.catalog.get_collection("chairs")
        meshes = {f"{i}.off": TriMesh(mesh.vertices * (i + 1.0), mesh.faces) for i in range(4)}
        ids = ingest(workspace, collection, meshes)
        rng = np.random.default_rng(0)
        for name, shape_id in ids.items():
            keys = chain_keys(workspace.catalog.shape(shape_id), description_stages(workspace, collection))
            publish_meshes(workspace, {shape_id: meshes[name]}, keys[0])
            publish_remeshed(workspace, {shape_id: meshes[name]}, keys[1])
            publish_features(workspace, [shape_id], rng, keys[2])
        labels = np.where(np.arange(64) < 32, 1, 2).astype(np.uint16)
        for shape_id in ids.values():
            commit_labels(
                workspace, collection, workspace.catalog.shape(shape_id), labels, RevisionKind.IMPORTED, "benchmark"
            )
    return tmp_path / "ws"


def test_each_held_out_shape_is_judged_by_a_model_of_the_others(labelled: Path) -> None:
    told: list[tuple[int, int, str]] = []
    with open_workspace(labelled) as workspace:
        recipe = Recipe(n_iterations=5, batch_size=16)
        tell = lambda done, total, name: told.append((done, total, name))  # noqa: E731
        results = list(leave_one_out(workspace, "chairs", recipe, 2, tell))
    assert [result.shape for result in results] == ["0.off", "3.off"]
    assert all(result.n_faces == 64 for result in results)
    assert all(0 <= value <= 1 for r in results for value in (r.accuracy_raw, r.accuracy_refined_by_area))
    assert {name for _, _, name in told} == {"0.off", "3.off"}


@pytest.fixture
def _two_results(monkeypatch: pytest.MonkeyPatch) -> None:
    """Leave one out takes long: its outcome is made up."""
    results = [HeldOut("a.off", 4, 0.5, 0.6, 0.7, 0.8, 1.0, 10.0), HeldOut("b.off", 4, 0.7, 0.8, 0.9, 1.0, 1.0, 20.0)]
    monkeypatch.setattr("partwise_cli.bench.leave_one_out.prepare", lambda folder, path, on_run: Prepared("x", 4, ()))
    monkeypatch.setattr("partwise_cli.bench.leave_one_out.leave_one_out", lambda *_: iter(results))


@pytest.mark.usefixtures("_two_results")
def test_leave_one_out_as_json(invoke, described: Path, tmp_path: Path) -> None:
    result = invoke("bench", "loo", tmp_path, "--category", "x", "--workspace", described, "--json")
    first, second, summary = (json.loads(line) for line in result.stdout.splitlines())
    assert (first["shape"], second["shape"]) == ("a.off", "b.off")
    assert (summary["category"], summary["preset"], summary["n_held_out"], summary["n_shapes"]) == ("x", "paper", 2, 4)
    for name in ("accuracy_raw", "accuracy_refined", "accuracy_raw_by_area", "accuracy_refined_by_area", "train_s"):
        assert summary[name] == pytest.approx((first[name] + second[name]) / 2)


@pytest.mark.usefixtures("_two_results")
def test_leave_one_out_as_a_table(invoke, described: Path, tmp_path: Path) -> None:
    result = invoke("bench", "loo", tmp_path, "--category", "x", "--workspace", described)
    assert "Leave one out: x, paper" in result.stdout
    rows = [line.strip("│").split("│") for line in result.stdout.splitlines() if line.startswith("│")]
    assert [cell.strip() for cell in rows[-1]] == ["mean", "", "60.00%", "70.00%", "80.00%", "90.00%", "", "15"]
    assert [row[0].strip() for row in rows] == ["a.off", "b.off", "mean"]
