"""bench throughput: a clock over the same shapes for every number of actors. The runs themselves are made up."""

import json
from contextlib import nullcontext
from pathlib import Path

import pytest

from partwise.workspace.progress import RunProgress
from partwise.workspace.workspace import Workspace
from partwise_cli.bench import throughput
from partwise_cli.bench.throughput import (
    Throughput,
    ThroughputReport,
    ThroughputRequest,
    _Clock,
    measure_throughput,
    ratios,
)
from partwise_cli.run_tally import RunTally
from partwise_workers.events import InFlight, StageDone


@pytest.fixture
def now(monkeypatch: pytest.MonkeyPatch) -> list[float]:
    """The time, to be set."""
    time = [0.0]
    monkeypatch.setattr(throughput.time, "perf_counter", lambda: time[0])
    return time


def test_the_clock_runs_from_the_end_of_the_warm_up_to_the_last_shape(now: list[float]) -> None:
    clock = _Clock(2, 0.0)
    for n_done in range(6):
        now[0] += 10
        clock.on_progress(RunProgress(n_done, 0, 5))
    now[0] += 10
    clock.on_progress(RunProgress(0, 0, 0))  # labels that move afterwards: none
    assert (clock.counts_from, clock.ended) == (30, 60)


def test_time_in_stages_is_that_of_shapes_that_count(now: list[float]) -> None:
    clock = _Clock(1, 0.0)
    clock.on_event(StageDone("mesh", 5.0))
    clock.on_progress(RunProgress(1, 0, 3))
    for event in (StageDone("mesh", 2.0), InFlight(1), StageDone("remesh", 3.0)):
        clock.on_event(event)
    assert clock.stage_s == 5.0


def test_rates_are_compared_with_the_first() -> None:
    assert ratios([10.0, 19.0]) == (1.0, 1.9)


@pytest.fixture
def seen(monkeypatch: pytest.MonkeyPatch, now: list[float]) -> list[tuple[int, int, list[str]]]:
    """What each run was given: actors, faces to label, and shapes. A shape takes a minute over the number of actors."""
    seen = []

    def preprocess(workspace: Workspace, collection, on_progress, on_event) -> RunProgress:
        keys = [shape.source_key for shape in workspace.catalog.shapes(collection.id)]
        n_actors = workspace.config.workers.n_actors
        seen.append((n_actors, collection.settings["working_faces"], keys))
        on_progress(RunProgress(0, 0, len(keys)))
        for n_done in range(1, len(keys) + 1):
            now[0] += 60 / n_actors
            on_event(StageDone("mesh", 60.0))
            on_progress(RunProgress(n_done, 0, len(keys)))
        return RunProgress(len(keys), 0, len(keys))

    monkeypatch.setattr(throughput, "preprocess", preprocess)
    monkeypatch.setattr(throughput, "connected", lambda n_cpus: nullcontext())
    return seen


def test_all_runs_are_over_the_same_shapes(seen, tmp_path: Path) -> None:
    request = ThroughputRequest(3, n_faces=1000, levels=(800,))
    report = measure_throughput(tmp_path, request, lambda *_: None, lambda _: nullcontext(RunTally()))
    (one, faces, shapes), (two, *same) = seen
    assert (one, two, faces, len(shapes)) == (1, 2, 800, 7)
    assert same == [faces, shapes]
    assert [run.rate_per_min for run in report.runs] == [1.0, 2.0]
    assert report.ratios == (1.0, 2.0)
    assert [run.warm_up_s for run in report.runs] == [240.0, 120.0]
    assert not list(tmp_path.glob("throughput-*"))


MADE_UP = ThroughputReport(
    (Throughput(1, 3, 0, 9.0, 60.0, 3.0, 59.0), Throughput(2, 3, 0, 8.0, 31.5, 5.71, 62.0)), (1.0, 1.905)
)


@pytest.fixture
def _made_up(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(throughput, "measure_throughput", lambda *_: MADE_UP)


@pytest.mark.usefixtures("_made_up")
def test_as_json(invoke, tmp_path: Path) -> None:
    assert json.loads(invoke("bench", "throughput", tmp_path, "--json").stdout)["ratios"] == [1.0, 1.905]


@pytest.mark.usefixtures("_made_up")
def test_as_a_table(invoke, tmp_path: Path) -> None:
    rows = [
        [cell.strip() for cell in line.strip("│").split("│")]
        for line in invoke("bench", "throughput", tmp_path).stdout.splitlines()
        if line.startswith("│")
    ]
    assert rows == [["1", "3.0", "1.00", "60", "59", "9", "0"], ["2", "5.7", "1.91", "32", "62", "8", "0"]]
