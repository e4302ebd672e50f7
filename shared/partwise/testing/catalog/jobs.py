"""Conformance: jobs and events."""
# ruff: noqa: S101 # a test suite asserts

from collections.abc import Callable
from datetime import UTC, datetime, timedelta

import pytest

from partwise.errors import ConflictError, NotFoundError, ParameterError
from partwise.store.catalog import Catalog
from partwise.store.records import (
    BACKGROUND_KINDS,
    COALESCED_KINDS,
    EventKind,
    Job,
    JobKind,
    JobState,
    NewEvent,
    NewModel,
    Progress,
    WorkerUsage,
)
from partwise.testing.catalog.samples import add_collection
from partwise.testing.expect import raises

AT_ONCE = timedelta(hours=-1)
"""No silence is so short that its owner does not count as lost."""


def _running(catalog: Catalog, kind: JobKind = JobKind.TRAIN, owner: str = "w1") -> Job:
    """A job of a new collection that its owner has begun."""
    collection, _ = add_collection(catalog, 0)
    catalog.enqueue_job(collection.id, kind)
    job = catalog.claim_job(owner)
    assert job is not None
    return job


def _later() -> datetime:
    return datetime.now(UTC) + timedelta(hours=1)


class JobConformance:
    def test_a_job_comes_back_as_enqueued(self, catalog: Catalog) -> None:
        collection, _ = add_collection(catalog, 0)
        job = catalog.enqueue_job(collection.id, JobKind.EXPORT, {"format": "seg"})
        assert (job.kind, job.parameters, job.state) == (JobKind.EXPORT, {"format": "seg"}, JobState.PENDING)
        assert (job.progress, job.result, job.is_over) == (Progress(), None, False)
        assert catalog.job(job.id) == job
        assert catalog.jobs(collection.id) == [job]

    @pytest.mark.parametrize("kind", JobKind)
    def test_one_waiting_job_is_enough_where_it_covers_all(self, catalog: Catalog, kind: JobKind) -> None:
        collection, _ = add_collection(catalog, 0)
        first = catalog.enqueue_job(collection.id, kind, {"a": 1})
        second = catalog.enqueue_job(collection.id, kind, {"a": 2})
        assert (second.id == first.id) == (kind in COALESCED_KINDS)
        assert second.parameters == {"a": 2}
        assert catalog.enqueue_job(collection.id, kind).parameters == ({"a": 2} if kind in COALESCED_KINDS else {})

    def test_the_oldest_is_begun_first_by_one_owner(self, catalog: Catalog) -> None:
        collection, _ = add_collection(catalog, 0)
        jobs = [catalog.enqueue_job(collection.id, JobKind.EXPORT) for _ in range(2)]
        claimed = [catalog.claim_job("w1"), catalog.claim_job("w2"), catalog.claim_job("w3")]
        assert [job and job.id for job in claimed] == [jobs[0].id, jobs[1].id, None]
        assert [job and (job.owner, job.attempts) for job in claimed] == [("w1", 1), ("w2", 1), None]

    def test_an_owner_takes_the_kinds_it_can_do(self, catalog: Catalog) -> None:
        collection, _ = add_collection(catalog, 0)
        catalog.enqueue_job(collection.id, JobKind.TRAIN)
        assert catalog.claim_job("w1", [JobKind.EXPORT, JobKind.INGEST]) is None
        assert catalog.claim_job("w1", [JobKind.TRAIN]) is not None

    def test_background_work_comes_after_all_others(self, catalog: Catalog) -> None:
        collection, _ = add_collection(catalog, 0)
        for kind in (*BACKGROUND_KINDS, JobKind.TRAIN, JobKind.EXPORT):
            catalog.enqueue_job(collection.id, kind)
        claimed = [catalog.claim_job("w1") for _ in range(5)]
        assert [job and job.kind for job in claimed] == [JobKind.TRAIN, JobKind.EXPORT, *BACKGROUND_KINDS]

    def test_background_work_of_collections_takes_turns(self, catalog: Catalog) -> None:
        collections = [add_collection(catalog, 0, name)[0] for name in ("mugs", "vases")]
        first, second = (catalog.enqueue_job(each.id, JobKind.EVALUATE) for each in collections)
        begun = []
        for _ in range(3):
            job = catalog.claim_job("w1")
            assert job is not None
            begun.append(job.id)
            catalog.release_jobs("w1", "gives way")
        assert begun == [first.id, second.id, first.id]

    def test_an_owner_takes_jobs_of_one_collection(self, catalog: Catalog) -> None:
        (mugs, _), (vases, _) = add_collection(catalog, 0, "mugs"), add_collection(catalog, 0, "vases")
        job = catalog.enqueue_job(vases.id, JobKind.TRAIN)
        assert catalog.claim_job("w1", collection_id=mugs.id) is None
        assert catalog.claim_job("w1", collection_id=vases.id) == catalog.job(job.id)

    def test_one_looks_at_the_next_job_without_taking_it(self, catalog: Catalog) -> None:
        collection, _ = add_collection(catalog, 0)
        assert catalog.next_job() is None
        job = catalog.enqueue_job(collection.id, JobKind.TRAIN)
        assert catalog.next_job() == catalog.next_job(collection_id=collection.id) == job
        assert catalog.next_job([JobKind.EXPORT]) is None
        catalog.claim_job("w1")
        catalog.enqueue_job(collection.id, JobKind.TRAIN)
        assert catalog.next_job() is None

    def test_one_training_runs_at_a_time_and_one_waits(self, catalog: Catalog) -> None:
        job = _running(catalog)
        waiting = catalog.enqueue_job(job.collection_id, JobKind.TRAIN)
        assert waiting.id != job.id
        assert catalog.claim_job("w2") is None
        catalog.finish_job(job.id, "w1", JobState.DONE)
        claimed = catalog.claim_job("w2")
        assert claimed is not None
        assert claimed.id == waiting.id

    def test_collections_train_beside_each_other(self, catalog: Catalog) -> None:
        _running(catalog)
        other, _ = add_collection(catalog, 0, "mugs")
        catalog.enqueue_job(other.id, JobKind.TRAIN)
        assert catalog.claim_job("w2") is not None

    def test_heartbeats_tell_how_far_it_is(self, catalog: Catalog) -> None:
        job = _running(catalog)
        progress = Progress(3, 1, 10, "epoch 3")
        assert catalog.heartbeat_job(job.id, "w1", progress).progress == progress
        assert catalog.heartbeat_job(job.id, "w1").progress == progress
        assert catalog.events(after=0)[-1].payload["message"] == "epoch 3"

    def test_only_its_owner_works_on_it(self, catalog: Catalog) -> None:
        job = _running(catalog)
        with raises(ConflictError, "its owner"):
            catalog.heartbeat_job(job.id, "w2")
        with raises(ConflictError, "its owner"):
            catalog.finish_job(job.id, "w2", JobState.DONE)
        catalog.finish_job(job.id, "w1", JobState.DONE)
        with raises(ConflictError, "done"):
            catalog.heartbeat_job(job.id, "w1")

    def test_a_finished_job_has_a_result(self, catalog: Catalog) -> None:
        job = _running(catalog)
        done = catalog.finish_job(job.id, "w1", JobState.DONE, message="trained", result={"version": 3})
        assert (done.state, done.result, done.progress.message) == (JobState.DONE, {"version": 3}, "trained")
        assert done.finished_at is not None
        assert done.is_over
        with raises(ParameterError, "running"):
            catalog.finish_job(job.id, "w1", JobState.RUNNING)

    def test_a_training_ends_with_its_model_and_asks_for_an_evaluation(self, catalog: Catalog) -> None:
        job = _running(catalog)
        new = NewModel(job.collection_id, {}, "models/a.safetensors", ())
        model = catalog.finish_training(job.id, "w1", new)
        assert catalog.latest_model(job.collection_id) == model
        assert (catalog.job(job.id).state, catalog.job(job.id).result) == (
            JobState.DONE,
            {"model_version": 1, "n_shapes": 0},
        )
        assert [each.kind for each in catalog.jobs(job.collection_id, state=JobState.PENDING)] == [JobKind.EVALUATE]
        told = [event for event in catalog.events(after=0) if event.kind is EventKind.TRAINING]
        assert [event.payload["model_version"] for event in told] == [1]

    def test_a_training_that_was_lost_publishes_nothing(self, catalog: Catalog) -> None:
        job = _running(catalog)
        catalog.requeue_lost_jobs(AT_ONCE)
        with raises(ConflictError, "its owner"):
            catalog.finish_training(job.id, "w1", NewModel(job.collection_id, {}, "models/a.safetensors", ()))
        assert catalog.latest_model(job.collection_id) is None

    def test_released_jobs_are_begun_again_as_if_they_had_not_been(self, catalog: Catalog) -> None:
        job = _running(catalog)
        assert catalog.release_jobs("w2", "stops") == []
        (released,) = catalog.release_jobs("w1", "stops")
        assert (released.id, released.state, released.attempts) == (job.id, JobState.PENDING, 0)
        assert released.progress.message == "stops"
        with raises(ConflictError, "its owner"):
            catalog.heartbeat_job(job.id, "w1")

    def test_a_released_job_gives_way_to_the_one_that_waits(self, catalog: Catalog) -> None:
        job = _running(catalog)
        waiting = catalog.enqueue_job(job.collection_id, JobKind.TRAIN)
        (released,) = catalog.release_jobs("w1", "stops")
        assert (released.state, released.progress.message) == (
            JobState.CANCELLED,
            f"stops; job {waiting.id} does its work",
        )

    def test_a_released_job_that_was_to_stop_has_stopped(self, catalog: Catalog) -> None:
        job = _running(catalog)
        catalog.cancel_job(job.id)
        assert [each.state for each in catalog.release_jobs("w1", "stops")] == [JobState.CANCELLED]

    def test_a_job_that_cannot_be_done_now_fails_in_the_end(self, catalog: Catalog) -> None:
        job = _running(catalog)
        for attempt in (1, 2):
            returned = catalog.return_job(job.id, "w1", "no room", result={"why": "/data is full"})
            assert (returned.state, returned.attempts) == (JobState.PENDING, attempt)
            assert (returned.progress.message, returned.full_message) == ("no room", "/data is full")
            again = catalog.claim_job("w1")
            assert again is not None
            assert again.result is None
        failed = catalog.return_job(job.id, "w1", "no room")
        assert (failed.state, failed.progress.message, failed.is_over) == (JobState.FAILED, "no room", True)
        with raises(ConflictError, "its owner"):
            catalog.return_job(job.id, "w1", "no room")

    def test_a_pending_job_is_cancelled_at_once_and_a_running_one_is_asked_to_stop(self, catalog: Catalog) -> None:
        running = _running(catalog)
        waiting = catalog.enqueue_job(running.collection_id, JobKind.TRAIN)
        assert catalog.cancel_job(waiting.id).state is JobState.CANCELLED
        assert catalog.cancel_job(running.id).state is JobState.RUNNING
        assert catalog.heartbeat_job(running.id, "w1").cancel_requested
        catalog.finish_job(running.id, "w1", JobState.CANCELLED)
        with raises(ConflictError, "cancelled"):
            catalog.cancel_job(running.id)

    def test_failed_work_is_tried_again_as_a_new_job(self, catalog: Catalog) -> None:
        job = _running(catalog)
        with raises(ConflictError, "running"):
            catalog.retry_job(job.id)
        catalog.finish_job(job.id, "w1", JobState.FAILED, message="no disk")
        again = catalog.retry_job(job.id)
        assert (again.kind, again.state, again.attempts) == (job.kind, JobState.PENDING, 0)
        assert again.id != job.id

    def test_lost_jobs_are_begun_again_and_fail_in_the_end(self, catalog: Catalog) -> None:
        job = _running(catalog)
        assert catalog.requeue_lost_jobs(timedelta(hours=1)) == []
        for attempt in (1, 2):
            (lost,) = catalog.requeue_lost_jobs(AT_ONCE)
            assert (lost.id, lost.state, lost.attempts) == (job.id, JobState.PENDING, attempt)
            assert catalog.claim_job("w2") is not None
        (failed,) = catalog.requeue_lost_jobs(AT_ONCE)
        assert (failed.state, failed.is_over) == (JobState.FAILED, True)
        assert "lost 3 times" in failed.progress.message

    def test_a_lost_job_gives_way_to_the_one_that_waits(self, catalog: Catalog) -> None:
        job = _running(catalog)
        waiting = catalog.enqueue_job(job.collection_id, JobKind.TRAIN)
        (lost,) = catalog.requeue_lost_jobs(AT_ONCE)
        assert (lost.id, lost.state) == (job.id, JobState.CANCELLED)
        claimed = catalog.claim_job("w2")
        assert claimed is not None
        assert claimed.id == waiting.id

    def test_a_lost_job_that_was_to_stop_has_stopped(self, catalog: Catalog) -> None:
        job = _running(catalog, JobKind.EXPORT)
        catalog.cancel_job(job.id)
        assert [lost.state for lost in catalog.requeue_lost_jobs(AT_ONCE)] == [JobState.CANCELLED]

    def test_pages_of_jobs_are_newest_first(self, catalog: Catalog) -> None:
        collection, _ = add_collection(catalog, 0)
        jobs = [catalog.enqueue_job(collection.id, JobKind.EXPORT) for _ in range(3)]
        assert catalog.jobs(collection.id, limit=2) == [jobs[2], jobs[1]]
        assert catalog.jobs(collection.id, before=jobs[1].id) == [jobs[0]]
        assert catalog.jobs(collection.id, state=JobState.DONE) == []

    def test_unknown_jobs_and_collections_are_refused(self, catalog: Catalog) -> None:
        uses: list[Callable[[], object]] = [
            lambda: catalog.job(99),
            lambda: catalog.cancel_job(99),
            lambda: catalog.retry_job(99),
            lambda: catalog.heartbeat_job(99, "w1"),
            lambda: catalog.enqueue_job(99, JobKind.TRAIN),
        ]
        for use in uses:
            with raises(NotFoundError, "99"):
                use()

    def test_workers_are_there_until_they_say_otherwise(self, catalog: Catalog) -> None:
        usage = WorkerUsage(10**10, 2, 3 * 10**10, None)
        for owner, taken in (("w1", WorkerUsage(1)), ("w1", usage), ("w2", WorkerUsage(5, free_bytes=7))):
            catalog.note_worker(owner, taken)
        long_ago = datetime.now(UTC) - timedelta(hours=1)
        assert {each.owner: each.usage for each in catalog.workers(long_ago)} == {
            "w1": usage,
            "w2": WorkerUsage(5, 0, 0, 7),
        }
        assert catalog.workers(_later()) == []
        catalog.forget_worker("w1")
        assert [each.owner for each in catalog.workers(long_ago)] == ["w2"]

    def test_a_worker_is_busy_while_a_job_is_its_own(self, catalog: Catalog) -> None:
        job = _running(catalog)
        for owner in ("w1", "w2"):
            catalog.note_worker(owner, WorkerUsage(1))
        long_ago = datetime.now(UTC) - timedelta(hours=1)
        assert {each.owner: each.is_busy for each in catalog.workers(long_ago)} == {"w1": True, "w2": False}
        catalog.finish_job(job.id, "w1", JobState.DONE)
        assert not any(each.is_busy for each in catalog.workers(long_ago))


class EventConformance:
    def test_events_are_read_on_from_the_last(self, catalog: Catalog) -> None:
        collection, _ = add_collection(catalog, 0)
        new = NewEvent(EventKind.STAGE, collection.id, {"stage": "describe", "n_done": 3})
        first, second = catalog.add_event(new), catalog.add_event(new)
        assert (first.kind, first.payload, first.collection_id) == (new.kind, new.payload, new.collection_id)
        assert catalog.events(after=0) == [first, second]
        assert catalog.events(after=first.id) == [second]
        assert catalog.events(after=0, limit=1) == [first]
        assert catalog.events(after=second.id) == []

    def test_events_of_other_collections_are_left_out(self, catalog: Catalog) -> None:
        (mine, _), (other, _) = add_collection(catalog, 0), add_collection(catalog, 0, "mugs")
        kept = [catalog.add_event(NewEvent(EventKind.JOB, each)) for each in (mine.id, None)]
        catalog.add_event(NewEvent(EventKind.JOB, other.id))
        assert catalog.events(after=0, collection_ids=[mine.id]) == kept

    def test_pruned_events_are_noticed_by_their_bounds(self, catalog: Catalog) -> None:
        bounds = catalog.event_bounds()
        assert (bounds.oldest, bounds.newest) == (0, 0)
        events = [catalog.add_event(NewEvent(EventKind.PEOPLE, None)) for _ in range(3)]
        assert catalog.prune_events(datetime(2020, 1, 1, tzinfo=UTC)) == 0
        assert catalog.prune_events(_later(), limit=2) == 2
        assert (catalog.event_bounds().oldest, catalog.event_bounds().newest) == (events[2].id, events[2].id)
        assert catalog.prune_events(_later()) == 1
        assert catalog.add_event(NewEvent(EventKind.PEOPLE, None)).id > events[2].id
