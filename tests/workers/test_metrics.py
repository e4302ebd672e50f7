"""What a run tells arrives where Prometheus looks for it."""

import json
import re
import threading
import urllib.request
from collections.abc import Callable, Iterator
from contextlib import nullcontext
from pathlib import Path
from unittest.mock import MagicMock

import pytest
import ray

from partwise.errors import WorkerError
from partwise.store.records import FailureKind
from partwise.workspace.figures import CollectionFigures
from partwise.workspace.progress import RunProgress
from partwise_workers import metrics, passes
from partwise_workers.events import ActorRestarted, InFlight, StageDone, StageFailed
from partwise_workers.metrics import CollectionMetrics, RunMetrics

POLL_S, PATIENCE_S = 0.5, 60.0
EVENTS = (
    InFlight(3),
    StageDone("alpha", 0.02),
    StageDone("alpha", 2.0),
    StageDone("beta", 0.02),
    StageFailed("alpha", FailureKind.MEMORY),
    ActorRestarted(FailureKind.MEMORY),
    ActorRestarted(None),
    InFlight(2),
)
FIGURES = CollectionFigures(7, 2, 90.0, 0.25, 3, 12.5, 0.4, 0.9)
SAMPLE = re.compile(r"^ray_(\w+)\{(.*)\} (\S+)$", re.MULTILINE)
LABEL = re.compile(r'(\w+)="([^"]*)"')
Value = Callable[..., float]


@pytest.fixture(scope="module")
def samples(local_ray: None) -> Iterator[list[tuple[str, dict[str, str], float]]]:
    """Name, labels and value of every sample that a node exports, once ours and Ray's own have arrived."""
    of_run = RunMetrics()
    for event in EVENTS:
        of_run(event)
    of_run.on_progress(RunProgress(5, 1, 9))
    of_collections = CollectionMetrics()
    of_collections.tell("mugs", FIGURES)
    of_collections.tell_stored(1_000)
    (node,) = ray.nodes()
    url = f"http://{node['NodeManagerAddress']}:{node['MetricsExportPort']}/metrics"
    for _ in range(int(PATIENCE_S / POLL_S)):
        text = urllib.request.urlopen(url, timeout=PATIENCE_S).read().decode()
        found = [(name, dict(LABEL.findall(labels)), float(value)) for name, labels, value in SAMPLE.findall(text)]
        if {"partwise_shapes_done_total", "partwise_stored_bytes", "node_mem_used"} <= {name for name, _, _ in found}:
            yield found
            return
        threading.Event().wait(POLL_S)
    pytest.fail(f"no metric has arrived at {url}")


@pytest.fixture
def value(samples: list[tuple[str, dict[str, str], float]]) -> Value:
    """The value of the one sample of a name with these labels."""

    def value(name: str, **labels: str) -> float:
        (found,) = [v for n, has, v in samples if n == name and labels.items() <= has.items()]
        return found

    return value


def test_shapes_done_are_counted_by_stage(value: Value) -> None:
    assert value("partwise_shapes_done_total", stage="alpha") == 2
    assert value("partwise_shapes_done_total", stage="beta") == 1


def test_shapes_failed_are_counted_by_stage_and_kind(value: Value) -> None:
    assert value("partwise_shapes_failed_total", stage="alpha", kind="memory") == 1


def test_seconds_are_spread_over_bins(value: Value) -> None:
    assert value("partwise_stage_seconds_bucket", stage="alpha", le="0.03") == 1
    assert value("partwise_stage_seconds_bucket", stage="alpha", le="3.0") == 2
    assert value("partwise_stage_seconds_sum", stage="alpha") == pytest.approx(2.02)


def test_what_is_in_flight_is_what_was_told_last(value: Value) -> None:
    assert value("partwise_shapes_in_flight") == 2


def test_restarts_are_counted_by_what_ended_the_process(value: Value) -> None:
    assert value("partwise_actor_restarts_total", kind="memory") == 1
    assert value("partwise_actor_restarts_total", kind="recycled") == 1


def test_what_the_run_has_yet_to_finish_is_told(value: Value) -> None:
    assert value("partwise_shapes_left") == 3


@pytest.mark.parametrize(
    ("name", "expected"),
    [
        ("queue_free", 7),
        ("queue_held", 2),
        ("queue_oldest_seconds", 90),
        ("scores_fresh_share", 0.25),
        ("model_version", 3),
        ("train_seconds", 12.5),
        ("mean_score", 0.4),
        ("blind_agreement", 0.9),
    ],
)
def test_figures_are_told_by_collection(value: Value, name: str, expected: float) -> None:
    assert value(f"partwise_{name}", collection="mugs") == expected


def test_nothing_is_labelled_by_shape_run_or_person(samples: list[tuple[str, dict[str, str], float]]) -> None:
    of_ours = [labels for name, labels, _ in samples if name.startswith("partwise_")]
    ours = {label for labels in of_ours for label in labels if label[0].islower() and "otel" not in label}
    assert ours == {"stage", "kind", "le", "collection"}


def test_the_dashboard_asks_for_metrics_that_there_are(samples: list[tuple[str, dict[str, str], float]]) -> None:
    dashboard = (Path(__file__).parents[2] / "deploy" / "grafana" / "partwise-workers.json").read_text(encoding="utf-8")
    queries = [target["expr"] for panel in json.loads(dashboard)["panels"] for target in panel["targets"]]
    asked = {name for query in queries for name in re.findall(r"ray_(\w+)", query)}
    assert len(asked) > 10
    assert asked <= {name for name, _, _ in samples}


@pytest.mark.parametrize("error", [None, KeyboardInterrupt, WorkerError])
def test_of_a_run_that_is_over_nothing_is_left(monkeypatch, error) -> None:
    left: list[int] = []

    class Metrics:
        def on_progress(self, run: RunProgress) -> None:
            left.append(run.n_total - run.n_done)

        def end(self) -> None:
            left.append(0)

    class Runner:
        def __init__(self, *_: object) -> None:
            pass

        def run(self, _tasks, n_total: int, on_progress) -> RunProgress:
            on_progress(RunProgress(1, 0, n_total))
            if error is not None:
                raise error
            return RunProgress(n_total, 0, n_total)

    monkeypatch.setattr(passes, "connected", nullcontext)
    monkeypatch.setattr(passes, "RunMetrics", Metrics)
    monkeypatch.setattr(passes, "StageRunner", Runner)
    with nullcontext() if error is None else pytest.raises(error):
        passes.run_tasks(MagicMock(), (), iter(()), 9, lambda _: None, lambda _: None, passes.nothing_else)
    assert left == [8, 0]


def test_the_end_of_a_run_sets_its_gauges_to_nothing(monkeypatch) -> None:
    shown: dict[str, float] = {}

    class Kept:
        def __init__(self, name: str, _about: str) -> None:
            self._name = name

        def set(self, value: float) -> None:
            shown[self._name] = value

    monkeypatch.setattr(metrics, "Gauge", Kept)
    made = RunMetrics()
    made.on_progress(RunProgress(1, 0, 9))
    made(InFlight(3))
    made.end()
    assert shown == {"partwise_shapes_left": 0, "partwise_shapes_in_flight": 0}
