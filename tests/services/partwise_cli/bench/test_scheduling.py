"""bench scheduling: no-op shapes take the whole way, and every part of it is timed."""

import json

import pytest

from partwise_cli.bench.noop_stage import noop_chain
from partwise_cli.bench.scheduling import MemorySample, SchedulingCost, _Parts, measure_scheduling

N_SHAPES, N_STAGES = 150, 2


@pytest.fixture(scope="module")
def cost(local_ray: None, tmp_path_factory: pytest.TempPathFactory) -> SchedulingCost:
    return measure_scheduling(tmp_path_factory.mktemp("bench") / "ws", N_SHAPES, 2, N_STAGES, lambda progress: None)


def test_every_shape_goes_all_the_way(cost: SchedulingCost) -> None:
    assert (cost.n_shapes, cost.n_stages, cost.n_failed) == (N_SHAPES, N_STAGES, 0)
    assert cost.memory[-1].n_done == N_SHAPES


def test_the_whole_and_its_parts_are_timed(cost: SchedulingCost) -> None:
    assert cost.wall_ms > 0
    assert cost.core_ms["total"] == pytest.approx(sum(v for k, v in cost.core_ms.items() if k != "total"), abs=1e-3)
    assert {"driver", "actors", "packer", "total"} <= cost.core_ms.keys()
    assert {"count", "plan", "catalog", "sweep"} <= cost.parts_wall_ms.keys()
    assert {"stage", "read staged", "delete staged"} <= cost.once_ms.keys()


def test_stages_form_a_chain() -> None:
    assert [(stage.name, stage.reads) for stage in noop_chain(3)] == [
        ("noop1", None),
        ("noop2", "noop1"),
        ("noop3", "noop2"),
    ]


def test_a_part_within_a_part_counts_once() -> None:
    parts = _Parts()
    with parts.timed("whole"), parts.timed("catalog"):
        total = sum(range(100_000))
    with parts.timed("catalog"):
        total += 1
    assert parts.core_s["catalog"] > parts.core_s["whole"]


MADE_UP = SchedulingCost(
    100, 1, 2, 0, 3.0, {"driver": 1.0, "total": 2.5}, {"plan": 0.1}, {"plan": 0.05, "rest": 0.9}, {"stage": 0.7},
    {"ray": 4.0}, tuple(MemorySample(n, 200.0 + n) for n in range(21)),
)  # fmt: skip


@pytest.fixture
def _made_up(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("partwise_cli.bench.scheduling.measure_scheduling", lambda *_: MADE_UP)


@pytest.mark.usefixtures("_made_up")
def test_as_json(invoke) -> None:
    found = json.loads(invoke("bench", "scheduling", "--json").stdout)
    assert (found["wall_ms"], found["core_ms"]["total"]) == (3.0, 2.5)


@pytest.mark.usefixtures("_made_up")
def test_as_a_table(invoke) -> None:
    lines = invoke("bench", "scheduling").stdout.splitlines()
    assert any("all of it" in line and "3.000" in line and "2.500" in line for line in lines)
    assert lines[-1] == "driver's memory: 200 MB at 0, 202 MB at 2, 210 MB at 10, 220 MB at 20"


def test_what_does_not_grow_with_the_collection_is_said_apart(cost: SchedulingCost) -> None:
    assert cost.before_s.keys() == {"rows", "ray", "first shape", "core of an actor's start"}
