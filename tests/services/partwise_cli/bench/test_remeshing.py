"""bench remeshing: what became of each shape, shapes that hang or die, medians, pictures."""

import json
import os
import threading
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from partwise.errors import NotFoundError, ParameterError
from partwise.io.write import write_mesh
from partwise.mesh import TriMesh
from partwise.remesh.ladder import Attempt, Level, RemeshResult
from partwise.remesh.parameters import RemeshParameters
from partwise.simulate.collection import simulate_shape
from partwise_cli.bench import remeshing
from partwise_cli.bench.remeshing import (
    LevelOutcome,
    RemeshOutcome,
    measure_remeshing,
    outcome_of,
    summarise,
    supervised,
    write_pictures,
)

PARAMETERS = RemeshParameters(levels=(1000,))


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """One soup, and a file that is no mesh."""
    folder = tmp_path_factory.mktemp("dirty")
    write_mesh(simulate_shape("mugs", 1, "mug", dirty=True).mesh, folder / "mug.off")
    (folder / "no-mesh.off").write_text("OFF\n3 9 0\n")
    return folder


@pytest.fixture(scope="module")
def kept(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return tmp_path_factory.mktemp("kept")


@pytest.fixture(scope="module")
def outcomes(folder: Path, kept: Path) -> list[RemeshOutcome]:
    return list(measure_remeshing(folder, (1000,), 240.0, kept))


def test_a_soup_is_remeshed_and_timed(outcomes: list[RemeshOutcome]) -> None:
    mug = outcomes[0]
    assert (mug.file, mug.refused, mug.is_as_is) == ("mug.off", None, False)
    assert mug.attempts[-1].endswith("accepted")
    assert mug.levels[0].reached == pytest.approx(1000, rel=0.05)
    assert 0 < mug.levels[0].core_s <= mug.core_s + 1e-3


def test_a_file_that_is_no_mesh_is_refused_and_the_rest_goes_on(outcomes: list[RemeshOutcome]) -> None:
    assert outcomes[1].file == "no-mesh.off"
    assert outcomes[1].refused


def test_the_picture_shows_before_and_after(outcomes: list[RemeshOutcome], kept: Path, tmp_path: Path) -> None:
    write_pictures(outcomes, kept, tmp_path / "sheet.png")
    picture = np.asarray(Image.open(tmp_path / "sheet.png").convert("RGB")).astype(int)
    left, right = picture[100:, : picture.shape[1] // 2], picture[100:, picture.shape[1] // 2 :]
    assert (left[..., 2] - left[..., 0] <= 8).all()  # grey, as it came
    assert (right[..., 2] - right[..., 0] > 20).any()  # blue


def test_without_pictures_there_is_no_sheet(outcomes: list[RemeshOutcome], tmp_path: Path) -> None:
    write_pictures(outcomes, tmp_path / "nothing", tmp_path / "sheet.png")
    assert not (tmp_path / "sheet.png").exists()


def hang(*_: object) -> None:
    threading.Event().wait()


def die(*_: object) -> None:
    os._exit(7)


@pytest.mark.parametrize(
    ("work", "deadline_s", "why"),
    [(hang, 0.2, "it took longer than 0.2 s"), (die, 60.0, "its process died with exit code 7")],
)
def test_a_shape_that_hangs_or_dies_costs_only_itself(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path, work, deadline_s: float, why: str
) -> None:
    monkeypatch.setattr(remeshing, "_work", work)
    monkeypatch.setattr(remeshing, "get_context", lambda _: __import__("multiprocessing").get_context("fork"))
    outcome = supervised(tmp_path / "a.off", "a.off", PARAMETERS, deadline_s, None, 0)
    assert (outcome.file, outcome.refused) == ("a.off", why)


def test_a_folder_without_meshes_is_refused(tmp_path: Path) -> None:
    with pytest.raises(NotFoundError, match="has none; check the path"):
        list(measure_remeshing(tmp_path, (1000,), 1.0))
    with pytest.raises(NotFoundError, match="missing"):
        list(measure_remeshing(tmp_path / "missing", (1000,), 1.0))


def test_levels_that_do_not_descend_are_refused(folder: Path) -> None:
    with pytest.raises(ParameterError, match="descend"):
        list(measure_remeshing(folder, (1000, 2000), 1.0))


def test_an_outcome_has_attempts_and_levels_of_its_result(tetrahedron: TriMesh) -> None:
    attempts = (
        Attempt("as is", {}, 0.5, None, 0.0, None, "it is open"),
        Attempt("alpha wrap", {}, 2.0, 4, 0.0, 0.1, None),
    )
    levels = (Level(50, None, "", None, "too few", 0.25), Level(4, tetrahedron, "none", 0.1, None, 1.0))
    outcome = outcome_of("a.off", tetrahedron, RemeshResult(tetrahedron, False, attempts, levels))
    assert outcome.attempts == ("as is: it is open", "alpha wrap: accepted")
    assert [(level.reached, level.absent, level.core_s) for level in outcome.levels] == [
        (None, "too few", 2.75),
        (4, None, 3.5),
    ]
    assert (outcome.core_s, outcome.distance, outcome.refused) == (3.75, 0.1, None)


REACHED = RemeshOutcome("a", 9, False, None, (), 0.1, (LevelOutcome(10, 10, None, 0.1, 4.0),), 5.0)


def test_medians_are_over_what_was_remeshed() -> None:
    summary = summarise(
        [
            REACHED,
            replace(REACHED, distance=0.3, levels=(LevelOutcome(10, 10, None, 0.3, 6.0),), core_s=9.0),
            replace(REACHED, distance=0.2, levels=(LevelOutcome(10, None, "too few", None, 1.0),), core_s=1.0),
            replace(REACHED, is_as_is=True, distance=0.0, core_s=0.1),
            replace(REACHED, file="bad", refused="it is empty"),
        ]
    )
    assert (summary.n_shapes, summary.n_accepted, summary.n_as_is) == (5, 4, 1)
    assert (summary.core_s_to, summary.n_reached) == ({10: 5.0}, {10: 2})
    assert (summary.distance, summary.core_s) == (0.2, 5.0)
    assert summary.refused == ("bad: it is empty",)


def test_nothing_remeshed_has_no_medians() -> None:
    summary = summarise([replace(REACHED, refused="it is empty")])
    assert (summary.distance, summary.core_s, summary.core_s_to) == (None, None, {})


@pytest.fixture
def _made_up(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(
        remeshing, "measure_remeshing", lambda *_: iter([replace(REACHED, attempts=("wrap: accepted",))])
    )


@pytest.mark.usefixtures("_made_up")
def test_as_json(invoke, folder: Path) -> None:
    shape, summary = map(json.loads, invoke("bench", "remeshing", folder, "--json").stdout.splitlines())
    assert (shape["file"], summary["n_accepted"]) == ("a", 1)


@pytest.mark.usefixtures("_made_up")
def test_as_a_table(invoke, folder: Path) -> None:
    shown = invoke("bench", "remeshing", folder, "--levels", "10").stdout
    assert "1 of 1 accepted" in shown
    assert "4.0 core-s" in shown


def test_levels_that_are_no_numbers_are_refused(invoke, folder: Path) -> None:
    assert invoke("bench", "remeshing", folder, "--levels", "many").exit_code == 2
