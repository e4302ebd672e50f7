"""Stages with steps, and breaches of limits, on Ray: one run, made once; each test looks at one side of it."""

from collections import Counter
from collections.abc import Callable, Iterator, Mapping
from contextlib import AbstractContextManager
from pathlib import Path

import pytest

from partwise.store.records import FailureKind
from partwise_workers.events import ActorRestarted, InFlight, RunEvent, StageDone, StageFailed

SOURCES = {
    "good.off": "",
    "stubborn.off": "second 0: is refused\nsecond 1: hangs\nsecond 2: reads address zero",
    "hopeless.off": "second 0: refuses",
    "hungry.off": "first: allocates without end",
    "swollen.off": "first: swells",
}
DEADLINE_S, MEMORY_GB = 8.0, 0.6


@pytest.fixture(scope="module")
def ran(
    local_ray: None,
    tmp_path_factory: pytest.TempPathFactory,
    bench_in: Callable[[Path, Mapping[str, str]], AbstractContextManager],
) -> Iterator:
    with bench_in(tmp_path_factory.mktemp("steps"), SOURCES) as bench:
        bench = bench.with_limits(deadline_s=DEADLINE_S, memory_gb=MEMORY_GB).with_workers(recycle_after=1)
        bench = bench.with_stages(second={"n_steps": 4})
        events: list[RunEvent] = []
        bench.run(on_event=events.append)
        yield bench, events


def test_a_shape_goes_on_with_the_step_after_those_that_died(ran) -> None:
    run = ran[0].done("second")["stubborn.off"]
    assert run.summary["failed_steps"] == {
        "1": f"it took longer than deadline_s = {DEADLINE_S:g}",
        "2": "its process died (Segmentation fault), 2 times",
    }
    assert run.attempts == 4


def test_a_step_that_was_refused_is_not_made_again_after_a_death(ran) -> None:
    assert ran[0].done("second")["stubborn.off"].summary["refused_steps"] == {"0": {"why": "it is not near enough"}}
    assert ran[0].n_noted("refused") == 1


def test_what_other_stages_had_finished_is_not_made_again(ran) -> None:
    assert ran[0].done("first")["stubborn.off"].attempts == 1
    assert len(list(ran[0].log.glob("first-stubborn.off.*"))) == 1


def test_a_step_that_raises_ends_the_stage(ran) -> None:
    run = ran[0].failed("second")["hopeless.off"]
    assert (run.summary["kind"], run.attempts) == ("error", 1)


def test_a_process_that_grows_past_its_ceiling_is_killed(ran) -> None:
    run = ran[0].failed("first")["hungry.off"]
    assert f"grew past memory_gb = {MEMORY_GB:g}, to " in run.reason
    assert (run.summary["kind"], run.attempts) == ("memory", 1)


def test_the_log_of_a_process_that_died_is_on_record(ran) -> None:
    assert "first: it allocates without end now" in ran[0].failed("first")["hungry.off"].summary["log"]


def test_every_event_is_told(ran) -> None:
    counts = Counter(event if isinstance(event, StageFailed) else type(event) for event in ran[1])
    assert counts[StageDone] == len(ran[0].done("first")) + len(ran[0].done("second"))
    assert counts[StageFailed("first", FailureKind.MEMORY)] == 1
    assert counts[StageFailed("second", FailureKind.ERROR)] == 1


def test_restarts_are_told_with_what_ended_the_process(ran) -> None:
    kinds = Counter(event.kind for event in ran[1] if isinstance(event, ActorRestarted))
    assert kinds[FailureKind.DEADLINE] == 1
    assert kinds[FailureKind.CRASH] == 2
    assert kinds[FailureKind.MEMORY] == 1
    assert kinds[None] == 5  # recycled after each shape that it survived, and once for what it kept


def test_a_shape_whose_process_keeps_too_much_memory_goes_on_in_another(ran) -> None:
    attempts = [ran[0].done(stage)["swollen.off"].attempts for stage in ("first", "second")]
    assert attempts == [1, 1]
    assert len(list(ran[0].log.glob("first-swollen.off.*"))) == 1


def test_shapes_in_flight_end_at_none(ran) -> None:
    flights = [event.n for event in ran[1] if isinstance(event, InFlight)]
    assert max(flights) >= 2
    assert flights[-1] == 0


def test_nothing_stays_staged(ran) -> None:
    assert list(ran[0].workspace.arrays.staged_keys()) == []
