"""Workers: one owner for each job, whatever becomes of it; the worker outlives what its jobs do."""

import threading
from datetime import timedelta

import pytest
from sqlalchemy import update

from partwise.errors import ConfigError, NotEnoughDataError, ParameterError, StoreError, WorkerError
from partwise.store import tables as t
from partwise.store.records import JobKind, JobState
from partwise.store.sql.dialect import seconds_ago
from partwise_cli.jobs import presence
from partwise_cli.jobs.stopping import JobStoppedError, StopReason
from partwise_cli.jobs.work import Outcome
from partwise_cli.jobs.worker import new_owner

AT_ONCE = timedelta(hours=-1)


def make_silent(workspace, job) -> None:
    """As if its owner had said nothing for five minutes."""
    with workspace.catalog._engine.begin() as connection:
        connection.execute(update(t.job).where(t.job.c.id == job.id).values(heartbeat_at=seconds_ago(300.0)))


def done(work) -> Outcome:
    return Outcome("done so", {"n": 3})


def raising(error: BaseException):
    def handler(work):
        raise error

    return handler


def until_stopped(work):
    """Works until it is told to stop; a test whose job is never stopped fails by its timeout."""
    while not work.pulse.is_stopped:
        threading.Event().wait(0.005)
    work.pulse.raise_if_stopped()


def test_a_job_is_done_and_its_outcome_on_record(worker, workspace, enqueue) -> None:
    job = enqueue(JobKind.EXPORT)
    worker({JobKind.EXPORT: done}).run(once=True)
    ended = workspace.catalog.job(job.id)
    assert (ended.state, ended.progress.message, ended.result) == (JobState.DONE, "done so", {"n": 3})


def test_what_waits_is_done_in_turn_with_what_comes_of_it(worker, workspace, enqueue) -> None:
    begun = []

    def train(work) -> Outcome:
        begun.append(work.job.kind)
        enqueue(JobKind.EVALUATE)
        return Outcome("")

    def evaluate(work) -> Outcome:
        begun.append(work.job.kind)
        return Outcome("")

    enqueue(JobKind.TRAIN)
    worker({JobKind.TRAIN: train, JobKind.EVALUATE: evaluate}).run(once=True)
    assert begun == [JobKind.TRAIN, JobKind.EVALUATE]


def test_only_kinds_that_it_can_do_and_is_to_do(worker, workspace, enqueue) -> None:
    jobs = {kind: enqueue(kind) for kind in (JobKind.EXPORT, JobKind.TRAIN, JobKind.INGEST)}
    worker({JobKind.EXPORT: done, JobKind.TRAIN: done}, kinds=[JobKind.EXPORT]).run(once=True)
    states = {kind: workspace.catalog.job(job.id).state for kind, job in jobs.items()}
    assert states == {
        JobKind.EXPORT: JobState.DONE,
        JobKind.TRAIN: JobState.PENDING,
        JobKind.INGEST: JobState.PENDING,
    }


def test_only_jobs_of_its_collection(worker, workspace, enqueue) -> None:
    other = workspace.catalog.create_collection("vases", ["neck"])
    mine, foreign = enqueue(JobKind.EXPORT), workspace.catalog.enqueue_job(other.id, JobKind.EXPORT)
    worker({JobKind.EXPORT: done}, collection_id=mine.collection_id).run(once=True)
    states = [workspace.catalog.job(job.id).state for job in (mine, foreign)]
    assert states == [JobState.DONE, JobState.PENDING]


def test_two_workers_on_one_table_do_each_job_once(worker, workspace, enqueue) -> None:
    jobs = [enqueue(JobKind.EXPORT) for _ in range(12)]
    begun, both_work = [], threading.Barrier(2, timeout=60)

    def export(work) -> Outcome:
        begun.append((work.job.id, work.owner))
        if len(begun) <= 2:
            both_work.wait()
        return Outcome("")

    threads = [threading.Thread(target=worker({JobKind.EXPORT: export}, owner=name).run, kwargs={"once": True})
               for name in ("w1", "w2")]  # fmt: skip
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert sorted(job_id for job_id, _ in begun) == [job.id for job in jobs]
    assert {owner for _, owner in begun} == {"w1", "w2"}
    assert {workspace.catalog.job(job.id).attempts for job in jobs} == {1}


def test_owners_are_told_apart() -> None:
    assert new_owner() != new_owner()


@pytest.mark.parametrize(
    ("error", "says"),
    [(NotEnoughDataError("training needs labels"), "training needs labels"), (KeyError("x"), "fault")],
)
def test_a_job_that_cannot_be_done_fails_with_the_reason_and_the_next_is_done(
    worker, workspace, enqueue, error, says
) -> None:
    failing, good = enqueue(JobKind.INGEST), enqueue(JobKind.EXPORT)
    worker({JobKind.INGEST: raising(error), JobKind.EXPORT: done}).run(once=True)
    ended = workspace.catalog.job(failing.id)
    assert ended.state is JobState.FAILED
    assert says in ended.full_message
    assert workspace.catalog.job(good.id).state is JobState.DONE


@pytest.mark.parametrize("error", [WorkerError("Ray died"), StoreError("the disk is full")])
def test_what_may_pass_is_tried_three_times(worker, workspace, enqueue, error) -> None:
    job = enqueue(JobKind.EXPORT)
    worker({JobKind.EXPORT: raising(error)}).run(once=True)
    ended = workspace.catalog.job(job.id)
    assert (ended.state, ended.attempts, ended.full_message) == (JobState.FAILED, 3, str(error))


@pytest.mark.parametrize(
    "error",
    [
        StoreError("s3://bucket cannot be reached"),
        WorkerError("Ray of s3://bucket died"),
        ConfigError("s3://bucket is no folder"),
        OSError(28, "No space left", "s3://bucket"),
        KeyError("s3://bucket"),
    ],
)
def test_what_names_places_on_machines_is_for_operators(worker, workspace, enqueue, error) -> None:
    job = enqueue(JobKind.TRAIN)
    worker({JobKind.TRAIN: raising(error)}).run(once=True)
    ended = workspace.catalog.job(job.id)
    assert "s3://bucket" in ended.full_message
    assert ended.progress.message == "train could not be done; an operator can see why"
    assert "bucket" not in str(workspace.catalog.events(after=0))


@pytest.mark.parametrize(("kind", "is_told"), [(JobKind.TRAIN, True), (JobKind.INGEST, False), (JobKind.EXPORT, False)])
def test_what_is_wrong_with_what_was_asked_for_is_told_unless_it_names_files(
    worker, workspace, enqueue, kind, is_told
) -> None:
    job = enqueue(kind)
    worker({kind: raising(ParameterError("a.zip is empty"))}).run(once=True)
    ended = workspace.catalog.job(job.id)
    assert ended.full_message == "a.zip is empty"
    assert (ended.progress.message == "a.zip is empty") == is_told


def test_a_cancelled_job_stops_and_is_over(worker, workspace, enqueue) -> None:
    job = enqueue(JobKind.EXPORT)

    def cancelled_meanwhile(work):
        workspace.catalog.cancel_job(work.job.id)
        until_stopped(work)

    worker({JobKind.EXPORT: cancelled_meanwhile}).run(once=True)
    assert workspace.catalog.job(job.id).state is JobState.CANCELLED


def test_an_interrupted_worker_puts_its_job_back_uncounted(worker, workspace, enqueue) -> None:
    job = enqueue(JobKind.EXPORT)
    with pytest.raises(KeyboardInterrupt):
        worker({JobKind.EXPORT: raising(KeyboardInterrupt())}).run()
    put_back = workspace.catalog.job(job.id)
    assert (put_back.state, put_back.attempts) == (JobState.PENDING, 0)


def test_a_job_that_gives_way_goes_on_after_the_other(worker, workspace, enqueue) -> None:
    begun = []

    def evaluate(work) -> Outcome:
        begun.append(work.job.kind)
        if len(begun) == 1:
            enqueue(JobKind.TRAIN)
            raise JobStoppedError(StopReason.GIVES_WAY, "gives way")
        return Outcome("evaluated")

    def train(work) -> Outcome:
        begun.append(work.job.kind)
        return Outcome("trained")

    job = enqueue(JobKind.EVALUATE)
    worker({JobKind.TRAIN: train, JobKind.EVALUATE: evaluate}).run(once=True)
    assert begun == [JobKind.EVALUATE, JobKind.TRAIN, JobKind.EVALUATE]
    assert (workspace.catalog.job(job.id).state, workspace.catalog.job(job.id).attempts) == (JobState.DONE, 1)


def test_jobs_of_silent_owners_are_begun_again(worker, workspace, enqueue) -> None:
    job = enqueue(JobKind.EXPORT)
    workspace.catalog.claim_job("gone")
    make_silent(workspace, job)
    worker({JobKind.EXPORT: done}).run(once=True)
    assert (workspace.catalog.job(job.id).state, workspace.catalog.job(job.id).attempts) == (JobState.DONE, 2)


def test_jobs_of_owners_that_fall_silent_are_begun_again_while_all_work(
    worker, workspace, enqueue, monkeypatch
) -> None:
    monkeypatch.setattr(presence, "EVERY_S", 0.01)
    train, gave_way = enqueue(JobKind.TRAIN), []
    workspace.catalog.claim_job("gone")

    def evaluate(work) -> Outcome:
        """Goes on until something of more weight waits, as evaluations do."""
        make_silent(workspace, train)
        while work.waiting_job(also_background=False) is None:
            threading.Event().wait(0.005)
        gave_way.append(work.job.id)
        return Outcome("")

    job = enqueue(JobKind.EVALUATE)
    worker({JobKind.TRAIN: done, JobKind.EVALUATE: evaluate}).run(once=True)
    assert gave_way == [job.id]
    assert workspace.catalog.job(train.id).state is JobState.DONE


def test_jobs_of_owners_that_live_are_left_to_them(worker, workspace, enqueue) -> None:
    job = enqueue(JobKind.EXPORT)
    workspace.catalog.claim_job("alive")
    worker({JobKind.EXPORT: done}).run(once=True)
    assert (workspace.catalog.job(job.id).state, workspace.catalog.job(job.id).owner) == (JobState.RUNNING, "alive")


def test_a_job_that_another_owner_has_by_now_is_left_alone(worker, workspace, enqueue) -> None:
    job = enqueue(JobKind.EXPORT)

    def lost_meanwhile(work):
        workspace.catalog.requeue_lost_jobs(AT_ONCE)
        workspace.catalog.claim_job("another")
        until_stopped(work)

    worker({JobKind.EXPORT: lost_meanwhile}).run(once=True)
    left = workspace.catalog.job(job.id)
    assert (left.state, left.owner) == (JobState.RUNNING, "another")


def test_an_end_that_comes_too_late_changes_nothing(worker, workspace, enqueue) -> None:
    job = enqueue(JobKind.EXPORT)

    def finishes_late(work) -> Outcome:
        workspace.catalog.requeue_lost_jobs(AT_ONCE)
        workspace.catalog.claim_job("another")
        return Outcome("mine")

    worker({JobKind.EXPORT: finishes_late}).run(once=True)
    assert (workspace.catalog.job(job.id).owner, workspace.catalog.job(job.id).progress.message) == ("another", "")


def test_a_worker_says_what_it_begins_and_how_it_ends(worker, enqueue) -> None:
    told = []
    enqueue(JobKind.EXPORT)
    worker({JobKind.EXPORT: done}, on_job=lambda job: told.append(job.state)).run(once=True)
    assert told == [JobState.RUNNING, JobState.DONE]
