"""Conformance: strokes become labels, which are reviewed, compared and measured."""
# ruff: noqa: S101 # a test suite asserts

from dataclasses import replace

import numpy as np
import pytest

from partwise.errors import ConflictError, LabelError, NotFoundError, ParameterError, StaleDraftError
from partwise.labels.annotation_cost import AnnotationCost
from partwise.store.catalog import Catalog
from partwise.store.records import (
    Closeness,
    Collection,
    Confirmation,
    DraftOutcome,
    Effort,
    EventKind,
    JobKind,
    JobState,
    Lease,
    LeaseOutcome,
    LeasePurpose,
    NewBlindCheck,
    NewConfirmation,
    NewConsensus,
    RevisionKind,
    ShapeState,
)
from partwise.store.reviews import NewReview, ReviewOutcome, ReviewReason
from partwise.testing.catalog.samples import (
    blank_draft,
    claim,
    confirm,
    label,
    leased_shape,
    n_waiting,
    ready_shapes,
    strokes,
)
from partwise.testing.expect import raises

CLOSE = Closeness(0.95, 0.9, 0.01)
FAR = Closeness(0.5, 0.4, 0.2)


def _two_leased(catalog: Catalog, **settings: object) -> tuple[Collection, list[Lease]]:
    """One shape of which two people hold a label each."""
    collection, _ = ready_shapes(catalog, 1)
    catalog.update_collection_settings(collection.id, {"labels_per_shape": 2, **settings})
    catalog.fill_queue(collection.id)
    return collection, [claim(catalog, collection, catalog.add_person(name)) for name in ("ann", "bob")]


def _disputed(catalog: Catalog) -> tuple[Collection, Confirmation, Confirmation]:
    """A shape in which ann and bob see different parts."""
    collection, (first, second) = _two_leased(catalog)
    mine = confirm(catalog, first, [1] * 6)
    return collection, mine, confirm(catalog, second, [2] * 6, NewConsensus((mine.answer_id or 0,), FAR, None))


class ConfirmationConformance:
    def test_confirmed_strokes_become_the_shapes_labels(self, catalog: Catalog) -> None:
        collection, lease = leased_shape(catalog)
        confirmation = confirm(catalog, lease, [1, 1, 1, 2, 2, 2])
        assert confirmation.revision_id is not None
        head = catalog.revision(confirmation.revision_id)
        assert (head.kind, head.author_id, head.sha256) == (RevisionKind.HUMAN, lease.person_id, confirmation.sha256)
        assert catalog.labels(head.id).tolist() == [1, 1, 1, 2, 2, 2]
        assert catalog.lease(lease.id).outcome is LeaseOutcome.COMPLETED
        assert catalog.draft(confirmation.draft_id).outcome is DraftOutcome.CONFIRMED
        assert catalog.shape_states([lease.shape_id]) == {lease.shape_id: ShapeState.CONFIRMED}
        assert n_waiting(catalog, collection) == 0
        assert {entry.action for entry in catalog.audit()} >= {"label", "confirm"}

    def test_confirming_again_returns_what_became_of_it(self, catalog: Catalog) -> None:
        _, lease = leased_shape(catalog)
        first = confirm(catalog, lease, [1, 1, 1, 2, 2, 2])
        again = NewConfirmation(first.draft_id, lease.person_id, 1, np.array([1, 1, 1, 2, 2, 2]), 1)
        assert catalog.confirm_draft(again) == first
        with raises(ConflictError, "confirmed"):
            catalog.confirm_draft(replace(again, labels=np.ones(6, int)))
        assert len(catalog.revisions(lease.shape_id)) == 1

    def test_strokes_that_came_since_are_not_left_out(self, catalog: Catalog) -> None:
        _, lease = leased_shape(catalog)
        draft = blank_draft(catalog, lease)
        catalog.append_strokes(draft.id, draft.person_id, 0, strokes(draft, 0, 2))
        with pytest.raises(StaleDraftError, match="has 2, not 1") as refused:
            catalog.confirm_draft(NewConfirmation(draft.id, draft.person_id, 1, np.ones(6, int), 1))
        assert refused.value.state["n_strokes"] == 2
        assert catalog.revisions(lease.shape_id) == []

    def test_what_others_confirmed_meanwhile_is_not_hidden(self, catalog: Catalog) -> None:
        _, lease = leased_shape(catalog)
        draft = blank_draft(catalog, lease)
        theirs = label(catalog, lease.shape_id)
        new = NewConfirmation(draft.id, draft.person_id, 0, np.ones(6, int), 1)
        with pytest.raises(StaleDraftError, match="both are kept") as refused:
            catalog.confirm_draft(new)
        assert refused.value.state["head_revision"] == theirs.id
        with raises(StaleDraftError, "look again"):
            catalog.acknowledge_head(draft.id, draft.person_id, theirs.id + 1)
        assert catalog.acknowledge_head(draft.id, draft.person_id, theirs.id).seen_revision == theirs.id
        committed = catalog.confirm_draft(new).revision_id
        assert committed is not None
        assert catalog.revision(committed).parent_id == theirs.id

    def test_a_lease_is_taken_up_again_if_the_place_is_free(self, catalog: Catalog) -> None:
        collection, lease = leased_shape(catalog)
        draft = blank_draft(catalog, lease)
        catalog.release_lease(lease.id, lease.person_id)
        new = NewConfirmation(draft.id, draft.person_id, 0, np.ones(6, int), 1)
        bob = catalog.add_person("bob")
        theirs = claim(catalog, collection, bob)
        with raises(ConflictError, "someone else", "is kept"):
            catalog.confirm_draft(new)
        assert catalog.draft(draft.id).closed_at is None
        catalog.release_lease(theirs.id, bob.id)
        assert catalog.confirm_draft(new).revision_id is not None
        assert catalog.active_leases(collection.id) == []

    def test_labels_that_do_not_fit_leave_everything_as_it_was(self, catalog: Catalog) -> None:
        _, lease = leased_shape(catalog)
        draft = blank_draft(catalog, lease)
        for labels in (np.ones(5, int), np.full(6, 9), np.ones(6), np.ones((2, 3), int)):
            with pytest.raises(LabelError):
                catalog.confirm_draft(NewConfirmation(draft.id, draft.person_id, 0, labels, 1))
        assert catalog.lease(lease.id) == lease
        assert catalog.draft(draft.id) == draft
        assert catalog.revisions(lease.shape_id) == []

    def test_enough_confirmed_shapes_ask_for_one_training(self, catalog: Catalog) -> None:
        collection, _ = ready_shapes(catalog, 6)
        catalog.update_collection_settings(collection.id, {"train_after": 2})
        ann = catalog.add_person("ann")
        confirm(catalog, claim(catalog, collection, ann))
        assert catalog.jobs(collection.id) == []
        for _ in range(3):
            confirm(catalog, claim(catalog, collection, ann))
        (pending,) = catalog.jobs(collection.id)
        assert (pending.kind, pending.state) == (JobKind.TRAIN, JobState.PENDING)
        assert catalog.claim_job("w1") is not None
        confirm(catalog, claim(catalog, collection, ann))
        assert len(catalog.jobs(collection.id)) == 1
        confirm(catalog, claim(catalog, collection, ann))
        assert [job.state for job in catalog.jobs(collection.id)] == [JobState.PENDING, JobState.RUNNING]

    def test_no_training_is_asked_for_where_the_setting_is_zero(self, catalog: Catalog) -> None:
        collection, lease = leased_shape(catalog)
        catalog.update_collection_settings(collection.id, {"train_after": 0})
        confirm(catalog, lease)
        assert catalog.jobs(collection.id) == []

    def test_a_reviewer_looks_first_where_the_collection_says_so(self, catalog: Catalog) -> None:
        collection, lease = leased_shape(catalog)
        catalog.update_collection_settings(collection.id, {"review": True, "train_after": 1})
        confirmation = confirm(catalog, lease)
        (review,) = catalog.open_reviews(collection.id)
        assert (review.id, review.reason) == (confirmation.review_id, ReviewReason.CHECK)
        assert catalog.jobs(collection.id) == []
        catalog.accept_review(review.id, catalog.add_person("rita").id)
        assert catalog.shape_states([lease.shape_id]) == {lease.shape_id: ShapeState.CONFIRMED}
        assert [job.kind for job in catalog.jobs(collection.id)] == [JobKind.TRAIN]

    @pytest.mark.parametrize("for_author", [True, False])
    def test_rejected_labels_are_done_again(self, catalog: Catalog, for_author: bool) -> None:
        collection, lease = leased_shape(catalog)
        catalog.update_collection_settings(collection.id, {"review": True})
        rita = catalog.add_person("rita")
        first = confirm(catalog, lease, [1, 1, 1, 2, 2, 2])
        assert first.review_id is not None
        rework = catalog.reject_review(first.review_id, rita.id, "the back is missing", for_author=for_author)
        assert (rework.reason, rework.detail["note"]) == (ReviewReason.REWORK, "the back is missing")
        assert [each.outcome for each in catalog.reviews(lease.shape_id)] == [ReviewOutcome.REJECTED, None]
        who = catalog.get_person("ann") if for_author else rita
        again = claim(catalog, collection, who)
        assert again.shape_id == lease.shape_id
        second = confirm(catalog, again, [1, 1, 2, 2, 2, 2])
        assert second.revision_id is not None
        assert [each.reason for each in catalog.open_reviews(collection.id)] == [ReviewReason.CHECK]

    def test_rejecting_needs_a_note_an_open_review_and_a_free_shape(self, catalog: Catalog) -> None:
        collection, lease = leased_shape(catalog)
        catalog.update_collection_settings(collection.id, {"review": True})
        review_id = confirm(catalog, lease).review_id
        assert review_id is not None
        with raises(ParameterError, "note"):
            catalog.reject_review(review_id, lease.person_id, " ")
        with raises(NotFoundError, "99"):
            catalog.reject_review(99, lease.person_id, "no")
        held = catalog.claim_shape(lease.shape_id, lease.person_id, 60)
        with raises(ConflictError, "works on shape"):
            catalog.reject_review(review_id, lease.person_id, "no")
        catalog.release_lease(held.id, lease.person_id)
        catalog.accept_review(review_id, lease.person_id)
        with raises(ConflictError, "accepted"):
            catalog.reject_review(review_id, lease.person_id, "no")

    def test_accepting_what_was_sent_back_takes_it_out_of_the_queue(self, catalog: Catalog) -> None:
        collection, lease = leased_shape(catalog)
        catalog.update_collection_settings(collection.id, {"review": True})
        review_id = confirm(catalog, lease).review_id
        assert review_id is not None
        rework = catalog.reject_review(review_id, lease.person_id, "hm")
        catalog.accept_review(rework.id, lease.person_id)
        assert n_waiting(catalog, collection) == 0

    def test_labels_that_agree_become_the_shapes(self, catalog: Catalog) -> None:
        _, (first, second) = _two_leased(catalog)
        mine = confirm(catalog, first, [1, 1, 1, 2, 2, 2])
        assert (mine.revision_id, mine.review_id) == (None, None)
        assert mine.answer_id is not None
        assert catalog.shape_states([first.shape_id]) == {first.shape_id: ShapeState.READY}
        draft = blank_draft(catalog, second)
        assert catalog.awaited_answers(draft.id) == (catalog.answers(first.shape_id), 0)
        theirs = confirm(catalog, second, [1, 1, 2, 2, 2, 2], NewConsensus((mine.answer_id,), CLOSE, mine.answer_id))
        assert theirs.revision_id is not None
        head = catalog.revision(theirs.revision_id)
        assert (head.author_id, catalog.labels(head.id).tolist()) == (first.person_id, [1, 1, 1, 2, 2, 2])
        (settled,) = catalog.consensus_of(first.shape_id)
        assert (settled.is_agreed, settled.closeness, settled.medoid_id) == (True, CLOSE, mine.answer_id)
        assert settled.answer_ids == (mine.answer_id, theirs.answer_id)
        assert catalog.shape_states([first.shape_id]) == {first.shape_id: ShapeState.CONFIRMED}

    def test_labels_that_disagree_wait_for_a_reviewer(self, catalog: Catalog) -> None:
        collection, (first, second) = _two_leased(catalog)
        mine = confirm(catalog, first)
        assert mine.answer_id is not None
        theirs = confirm(catalog, second, [2] * 6, NewConsensus((mine.answer_id,), FAR, None))
        (review,) = catalog.open_reviews(collection.id)
        assert (review.id, review.reason) == (theirs.review_id, ReviewReason.DISAGREEMENT)
        assert not catalog.consensus_of(first.shape_id)[0].is_agreed
        assert catalog.jobs(collection.id) == []

    def test_a_consensus_is_over_all_answers_on_record(self, catalog: Catalog) -> None:
        _, (first, second) = _two_leased(catalog)
        with raises(StaleDraftError, "compare again"):
            confirm(catalog, first, [1] * 6, NewConsensus((), CLOSE, None))
        mine = confirm(catalog, first)
        assert mine.answer_id is not None
        for wrong in (None, NewConsensus((), CLOSE, None), NewConsensus((mine.answer_id, 99), CLOSE, None)):
            draft = blank_draft(catalog, second)
            new = NewConfirmation(draft.id, draft.person_id, draft.n_strokes, np.ones(6, int), 1, wrong)
            with raises(StaleDraftError, "compare again"):
                catalog.confirm_draft(new)
        with raises(ConflictError, "medoid"):
            catalog.confirm_draft(replace(new, consensus=NewConsensus((mine.answer_id,), CLOSE, 99)))
        assert catalog.answer_labels(mine.answer_id).tolist() == [1, 1, 1, 2, 2, 2]

    def test_a_part_that_labels_may_yet_bring_is_not_removed(self, catalog: Catalog) -> None:
        collection, (first, second) = _two_leased(catalog)
        mine = confirm(catalog, first, [2] * 6)
        with raises(ConflictError, "back", "1 shape that is still being compared"):
            catalog.remove_part(collection.id, 2)
        assert mine.answer_id is not None
        theirs = confirm(catalog, second, [1] * 6, NewConsensus((mine.answer_id,), FAR, None))
        with raises(ConflictError, "back", "1 shape that is still being compared"):
            catalog.remove_part(collection.id, 2)
        assert theirs.review_id is not None
        catalog.accept_review(theirs.review_id, first.person_id)
        assert catalog.remove_part(collection.id, 2).ids == (1,)

    def test_independent_labels_have_no_part_that_is_gone(self, catalog: Catalog) -> None:
        collection, (first, _) = _two_leased(catalog)
        catalog.remove_part(collection.id, 2)
        with raises(LabelError, "part id 2", "schema version 2"):
            confirm(catalog, first, [2] * 6)
        assert catalog.answers(first.shape_id) == []

    def test_labels_that_agree_under_older_parts_are_looked_at(self, catalog: Catalog) -> None:
        collection, (first, second) = _two_leased(catalog)
        mine = confirm(catalog, first)
        catalog.add_part(collection.id, "lid")
        assert mine.answer_id is not None
        theirs = confirm(catalog, second, consensus=NewConsensus((mine.answer_id,), CLOSE, mine.answer_id))
        (review,) = catalog.open_reviews(collection.id)
        assert (review.id, review.revision_id) == (theirs.review_id, theirs.revision_id)
        assert (review.reason, review.detail) == (ReviewReason.SCHEMA, {"version": 2})

    def test_a_reviewer_chooses_whose_labels_become_the_shapes(self, catalog: Catalog) -> None:
        collection, mine, theirs = _disputed(catalog)
        assert theirs.review_id is not None
        assert mine.answer_id is not None
        rita = catalog.add_person("rita")
        chosen = catalog.choose_answer(theirs.review_id, mine.answer_id, rita.id)
        assert (chosen.author_id, chosen.parent_id) == (catalog.get_person("ann").id, theirs.revision_id)
        assert catalog.head_revision(chosen.shape_id) == chosen
        assert catalog.open_reviews(collection.id) == []
        entry = catalog.audit()[-1]
        assert (entry.actor, entry.action, entry.detail["answer_id"]) == ("rita", "choose labels", mine.answer_id)
        with raises(ConflictError, "resolved once"):
            catalog.choose_answer(theirs.review_id, mine.answer_id, rita.id)

    def test_labels_chosen_under_older_parts_are_looked_at(self, catalog: Catalog) -> None:
        collection, mine, theirs = _disputed(catalog)
        catalog.add_part(collection.id, "lid")
        assert theirs.review_id is not None
        assert mine.answer_id is not None
        chosen = catalog.choose_answer(theirs.review_id, mine.answer_id, catalog.add_person("rita").id)
        (review,) = catalog.open_reviews(collection.id)
        assert (review.reason, review.revision_id) == (ReviewReason.SCHEMA, chosen.id)

    def test_only_what_a_review_compares_is_chosen(self, catalog: Catalog) -> None:
        collection, mine, theirs = _disputed(catalog)
        assert theirs.review_id is not None
        assert mine.answer_id is not None
        rita = catalog.add_person("rita")
        catalog.reject_review(theirs.review_id, rita.id, "both are wrong")
        again = [claim(catalog, collection, catalog.get_person(name)) for name in ("ann", "bob")]
        first = confirm(catalog, again[0], [1] * 6)
        assert first.answer_id is not None
        second = confirm(catalog, again[1], [2] * 6, NewConsensus((first.answer_id,), FAR, None))
        assert second.review_id is not None
        before = catalog.audit()
        with raises(NotFoundError, f"no labels {mine.answer_id} to choose"):
            catalog.choose_answer(second.review_id, mine.answer_id, rita.id)
        check = catalog.add_review(second.revision_id or 0, NewReview(ReviewReason.CHECK))
        with raises(ConflictError, "reason check"):
            catalog.choose_answer(check.id, first.answer_id, rita.id)
        assert catalog.audit() == before

    def test_blind_labels_are_measured_and_never_shown(self, catalog: Catalog) -> None:
        collection, (known,) = ready_shapes(catalog, 1)
        catalog.update_collection_settings(collection.id, {"honeypot_share": 1.0, "train_after": 1})
        reference = label(catalog, known, RevisionKind.REFERENCE)
        lease = claim(catalog, collection, catalog.list_people()[0])
        confirmation = confirm(catalog, lease, [1] * 6, None, NewBlindCheck(reference.id, FAR))
        assert (confirmation.revision_id, confirmation.review_id) == (None, None)
        assert catalog.head_revision(known) is None
        assert catalog.jobs(collection.id) == []
        (check,) = catalog.blind_checks(collection.id)
        assert (check.person_id, check.reference_id, check.closeness) == (lease.person_id, reference.id, FAR)
        assert n_waiting(catalog, collection) == 1

    @pytest.mark.parametrize("is_blind", [False, True])
    def test_events_do_not_say_what_work_was_for(self, catalog: Catalog, is_blind: bool) -> None:
        collection, (known, _) = ready_shapes(catalog, 2)
        label(catalog, known, RevisionKind.REFERENCE)
        catalog.update_collection_settings(collection.id, {"honeypot_share": float(is_blind), "train_after": 0})
        lease = claim(catalog, collection, catalog.list_people()[0])
        assert (lease.purpose is LeasePurpose.BLIND) == is_blind
        before = catalog.event_bounds().newest
        confirm(catalog, lease)
        told = [(each.kind, dict(each.payload)) for each in catalog.events(after=before)]
        assert told == [
            (EventKind.SHAPE, {"shape_id": known, "what": "labelled"}),
            (EventKind.QUEUE, {"shape_id": known, "person_id": lease.person_id, "what": "completed"}),
            (EventKind.PEOPLE, {"person_id": lease.person_id, "what": "confirmed"}),
        ]

    def test_what_a_draft_cost_is_on_record(self, catalog: Catalog) -> None:
        collection, _ = ready_shapes(catalog, 1)
        lease = claim(catalog, collection, catalog.add_person("ann"))
        draft = blank_draft(catalog, lease)
        cost = AnnotationCost(strokes=2, commands=1, undos=1, redos=0, active_s=12.5, n_idle_gaps=0)
        made = catalog.confirm_draft(NewConfirmation(draft.id, draft.person_id, 0, np.ones(6, int), 1, cost=cost))
        confirmed = catalog.draft(draft.id)
        assert (confirmed.active_s, confirmed.n_clicks) == (12.5, 4)
        assert made.revision_id is not None
        assert catalog.revision_efforts([made.revision_id, 99]) == {made.revision_id: Effort(12.5, 4)}

    def test_what_a_label_put_aside_cost_is_on_record(self, catalog: Catalog) -> None:
        _, leases = _two_leased(catalog, labels_per_shape=2)
        draft = blank_draft(catalog, leases[0])
        cost = AnnotationCost(strokes=3, commands=0, undos=0, redos=0, active_s=4.0, n_idle_gaps=0)
        made = catalog.confirm_draft(NewConfirmation(draft.id, draft.person_id, 0, np.ones(6, int), 1, cost=cost))
        assert made.answer_id is not None
        assert catalog.answer_efforts([made.answer_id, 99]) == {made.answer_id: Effort(4.0, 3)}

    def test_labels_that_nobody_drew_here_cost_nothing_known(self, catalog: Catalog) -> None:
        _, (shape_id,) = ready_shapes(catalog, 1)
        assert catalog.revision_efforts([label(catalog, shape_id).id]) == {}

    def test_shares_are_shares(self, catalog: Catalog) -> None:  # noqa: ARG002 # the suite's signature
        for wrong in ((1.5, 0.0, 0.0), (0.0, -0.1, 0.0), (0.0, 0.0, float("nan"))):
            with raises(ParameterError, "[0, 1]"):
                Closeness(*wrong)
