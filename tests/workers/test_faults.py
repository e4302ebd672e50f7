"""Every way to take a process down, mixed into a good collection, on a Ray of its own.

All good shapes finish, all bad ones are named with what ended them, within what the deadlines allow.
"""

import time
from collections.abc import Callable, Iterator, Mapping
from contextlib import AbstractContextManager
from dataclasses import dataclass
from pathlib import Path

import pytest

from partwise.store.records import StageRun
from partwise.workspace.progress import RunProgress
from partwise_workers.cluster import connected

pytestmark = [pytest.mark.slow, pytest.mark.timeout(900)]

GOOD = [f"good{number:02d}.off" for number in range(20)]
BAD = {
    "hangs": "deadline",
    "hangs with the interpreter": "deadline",
    "allocates without end": "memory",
    "reads address zero": "crash",
    "aborts": "crash",
    "exits": "crash",
    "dies": "crash",
    "leaves": "error",
    "crashes": "error",
    "refuses": "error",
}
STEPPED = "stepped.off"
DEADLINE_S, MEMORY_GB, MAX_ATTEMPTS, N_STEPS = 15.0, 0.6, 2, 3
RESTART_S = 45.0
"""Far more than it takes to learn a dead process' last words and to start another, on a busy machine."""


def key_of(behaviour: str) -> str:
    return f"{behaviour.replace(' ', '-')}.off"


def sources() -> dict[str, str]:
    """Bad ones at the first stage, among good ones; one that goes bad at two steps of the second."""
    bad = {key_of(behaviour): f"first: {behaviour}" for behaviour in BAD}
    return {**dict.fromkeys(GOOD, ""), **bad, STEPPED: "second 0: hangs with the interpreter\nsecond 1: aborts"}


@dataclass(frozen=True)
class Ran:
    """`seconds` : what the run took, processes' start included."""

    done: Mapping[str, StageRun]
    failed: Mapping[str, StageRun]
    progress: RunProgress
    staged: list[str]
    seconds: float


@pytest.fixture(scope="module")
def ran(
    tmp_path_factory: pytest.TempPathFactory,
    bench_in: Callable[[Path, Mapping[str, str]], AbstractContextManager],
) -> Iterator[Ran]:
    with bench_in(tmp_path_factory.mktemp("faults"), sources()) as bench, connected(n_cpus=2):
        bench = bench.with_limits(deadline_s=DEADLINE_S, memory_gb=MEMORY_GB)
        bench = bench.with_workers(max_attempts=MAX_ATTEMPTS, recycle_after=5, block_shapes=4)
        bench = bench.with_stages(second={"n_steps": N_STEPS})
        started = time.monotonic()
        progress = bench.run()
        seconds = time.monotonic() - started
        staged = list(bench.workspace.arrays.staged_keys())
        yield Ran(bench.done("second"), bench.failed("first"), progress, staged, seconds)


def test_every_good_shape_finishes(ran: Ran) -> None:
    assert set(ran.done) == {*GOOD, STEPPED}


def test_every_bad_shape_is_named_with_what_ended_it(ran: Ran) -> None:
    kinds = {key: run.summary["kind"] for key, run in ran.failed.items()}
    assert kinds == {key_of(behaviour): kind for behaviour, kind in BAD.items()}


def test_all_are_counted(ran: Ran) -> None:
    assert ran.progress == RunProgress(len(GOOD) + 1, len(BAD), len(GOOD) + 1 + len(BAD))


@pytest.mark.parametrize("behaviour", [behaviour for behaviour, kind in BAD.items() if kind != "error"])
def test_the_log_of_a_process_that_died_is_on_record(ran: Ran, behaviour: str) -> None:
    assert f"first: it {behaviour} now" in ran.failed[key_of(behaviour)].summary["log"]


@pytest.mark.parametrize(("behaviour", "words"), [("reads address zero", "Segmentation fault"), ("aborts", "Aborted")])
def test_a_native_crash_is_named(ran: Ran, behaviour: str, words: str) -> None:
    run = ran.failed[key_of(behaviour)]
    assert run.reason is not None
    assert f"its process died ({words}), {MAX_ATTEMPTS} times" in run.reason
    assert "Current thread" in run.summary["log"]


def test_only_crashes_are_tried_again(ran: Ran) -> None:
    attempts = {key: run.attempts for key, run in ran.failed.items()}
    assert attempts == {key_of(b): MAX_ATTEMPTS if kind == "crash" else 1 for b, kind in BAD.items()}


def test_a_shape_with_steps_finishes_with_the_one_that_works(ran: Ran) -> None:
    run = ran.done[STEPPED]
    assert list(run.summary["failed_steps"]) == ["0", "1"]
    assert run.attempts == N_STEPS + 1


def test_nothing_stays_staged(ran: Ran) -> None:
    assert ran.staged == []


def test_the_run_ends_within_what_the_deadlines_allow(ran: Ran) -> None:
    n_deaths = sum(run.attempts for run in ran.failed.values() if run.summary["kind"] != "error") + N_STEPS
    n_calls = 2 * len(GOOD) + n_deaths + len(BAD)
    assert ran.seconds < n_calls * DEADLINE_S + n_deaths * RESTART_S
