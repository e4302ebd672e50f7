"""Background work lets others have their turn."""

import pytest

from partwise.store.records import Job, JobKind
from partwise_cli.jobs.pulse import Pulse
from partwise_cli.jobs.stopping import JobStoppedError, StopReason
from partwise_cli.jobs.turns import CHECK_S, SLICE_S, Turn
from partwise_cli.jobs.work import Work
from partwise_workers.events import ignore_events


class Clock:
    now = 0.0

    def __call__(self) -> float:
        return self.now


@pytest.fixture
def clock() -> Clock:
    return Clock()


def _work(workspace, job: Job, kinds=tuple(JobKind)) -> Work:
    pulse = Pulse(workspace.catalog, job, "w1", workspace.config.jobs)
    collection = workspace.catalog.get_collection("mugs")
    return Work(workspace, collection, job, "w1", kinds, None, pulse, lambda: None, ignore_events)


@pytest.fixture
def work(workspace, enqueue) -> Work:
    """An evaluation that its owner has begun."""
    enqueue(JobKind.EVALUATE)
    return _work(workspace, workspace.catalog.claim_job("w1"))


def test_it_goes_on_while_nobody_waits(work, clock) -> None:
    turn = Turn(work, clock=clock)
    clock.now = 2 * SLICE_S
    assert turn.may_go_on()
    turn.raise_if_over()


def test_it_gives_way_to_a_training(work, clock, enqueue) -> None:
    turn = Turn(work, clock=clock)
    waiting = enqueue(JobKind.TRAIN)
    assert turn.may_go_on()
    clock.now = CHECK_S
    assert not turn.may_go_on()
    with pytest.raises(JobStoppedError, match=f"gives way to job {waiting.id}, train") as stopped:
        turn.raise_if_over()
    assert stopped.value.reason is StopReason.GIVES_WAY


def test_it_gives_way_to_background_work_after_its_time(work, clock, enqueue) -> None:
    turn = Turn(work, clock=clock)
    enqueue(JobKind.PREPROCESS)
    clock.now = SLICE_S - CHECK_S
    assert turn.may_go_on()
    clock.now = SLICE_S
    assert not turn.may_go_on()


def test_it_does_not_give_way_to_what_its_worker_would_not_do(workspace, work, clock, enqueue) -> None:
    turn = Turn(_work(workspace, work.job, [JobKind.EVALUATE]), clock=clock)
    enqueue(JobKind.TRAIN)
    clock.now = SLICE_S
    assert turn.may_go_on()


def test_it_does_not_give_way_to_what_cannot_begin_yet(workspace, work, clock, enqueue) -> None:
    enqueue(JobKind.TRAIN)
    workspace.catalog.claim_job("w2")
    enqueue(JobKind.TRAIN)
    turn = Turn(work, clock=clock)
    clock.now = CHECK_S
    assert turn.may_go_on()


def test_a_run_that_has_become_moot_stops_but_not_its_job(work, clock) -> None:
    turn = Turn(work, lambda: True, clock)
    clock.now = CHECK_S
    assert not turn.may_go_on()
    turn.raise_if_over()


def test_it_stops_with_its_job(workspace, work, clock) -> None:
    turn = Turn(work, clock=clock)
    workspace.catalog.cancel_job(work.job.id)
    work.pulse.give()
    assert not turn.may_go_on()
    with pytest.raises(JobStoppedError, match="cancelled"):
        turn.raise_if_over()
