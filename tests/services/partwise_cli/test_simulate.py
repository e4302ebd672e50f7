"""simulate: shapes and ground truth as files that ingest and import read."""

from pathlib import Path

import pytest

from partwise.errors import ParameterError, StoreError
from partwise.exchange.labels_psb import read_psb_labels
from partwise.io.read import read_mesh
from partwise_cli.simulated import SimulationRequest, write_collection


@pytest.fixture(scope="module")
def written(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, list[tuple[int, int]]]:
    """Two small mugs, and what was told of the progress."""
    out, told = tmp_path_factory.mktemp("mugs"), []
    request = SimulationRequest("mugs", 2, seed=3, n_faces=1000)
    write_collection(request, out, lambda done, total, note="": told.append((done, total)))
    return out, told


def test_each_shape_has_a_mesh_and_labels_of_every_face(written) -> None:
    out, _ = written
    assert sorted(path.name for path in out.iterdir()) == [
        "mug-0000.off", "mug-0000_labels.txt", "mug-0001.off", "mug-0001_labels.txt"
    ]  # fmt: skip
    for mesh_file in out.glob("*.off"):
        mesh = read_mesh(mesh_file)
        labels = read_psb_labels(mesh_file.with_name(f"{mesh_file.stem}_labels.txt"), mesh.n_faces)
        assert set(labels.part_names) <= set(SimulationRequest("mugs", 1, 0).part_names)
        assert labels.indices.min() >= 0


def test_progress_is_told_shape_by_shape(written) -> None:
    assert written[1] == [(1, 2), (2, 2)]


def test_the_same_seed_makes_the_same_files(written, tmp_path: Path) -> None:
    write_collection(SimulationRequest("mugs", 1, seed=3, n_faces=1000), tmp_path, lambda done, total, note="": None)
    for path in tmp_path.iterdir():
        assert path.read_bytes() == (written[0] / path.name).read_bytes()


def test_some_or_all_shapes_are_dirty() -> None:
    for request, dirty in (
        (SimulationRequest("mugs", 6, 1), []),
        (SimulationRequest("mugs", 6, 1, dirty=True), [0, 1, 2, 3, 4, 5]),
        (SimulationRequest("mugs", 6, 1, dirty_every=3), [2, 5]),
    ):
        assert [index for index in range(6) if request.is_dirty(index)] == dirty


def test_a_file_in_the_place_of_the_folder_is_named(invoke, tmp_path: Path) -> None:
    (tmp_path / "out").write_text("")
    result = invoke("simulate", "mugs", tmp_path / "out", "--count", "1", "--faces", "1000")
    assert isinstance(result.exception, StoreError)
    assert "choose another folder" in str(result.exception)


def test_simulate_says_what_it_made(invoke, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("partwise_cli.simulated.write_collection", lambda *_: None)
    assert invoke("simulate", "mugs", "out", "--count", "1").stdout == "1 mug in out, with parts body,handle\n"
    assert invoke("simulate", "chairs", "out").stdout.startswith("40 chairs in out, with parts ")


@pytest.mark.parametrize("arguments", [("cups",), ("mugs", "--faces", "3"), ("mugs", "--faces", "9000000")])
def test_what_cannot_be_simulated_is_refused_at_once(invoke, tmp_path: Path, arguments: tuple[str, ...]) -> None:
    category, *options = arguments
    assert isinstance(invoke("simulate", category, tmp_path / "out", *options).exception, ParameterError)
    assert not (tmp_path / "out").exists()


@pytest.mark.parametrize("option", [("--count", "0"), ("--seed", "-1")])
def test_numbers_out_of_range_are_wrong_usage(invoke, tmp_path: Path, option: tuple[str, str]) -> None:
    assert invoke("simulate", "mugs", tmp_path / "out", *option).exit_code == 2
