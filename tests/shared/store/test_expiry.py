"""What ends with time: leases that nobody renews, tokens, sessions, login codes."""

from datetime import UTC, datetime, timedelta

import numpy as np
import pytest

from partwise.errors import ConflictError
from partwise.store.records import LeaseCounts, LeaseOutcome, NewClaim, NewConfirmation, NewToken, Role
from partwise.store.sql_catalog import SqlCatalog
from partwise.testing.catalog.samples import blank_draft, claim, label, ready_shapes, strokes
from partwise.testing.expect import raises


class Clock:
    """A time that is set."""

    def __init__(self) -> None:
        self.now = datetime(2026, 1, 31, 12, tzinfo=UTC)

    def __call__(self) -> datetime:
        return self.now

    def move(self, seconds: float) -> None:
        self.now += timedelta(seconds=seconds)


@pytest.fixture
def clock() -> Clock:
    return Clock()


@pytest.fixture(params=["sqlite", "postgresql"])
def timed(request: pytest.FixtureRequest, clock: Clock) -> SqlCatalog:
    """A catalog by the clock that is set."""
    catalog = request.getfixturevalue("catalog" if request.param == "sqlite" else "postgres_catalog")
    return SqlCatalog(catalog._engine, clock)


def test_an_expired_lease_frees_the_shape_and_keeps_the_draft(timed: SqlCatalog, clock: Clock) -> None:
    collection, _ = ready_shapes(timed, 1)
    ann, bob = timed.add_person("ann"), timed.add_person("bob")
    lease = claim(timed, collection, ann)
    draft = blank_draft(timed, lease)
    timed.append_strokes(draft.id, ann.id, 0, strokes(draft, 0, 2))
    assert timed.claim_next(NewClaim(collection.id, bob.id, 60, 0.5)) is None
    clock.move(61)
    assert claim(timed, collection, bob).shape_id == lease.shape_id
    assert timed.lease(lease.id).outcome is LeaseOutcome.EXPIRED
    assert [each.n_strokes for each in timed.open_drafts(ann.id)] == [2]
    with raises(ConflictError, "expired"):
        timed.renew_lease(lease.id, ann.id, 60)


def test_an_expired_lease_that_nobody_took_is_its_holders_still(timed: SqlCatalog, clock: Clock) -> None:
    collection, _ = ready_shapes(timed, 2)
    ann = timed.add_person("ann")
    lease = claim(timed, collection, ann)
    clock.move(61)
    assert claim(timed, collection, ann).shape_id != lease.shape_id
    assert timed.renew_lease(lease.id, ann.id, 60).expires_at == clock.now + timedelta(seconds=60)


def test_a_renewed_lease_lasts(timed: SqlCatalog, clock: Clock) -> None:
    collection, _ = ready_shapes(timed, 1)
    ann, bob = timed.add_person("ann"), timed.add_person("bob")
    lease = claim(timed, collection, ann)
    clock.move(50)
    timed.renew_lease(lease.id, ann.id, 60)
    clock.move(50)
    assert timed.claim_next(NewClaim(collection.id, bob.id, 60, 0.5)) is None


def test_an_expired_shape_is_claimed_by_name(timed: SqlCatalog, clock: Clock) -> None:
    collection, (shape_id,) = ready_shapes(timed, 1)
    claim(timed, collection, timed.add_person("ann"))
    bob = timed.add_person("bob")
    clock.move(61)
    assert timed.claim_shape(shape_id, bob.id, 60).person_id == bob.id


def test_who_comes_with_labels_goes_before_whose_lease_expired(timed: SqlCatalog, clock: Clock) -> None:
    collection, (shape_id,) = ready_shapes(timed, 1)
    ann, bob = timed.add_person("ann"), timed.add_person("bob")
    draft = blank_draft(timed, claim(timed, collection, ann))
    clock.move(61)
    theirs = claim(timed, collection, bob)
    clock.move(61)
    assert timed.confirm_draft(NewConfirmation(draft.id, ann.id, 0, np.ones(6, int), 1)).revision_id is not None
    assert timed.lease(theirs.id).outcome is LeaseOutcome.EXPIRED
    assert [revision.author_id for revision in timed.revisions(shape_id)] == [ann.id]
    assert _told(timed, "expired") == [shape_id, shape_id]  # of each of the two


@pytest.mark.parametrize("is_rejection", [True, False])
def test_an_expired_lease_keeps_no_shape_from_being_done_again(
    timed: SqlCatalog, clock: Clock, is_rejection: bool
) -> None:
    collection, (shape_id,) = ready_shapes(timed, 1)
    head = label(timed, shape_id)
    bob = timed.add_person("bob")
    lease = timed.claim_shape(shape_id, bob.id, 60)
    clock.move(61)
    if is_rejection:
        timed.reject_labels(shape_id, head.author_id, "no")
    else:
        timed.reopen_shape(shape_id, head.author_id)
    assert timed.lease(lease.id).outcome is LeaseOutcome.EXPIRED
    assert _told(timed, "expired") == [shape_id]
    assert claim(timed, collection, bob).round == lease.round + 1


def test_what_expired_is_counted_as_free(timed: SqlCatalog, clock: Clock) -> None:
    collection, (first, _) = ready_shapes(timed, 2)
    ann = timed.add_person("ann")
    timed.assign_shapes([first], ann.id, ann.id)
    claim(timed, collection, ann)
    clock.move(61)
    claim(timed, collection, ann)
    depth = timed.queue_depth(collection.id)
    assert (depth.n_free, depth.n_held, depth.n_assigned) == (1, 1, 1)
    assert timed.lease_counts(collection.id) == LeaseCounts(1, 0, 1, 1)


def _told(catalog: SqlCatalog, what: str) -> list[int]:
    """Shapes of which events say so."""
    return [event.payload["shape_id"] for event in catalog.events(after=0) if event.payload.get("what") == what]


def test_tokens_sessions_and_codes_end(timed: SqlCatalog, clock: Clock) -> None:
    ann = timed.add_person("ann")
    issued = timed.issue_token(NewToken(ann.id, Role.ANNOTATOR, clock.now + timedelta(hours=2)), "operator")
    code, late = (timed.issue_login_code(issued.token.id, 300) for _ in range(2))
    session = timed.exchange_login_code(code.code, 3600)
    assert session is not None
    clock.move(301)
    assert timed.exchange_login_code(late.code, 3600) is None
    clock.move(3600)
    assert timed.authenticate(session.secret) is None
    assert timed.authenticate(issued.secret) is not None
    clock.move(3600)
    assert timed.authenticate(issued.secret) is None


def test_use_is_noted_once_a_minute(timed: SqlCatalog, clock: Clock) -> None:
    ann = timed.add_person("ann")
    issued = timed.issue_token(NewToken(ann.id, Role.ANNOTATOR, clock.now + timedelta(hours=2)), "operator")
    begun = clock.now
    timed.note_token_use(issued.token.id)
    clock.move(59)
    timed.note_token_use(issued.token.id)
    assert timed.token(issued.token.id).last_used_at == begun
    clock.move(2)
    timed.note_token_use(issued.token.id)
    assert timed.token(issued.token.id).last_used_at == clock.now
