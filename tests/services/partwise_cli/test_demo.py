"""demo: what it refuses and what it shows. The demo itself is run as a whole elsewhere: it needs Ray."""

import json
from pathlib import Path

import pytest

from partwise.errors import ConfigError, ParameterError
from partwise.store.records import Shape
from partwise.workspace.assessment import ShapeAccuracy
from partwise_cli import demo
from partwise_cli.demo import MARKER, DemoReport, DemoRequest, Remeshing, prepare_folder
from partwise_cli.demo_report import print_report, report_as_json


def _accuracies(values: list[float]) -> tuple[ShapeAccuracy, ...]:
    shapes = [Shape(i, 1, f"{i}.off", "", ".off", None) for i in range(len(values))]
    return tuple(ShapeAccuracy(shape, value, value / 2) for shape, value in zip(shapes, values, strict=True))


@pytest.fixture
def report(tmp_path: Path) -> DemoReport:
    """Eight shapes, the least certain first: refinement makes each a tenth better."""
    predicted = [0.1, 0.2, 0.5, 0.5, 0.5, 0.5, 0.8, 0.9]
    return DemoReport(
        request=DemoRequest("mugs", 10, 2, 1, 50),
        n_described=10,
        remeshing=Remeshing(7, 2, 1, 3.14),
        n_unjudged=1,
        predicted=_accuracies(predicted),
        refined=_accuracies([value + 0.1 for value in predicted]),
        model_version=1,
        seconds={"simulate": 1.0, "train": 2.4},
        shapes=tmp_path / "shapes",
        workspace=tmp_path / "[lab] ws",
        exported=tmp_path / "labels",
        picture=tmp_path / "worst.png",
    )


def test_a_folder_that_holds_something_is_refused(invoke, tmp_path: Path) -> None:
    (tmp_path / "thesis.tex").write_text("")
    result = invoke("demo", tmp_path)
    assert isinstance(result.exception, ConfigError)
    assert str(tmp_path) in str(result.exception)


def test_a_file_is_refused(invoke, tmp_path: Path) -> None:
    (tmp_path / "out").write_text("")
    assert isinstance(invoke("demo", tmp_path / "out").exception, ConfigError)


def test_an_unknown_category_is_refused_before_anything_is_made(invoke, tmp_path: Path) -> None:
    assert isinstance(invoke("demo", tmp_path / "out", "--category", "cups").exception, ParameterError)
    assert not (tmp_path / "out").exists()


@pytest.mark.parametrize("option", [("--count", "5"), ("--confirmed", "1"), ("--seed", "-1"), ("--iterations", "0")])
def test_numbers_out_of_range_are_wrong_usage(invoke, tmp_path: Path, option: tuple[str, str]) -> None:
    assert invoke("demo", tmp_path / "out", *option).exit_code == 2


def test_quarters_are_taken_by_rank(report: DemoReport) -> None:
    accuracy = report_as_json(report)["accuracy"]
    assert accuracy["all"]["predicted"] == pytest.approx(0.5)
    assert accuracy["least certain quarter"]["predicted"] == pytest.approx(0.15)
    assert accuracy["most certain quarter"]["predicted"] == pytest.approx(0.85)
    assert accuracy["all"]["refined"] == pytest.approx(0.6)
    assert accuracy["all"]["refined_by_area"] == pytest.approx(0.3)


def test_the_report_shows_figures_and_where_files_are(report: DemoReport, capsys: pytest.CaptureFixture[str]) -> None:
    print_report(report)
    out = capsys.readouterr().out
    assert "8 mugs nobody labelled, after 2 confirmed" in out
    (row,) = [line for line in out.splitlines() if line.startswith("│ all")]
    assert [cell.strip() for cell in row.strip("│").split("│")] == ["all", "50.0%", "60.0%", "25.0%", "30.0%"]
    assert "3 s: simulate 1 s, train 2 s" in out
    assert "1 shape whose ground truth did not come to the new mesh whole" in out
    assert "7 shapes taken as they are, 2 soups remeshed at a median of 3.1 core-seconds, 1 could not be" in out
    for path in (report.shapes, report.workspace, report.exported, report.picture):
        assert str(path) in out


def test_the_demo_as_json(invoke, report: DemoReport, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(demo, "run_demo", lambda out, request: report)
    document = json.loads(invoke("demo", tmp_path / "out", "--json").stdout)
    assert set(document["accuracy"]) == {"all", "most certain quarter", "least certain quarter"}


def test_a_demo_replaces_an_earlier_one_and_nothing_else(tmp_path: Path) -> None:
    prepare_folder(tmp_path)
    (tmp_path / "shapes").mkdir()
    (tmp_path / "mine.txt").write_text("stays")
    prepare_folder(tmp_path)
    assert sorted(path.name for path in tmp_path.iterdir()) == [MARKER, "mine.txt"]


def test_a_folder_that_no_demo_made_is_left_alone(tmp_path: Path) -> None:
    (tmp_path / "shapes").mkdir()
    with pytest.raises(ConfigError, match="empty folder"):
        prepare_folder(tmp_path)
    assert (tmp_path / "shapes").is_dir()
