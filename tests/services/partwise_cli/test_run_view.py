"""How a run over shapes is shown: rate and time left from what finished of late, a live view, or plain lines."""

import io

import pytest
from rich.console import Console

from partwise.store.records import FailureKind
from partwise.workspace.progress import RunProgress
from partwise_cli.run_tally import RunTally
from partwise_cli.run_view import RunLines, duration, run_progress, view
from partwise_workers.events import ActorRestarted, InFlight, StageDone, StageFailed


class Clock:
    """Stands still until it is set."""

    def __init__(self) -> None:
        self.now = 1000.0

    def __call__(self) -> float:
        return self.now


@pytest.fixture
def clock() -> Clock:
    return Clock()


@pytest.fixture
def tally(clock: Clock) -> RunTally:
    return RunTally(clock)


def advance(tally: RunTally, clock: Clock, seconds: float, n_done: int, n_failed: int = 0, n_total: int = 100) -> None:
    clock.now += seconds
    tally.on_progress(RunProgress(n_done, n_failed, n_total))


def test_nothing_is_known_at_first(tally: RunTally) -> None:
    assert tally.per_min is None
    assert tally.left_s is None


def test_rate_and_time_left_follow_from_what_is_finished(tally: RunTally, clock: Clock) -> None:
    advance(tally, clock, 0, 0)
    advance(tally, clock, 30, 8, 2)
    assert tally.per_min == 20
    assert tally.left_s == 270


def test_the_rate_is_that_of_late(tally: RunTally, clock: Clock) -> None:
    advance(tally, clock, 0, 0, n_total=10_000)
    for n_done in range(100, 2000, 100):  # 100 a minute
        advance(tally, clock, 60, n_done, n_total=10_000)
    for _ in range(6):
        n_done += 10
        advance(tally, clock, 60, n_done, n_total=10_000)
    assert tally.per_min == 10


def test_the_rate_falls_while_nothing_finishes(tally: RunTally, clock: Clock) -> None:
    advance(tally, clock, 0, 0)
    advance(tally, clock, 30, 10)
    clock.now += 30
    assert tally.per_min == 10


def test_a_new_round_has_a_rate_of_its_own(tally: RunTally, clock: Clock) -> None:
    advance(tally, clock, 0, 0)
    advance(tally, clock, 60, 100)
    advance(tally, clock, 0, 0, n_total=5)
    advance(tally, clock, 60, 1, n_total=5)
    assert tally.per_min == 1


def tell_all(tally: RunTally) -> None:
    for event in (
        InFlight(4),
        *[StageDone("mesh", 0.1)] * 1200,
        StageDone("remesh", 5.0),
        StageFailed("remesh", FailureKind.MEMORY),
        ActorRestarted(FailureKind.MEMORY),
        ActorRestarted(None),
        InFlight(2),
    ):
        tally.on_event(event)


def test_events_are_counted(tally: RunTally) -> None:
    tell_all(tally)
    assert tally.stages == {"mesh": [1200, 0], "remesh": [1, 1]}
    assert tally.failures == {FailureKind.MEMORY: 1}
    assert (tally.n_in_flight, tally.n_restarted, tally.n_recycled) == (2, 1, 1)


def shown(tally: RunTally) -> list[str]:
    console = Console(file=io.StringIO(), width=120, highlight=False)
    console.print(view("preprocess", tally))
    text = console.file.getvalue()  # type: ignore[attr-defined]
    return [" ".join(line.split()) for line in text.splitlines()]


def test_the_view_shows_pace_stages_and_failures(tally: RunTally, clock: Clock) -> None:
    advance(tally, clock, 0, 0, n_total=2400)
    tell_all(tally)
    advance(tally, clock, 60, 1199, 1, n_total=2400)
    head, *rest = shown(tally)
    assert head.startswith("preprocess")
    assert head.endswith("1,200/2,400 50% 1,200 shapes/min · 60 s left")
    assert rest == [
        "stage done failed",
        "mesh 1,200 0",
        "remesh 1 1",
        "2 in flight · 1 failed (memory 1) · 1 process lost · 1 recycled",
    ]


def test_the_view_of_nothing_is_empty(tally: RunTally) -> None:
    assert shown(tally) == [""]


@pytest.fixture
def printed() -> list[str]:
    return []


@pytest.fixture
def lines(clock: Clock, printed: list[str]) -> RunLines:
    return RunLines("preprocess", printed.append, clock)


def test_lines_come_when_enough_is_done_but_not_too_often(lines: RunLines, clock: Clock, printed: list[str]) -> None:
    advance(lines, clock, 0, 0)
    for n_done in range(1, 41):
        advance(lines, clock, 1, n_done)
    assert [line.split(" · ")[0] for line in printed] == [f"preprocess: {n} of 100" for n in (10, 20, 30, 40)]


def test_slow_runs_have_a_line_a_minute(lines: RunLines, clock: Clock, printed: list[str]) -> None:
    advance(lines, clock, 0, 0, n_total=100_000)
    for n_done in range(1, 13):
        advance(lines, clock, 10, n_done, n_total=100_000)
    assert [line.split(" · ")[0] for line in printed] == ["preprocess: 6 of 100,000", "preprocess: 12 of 100,000"]


def test_a_line_has_pace_and_failures_by_kind(lines: RunLines, clock: Clock, printed: list[str]) -> None:
    advance(lines, clock, 0, 0)
    tell_all(lines)
    advance(lines, clock, 60, 49, 1)
    assert printed == [
        "preprocess: 50 of 100 · 50 shapes/min · 60 s left · 2 in flight · 1 failed (memory 1) · 1 process lost"
        " · 1 recycled"
    ]


def test_the_end_is_told_once(lines: RunLines, clock: Clock, printed: list[str]) -> None:
    advance(lines, clock, 0, 0, n_total=2)
    advance(lines, clock, 3, 1, n_total=2)
    advance(lines, clock, 3, 2, n_total=2)
    lines.finish()
    assert printed == ["preprocess: 2 of 2 · 20 shapes/min · in 6 s"]


def test_nothing_is_in_flight_at_the_end(lines: RunLines, clock: Clock, printed: list[str]) -> None:
    lines.on_event(InFlight(1))
    advance(lines, clock, 6, 2, n_total=2)
    assert printed == ["preprocess: 2 of 2 · in 6 s"]


def test_where_a_run_ends_early_is_told(lines: RunLines, clock: Clock, printed: list[str]) -> None:
    advance(lines, clock, 0, 0, n_total=4)
    advance(lines, clock, 3, 1, n_total=4)
    lines.finish()
    assert [line.split(" · ")[0] for line in printed] == ["preprocess: 1 of 4"]


def test_a_second_round_is_told_too(lines: RunLines, clock: Clock, printed: list[str]) -> None:
    advance(lines, clock, 1, 2, n_total=2)
    advance(lines, clock, 1, 1, n_total=1)
    assert [line.split(" · ")[0] for line in printed] == ["preprocess: 2 of 2", "preprocess: 1 of 1"]


def test_without_a_terminal_there_are_lines(capsys: pytest.CaptureFixture[str]) -> None:
    with run_progress("refine") as tally:
        tally.on_progress(RunProgress(1, 0, 1))
    assert capsys.readouterr().err.startswith("refine: 1 of 1")


def test_nothing_to_do_is_not_told(capsys: pytest.CaptureFixture[str]) -> None:
    with run_progress("refine") as tally:
        tally.on_progress(RunProgress(0, 0, 0))
    assert capsys.readouterr().err == ""


def test_on_a_terminal_there_is_a_live_view(monkeypatch: pytest.MonkeyPatch) -> None:
    terminal = io.StringIO()
    terminal.isatty = lambda: True  # type: ignore[method-assign]
    monkeypatch.setattr("sys.stderr", terminal)
    with run_progress("refine") as tally:
        tally.on_event(StageDone("refine", 1.0))
        tally.on_progress(RunProgress(1, 0, 1))
    assert "refine" in terminal.getvalue()
    assert "1/1" in terminal.getvalue()


@pytest.mark.parametrize(
    ("seconds", "text"),
    [(0, "0 s"), (89, "89 s"), (90, "2 min"), (3600, "60 min"), (11_100, "3 h 05 min"), (1e6, "12 days")],
)
def test_durations_read_well(seconds: float, text: str) -> None:
    assert duration(seconds) == text
