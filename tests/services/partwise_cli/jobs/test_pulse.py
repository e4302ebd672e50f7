"""Signs of life: how far a job is, and what its owner learns from them."""

import threading

import pytest

from partwise.errors import StoreError
from partwise.store.records import JobKind, JobState, Progress
from partwise_cli.jobs.pulse import Pulse
from partwise_cli.jobs.stopping import JobStoppedError, StopReason


@pytest.fixture
def job(workspace, enqueue):
    enqueue(JobKind.EXPORT)
    return workspace.catalog.claim_job("w1")


def _pulse(workspace, job, **given) -> Pulse:
    return Pulse(given.pop("catalog", workspace.catalog), job, "w1", workspace.config.jobs, **given)


def _reason(pulse: Pulse) -> StopReason:
    with pytest.raises(JobStoppedError) as stopped:
        pulse.raise_if_stopped()
    return stopped.value.reason


def test_the_last_progress_told_goes_out(workspace, job) -> None:
    pulse = _pulse(workspace, job)
    pulse.tell(Progress(1, 0, 9))
    pulse.tell(Progress(2, 1, 9, "half way"))
    pulse.give()
    assert workspace.catalog.job(job.id).progress == Progress(2, 1, 9, "half way")
    pulse.raise_if_stopped()


def test_it_beats_by_itself_while_the_job_is_worked_on(workspace, job) -> None:
    with _pulse(workspace, job) as pulse:
        for n_done in (1, 2):
            pulse.tell(Progress(n_done))
            while workspace.catalog.job(job.id).progress.n_done < n_done:
                threading.Event().wait(0.005)
    assert workspace.catalog.job(job.id).heartbeat_at > job.heartbeat_at


def test_it_learns_that_the_job_is_to_stop(workspace, job) -> None:
    pulse = _pulse(workspace, job)
    workspace.catalog.cancel_job(job.id)
    assert not pulse.is_stopped
    pulse.give()
    assert _reason(pulse) is StopReason.CANCELLED


def test_it_learns_that_the_job_is_no_more_its_owners(workspace, job) -> None:
    pulse = _pulse(workspace, job)
    workspace.catalog.finish_job(job.id, "w1", JobState.DONE)
    pulse.give()
    assert _reason(pulse) is StopReason.LOST


class Unreachable:
    def heartbeat_job(self, *_):
        raise StoreError("the catalog cannot be reached")


def test_a_catalog_that_is_away_for_long_loses_the_job(workspace, job) -> None:
    now = [0.0]
    pulse = _pulse(workspace, job, catalog=Unreachable(), clock=lambda: now[0])
    now[0] = workspace.config.jobs.lost_after_s * 0.9
    pulse.give()
    pulse.raise_if_stopped()
    now[0] = workspace.config.jobs.lost_after_s
    pulse.give()
    assert _reason(pulse) is StopReason.LOST
