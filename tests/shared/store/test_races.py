"""Many at once: nobody gets what another has, nothing is written twice, on both databases."""

from collections import Counter
from collections.abc import Callable, Sequence
from concurrent.futures import ThreadPoolExecutor
from contextlib import suppress
from datetime import UTC, datetime, timedelta
from functools import partial
from threading import Barrier
from typing import Any, TypeVar

import numpy as np
import pytest
from sqlalchemy import text
from sqlalchemy.event import listens_for

from partwise.errors import ConflictError, StaleDraftError
from partwise.store.engine import reading, writing
from partwise.store.open import open_catalog
from partwise.store.records import (
    JobKind,
    JobState,
    LeaseOutcome,
    NewClaim,
    NewConfirmation,
    NewConsensus,
    RevisionKind,
    ShapeState,
)
from partwise.store.reviews import ReviewReason
from partwise.store.sql import returns
from partwise.store.sql.collections import schema_version
from partwise.store.sql.returns import _instead
from partwise.store.sql_catalog import SqlCatalog
from partwise.testing.catalog.confirmations import CLOSE
from partwise.testing.catalog.samples import blank_draft, claim, confirm, label, ready_shapes, strokes
from partwise.testing.postgres import ReusedDatabase

T = TypeVar("T")
N_THREADS = 8


@pytest.fixture(params=["sqlite", "postgresql"])
def shared(request: pytest.FixtureRequest) -> SqlCatalog:
    """A catalog that threads share."""
    return request.getfixturevalue("catalog" if request.param == "sqlite" else "postgres_catalog")


def _at_once(work: Sequence[Callable[[], T]]) -> list[T | Exception]:
    """What each returns or raises when all begin together."""
    barrier = Barrier(len(work))

    def begin(each: Callable[[], T]) -> T | Exception:
        barrier.wait()
        try:
            return each()
        except ConflictError as error:
            return error

    with ThreadPoolExecutor(len(work)) as threads:
        return list(threads.map(begin, work))


def test_no_label_is_leased_twice_at_once(shared: SqlCatalog) -> None:
    collection, _ = ready_shapes(shared, 6)
    shared.update_collection_settings(collection.id, {"labels_per_shape": 2, "honeypot_share": 0.3})
    shared.fill_queue(collection.id)
    label(shared, 6, RevisionKind.REFERENCE)
    people = [shared.add_person(f"p{i}") for i in range(N_THREADS)]
    rng = np.random.default_rng(5)

    def work(person_id: int, draws: Sequence[float]) -> Callable[[], list[str]]:
        def run() -> list[str]:
            errors = []
            for draw in draws:
                lease = shared.claim_next(NewClaim(collection.id, person_id, 60, draw))
                if lease is None:
                    continue
                held = shared.held_shapes([lease.shape_id])[lease.shape_id]
                errors += [f"slot: {held}"] if max(Counter(each.slot for each in held).values()) > 1 else []
                errors += [f"person: {held}"] if max(Counter(each.person_id for each in held).values()) > 1 else []
                shared.release_lease(lease.id, person_id)
            return errors

        return run

    found = _at_once([work(person.id, rng.random(6).tolist()) for person in people])
    assert found == [[]] * N_THREADS
    assert shared.active_leases(collection.id) == []
    assert shared.queue_depth(collection.id).n_held == 0


def test_claims_at_once_get_different_shapes(shared: SqlCatalog) -> None:
    collection, shape_ids = ready_shapes(shared, N_THREADS)
    people = [shared.add_person(f"p{i}") for i in range(N_THREADS)]
    claims = [NewClaim(collection.id, person.id, 60, 0.5) for person in people]
    leases = _at_once([lambda each=each: shared.claim_next(each) for each in claims])  # type: ignore[misc]
    assert sorted(lease.shape_id for lease in leases if lease and not isinstance(lease, Exception)) == shape_ids


def test_one_shape_by_name_goes_to_one(shared: SqlCatalog) -> None:
    collection, (shape_id,) = ready_shapes(shared, 1)
    people = [shared.add_person(f"p{i}") for i in range(N_THREADS)]
    found = _at_once([lambda each=each: shared.claim_shape(shape_id, each.id, 60) for each in people])  # type: ignore[misc]
    assert sum(isinstance(each, ConflictError) for each in found) == N_THREADS - 1
    assert len(shared.active_leases(collection.id)) == 1


def test_a_person_with_many_windows_holds_four(shared: SqlCatalog) -> None:
    collection, _ = ready_shapes(shared, N_THREADS)
    ann = shared.add_person("ann")
    wish = NewClaim(collection.id, ann.id, 60, 0.5)
    found = _at_once([lambda: shared.claim_next(wish)] * N_THREADS)
    assert sum(isinstance(each, ConflictError) for each in found) == N_THREADS - 4
    assert len({lease.shape_id for lease in shared.leases_of(ann.id)}) == 4


def test_strokes_resent_at_once_are_there_once(shared: SqlCatalog) -> None:
    collection, _ = ready_shapes(shared, 1)
    draft = blank_draft(shared, claim(shared, collection, shared.add_person("ann")))
    sent = strokes(draft, 0, 5)
    found = _at_once([lambda: shared.append_strokes(draft.id, draft.person_id, 0, sent)] * N_THREADS)
    assert [not isinstance(each, Exception) and each.n_strokes for each in found] == [5] * N_THREADS
    assert [each.id for each in shared.strokes(draft.id)] == [str(stroke.id) for stroke in sent]


def test_of_two_windows_that_draw_at_once_one_is_told(shared: SqlCatalog) -> None:
    collection, _ = ready_shapes(shared, 1)
    draft = blank_draft(shared, claim(shared, collection, shared.add_person("ann")))
    found = _at_once(
        [lambda: shared.append_strokes(draft.id, draft.person_id, 0, strokes(draft, 0, 2)) for _ in range(N_THREADS)]
    )
    assert sum(isinstance(each, StaleDraftError) for each in found) == N_THREADS - 1
    assert shared.draft(draft.id).n_strokes == 2


def test_a_draft_confirmed_at_once_is_confirmed_once(shared: SqlCatalog) -> None:
    collection, (shape_id,) = ready_shapes(shared, 1)
    draft = blank_draft(shared, claim(shared, collection, shared.add_person("ann")))
    new = NewConfirmation(draft.id, draft.person_id, 0, np.ones(6, int), 1)
    found = _at_once([lambda: shared.confirm_draft(new)] * N_THREADS)
    (revision,) = shared.revisions(shape_id)
    assert [not isinstance(each, Exception) and each.revision_id for each in found] == [revision.id] * N_THREADS


def test_confirms_at_once_ask_for_one_training(shared: SqlCatalog) -> None:
    collection, _ = ready_shapes(shared, N_THREADS)
    shared.update_collection_settings(collection.id, {"train_after": 2})
    leases = [claim(shared, collection, shared.add_person(f"p{i}")) for i in range(N_THREADS)]
    found = _at_once([lambda each=each: confirm(shared, each) for each in leases])  # type: ignore[misc]
    assert not any(isinstance(each, Exception) for each in found)
    assert [(job.kind, job.state) for job in shared.jobs(collection.id)] == [(JobKind.TRAIN, JobState.PENDING)]


def test_the_last_two_answers_at_once_are_compared(shared: SqlCatalog) -> None:
    collection, (shape_id,) = ready_shapes(shared, 1)
    shared.update_collection_settings(collection.id, {"labels_per_shape": 2})
    shared.fill_queue(collection.id)
    leases = [claim(shared, collection, shared.add_person(name)) for name in ("ann", "bob")]
    found = _at_once([lambda each=each: confirm(shared, each) for each in leases])  # type: ignore[misc]
    (refused,) = [i for i, each in enumerate(found) if isinstance(each, StaleDraftError)]
    (answer,) = shared.answers(shape_id)
    confirm(shared, leases[refused], consensus=NewConsensus((answer.id,), CLOSE, None))
    assert len(shared.consensus_of(shape_id)) == 1


def test_a_job_has_one_owner(shared: SqlCatalog) -> None:
    collection, _ = ready_shapes(shared, 0)
    for kind in (JobKind.TRAIN, JobKind.EXPORT, JobKind.EXPORT):
        shared.enqueue_job(collection.id, kind)
    found = _at_once([lambda each=each: shared.claim_job(f"w{each}") for each in range(N_THREADS)])  # type: ignore[misc]
    begun = [job.id for job in found if job and not isinstance(job, Exception)]
    assert len(begun) == len(set(begun)) == 3


def test_ranking_and_claiming_at_once_disturb_nobody(shared: SqlCatalog) -> None:
    collection, shape_ids = ready_shapes(shared, 20)
    people = [shared.add_person(f"p{i}") for i in range(N_THREADS - 1)]

    def rank() -> None:
        for turn in range(5):
            shared.set_ranks(collection.id, {shape_id: (shape_id * 7 + turn) % 20 for shape_id in shape_ids})

    def work(person_id: int) -> Callable[[], None]:
        def run() -> None:
            for _ in range(2):
                shared.claim_next(NewClaim(collection.id, person_id, 60, 0.5))

        return run

    found = _at_once([rank, *(work(person.id) for person in people)])
    assert found == [None] * N_THREADS
    held = [lease.shape_id for lease in shared.active_leases(collection.id)]
    assert len(held) == len(set(held)) == 2 * len(people)


def test_a_lost_job_beside_which_another_is_asked_for_right_now_gives_way_to_it(
    postgres_catalog: SqlCatalog, reused: ReusedDatabase, monkeypatch: pytest.MonkeyPatch
) -> None:
    """In SQLite, whose writers come one after the other, nobody can come between."""
    collection, _ = ready_shapes(postgres_catalog, 1)
    job = postgres_catalog.enqueue_job(collection.id, JobKind.TRAIN)
    postgres_catalog.claim_job("w1")
    asked: list[int] = []

    def looks_too_early(*args: Any) -> dict[str, Any] | None:
        found = _instead(*args)
        if not asked:
            with open_catalog(reused.url) as another:
                asked.append(another.enqueue_job(collection.id, JobKind.TRAIN).id)
        return found

    monkeypatch.setattr(returns, "_instead", looks_too_early)
    (lost,) = postgres_catalog.requeue_lost_jobs(timedelta(hours=-1))
    assert (lost.id, lost.state) == (job.id, JobState.CANCELLED)
    assert f"job {asked[0]} does its work" in lost.progress.message


def test_shapes_are_claimed_while_parts_change(postgres_catalog: SqlCatalog) -> None:
    """In SQLite, whose writers come one after the other, whoever changes parts is short."""
    collection, _ = ready_shapes(postgres_catalog, 1)
    ann = postgres_catalog.add_person("ann")
    with writing(postgres_catalog._engine) as connection:
        schema_version(connection, collection.id, for_update=True)
        with ThreadPoolExecutor(1) as threads:
            claimed = threads.submit(postgres_catalog.claim_next, NewClaim(collection.id, ann.id, 60, 0.5))
            assert claimed.result(30) is not None


def test_who_confirms_and_claims_at_once_is_served_twice(shared: SqlCatalog) -> None:
    """A page that slept claims its shape by name while what was confirmed last is on its way."""
    _, shape_ids = ready_shapes(shared, N_THREADS)
    ann = shared.add_person("ann")
    for shape_id in shape_ids:
        lease = shared.claim_shape(shape_id, ann.id, 60)
        draft = blank_draft(shared, lease)
        shared.append_strokes(draft.id, ann.id, 0, strokes(draft, 0, 1))
        shared.release_lease(lease.id, ann.id)
        new = NewConfirmation(draft.id, ann.id, 1, np.array([1, 1, 1, 2, 2, 2]), 1)
        found = _at_once([partial(shared.confirm_draft, new), partial(shared.claim_shape, shape_id, ann.id, 60)])
        assert not [each for each in found if isinstance(each, Exception)]
        for held in shared.leases_of(ann.id):
            shared.release_lease(held.id, ann.id)


@pytest.mark.parametrize("wrong_by", [timedelta(hours=-1), timedelta(hours=1)])
def test_an_owner_is_not_lost_because_its_hosts_clock_is_wrong(shared: SqlCatalog, wrong_by: timedelta) -> None:
    collection, _ = ready_shapes(shared, 1)
    shared.enqueue_job(collection.id, JobKind.TRAIN)
    elsewhere = SqlCatalog(shared._engine, lambda: datetime.now(UTC) + wrong_by)
    job = elsewhere.claim_job("w1")
    assert job is not None
    assert elsewhere.requeue_lost_jobs(timedelta(minutes=1)) == []
    elsewhere.heartbeat_job(job.id, "w1")
    assert shared.requeue_lost_jobs(timedelta(minutes=1)) == []
    assert [each.id for each in shared.requeue_lost_jobs(timedelta(hours=-0.5))] == [job.id]


def test_events_are_missed_by_nobody_who_reads_on(shared: SqlCatalog) -> None:
    collection, _ = ready_shapes(shared, N_THREADS)
    people = [shared.add_person(f"p{i}") for i in range(N_THREADS - 1)]
    seen: list[int] = []

    def read() -> None:
        last = 0
        while len(seen) < 6 * len(people):
            for event in shared.events(after=last):
                seen.append(event.id)
                last = event.id

    def work(person_id: int) -> Callable[[], None]:
        def run() -> None:
            for _ in range(3):
                lease = shared.claim_next(NewClaim(collection.id, person_id, 60, 0.5))
                assert lease is not None
                assert shared.release_lease(lease.id, person_id).outcome is LeaseOutcome.RELEASED

        return run

    assert _at_once([read, *(work(person.id) for person in people)]) == [None] * N_THREADS
    assert seen == [event.id for event in shared.events(after=0)]


def test_a_shape_is_reopened_or_claimed_and_no_place_of_a_holder_is_free(shared: SqlCatalog) -> None:
    collection, (shape_id, other) = ready_shapes(shared, 2)
    operator = shared.add_person("oscar")
    shared.claim_shape(other, operator.id, 60)
    people = [shared.add_person(f"p{i}") for i in range(N_THREADS - 2)]

    def reopen() -> None:
        for _ in range(20):
            with suppress(ConflictError):
                shared.reopen_shape(shape_id, operator.id)

    def work(person_id: int, turn: int) -> Callable[[], None]:
        def run() -> None:
            for _ in range(10):
                with suppress(ConflictError):
                    by_name = shared.claim_shape(shape_id, person_id, 60) if turn % 2 else None
                    lease = by_name or shared.claim_next(NewClaim(collection.id, person_id, 60, 0.5))
                    if lease is not None:
                        assert _free_places_of_holders(shared) == 0
                        shared.release_lease(lease.id, person_id)

        return run

    found = _at_once([reopen, reopen, *(work(person.id, turn) for turn, person in enumerate(people))])
    assert found == [None] * N_THREADS


def _free_places_of_holders(catalog: SqlCatalog) -> int:
    held = "lease.shape_id = queue_rank.shape_id AND lease.slot = queue_rank.slot AND lease.released_at IS NULL"
    query = f"SELECT count(*) FROM queue_rank JOIN lease ON {held} WHERE queue_rank.lease_id IS NULL"  # noqa: S608 # no input
    with reading(catalog._engine) as connection:
        return connection.execute(text(query)).scalar_one()


def test_labels_of_many_are_accepted_while_parts_change(shared: SqlCatalog) -> None:
    collection, shape_ids = ready_shapes(shared, 20)
    heads = [label(shared, shape_id) for shape_id in shape_ids]
    rita = shared.add_person("rita")
    shared.add_part(collection.id, "lid")
    reviews = [each.id for each in shared.open_reviews(collection.id)]

    def accept_each() -> None:
        for review_id in reviews:
            with suppress(ConflictError):
                shared.accept_review(review_id, rita.id)

    def accept_all() -> None:
        for _ in range(4):
            shared.accept_reviews(collection.id, ReviewReason.SCHEMA, rita.id, limit=7)

    def add_parts() -> None:
        for number in range(3):
            shared.add_part(collection.id, f"part {number}")

    def relabel() -> None:
        for shape_id in shape_ids[::-1]:
            label(shared, shape_id)

    found = _at_once([add_parts, accept_each, accept_all, relabel])
    assert found == [None] * 4
    states = {row.shape.id: row.state for row in shared.list_shapes(collection.id)}
    assert states == shared.shape_states(shape_ids)
    shared.add_part(collection.id, "last")
    assert {review.shape_id for review in shared.open_reviews(collection.id)} == {head.shape_id for head in heads}
    assert {row.state for row in shared.list_shapes(collection.id)} == {ShapeState.REVIEW}


def test_who_claims_while_a_shape_is_reopened_gets_another(postgres_catalog: SqlCatalog) -> None:
    collection, (reopened, other) = ready_shapes(postgres_catalog, 2)
    ann = postgres_catalog.add_person("ann")
    claimed: list[int] = []

    @listens_for(postgres_catalog._engine, "before_cursor_execute")
    def claim_meanwhile(_connection: object, _cursor: object, statement: str, *_: object) -> None:
        if statement.startswith("DELETE FROM queue_rank"):
            claimed.append(claim(postgres_catalog, collection, ann).shape_id)

    postgres_catalog.reopen_shape(reopened, ann.id)
    assert claimed == [other]
    assert _free_places_of_holders(postgres_catalog) == 0
