"""Conformance: the queue and its leases."""
# ruff: noqa: S101 # a test suite asserts

from collections.abc import Callable

import pytest

from partwise.errors import ConflictError, NotFoundError, ParameterError
from partwise.store.catalog import Catalog
from partwise.store.records import (
    DEFAULT_RANKING,
    MAX_HELD,
    FirstShape,
    Lease,
    LeasedShape,
    LeaseOutcome,
    LeasePurpose,
    NewClaim,
    NewFailure,
    NewScore,
    NewShape,
    Person,
    RevisionKind,
)
from partwise.testing.catalog.samples import (
    add_collection,
    blank_draft,
    claim,
    confirm,
    label,
    n_waiting,
    publish,
    publish_mesh,
    ready_shapes,
    save_model,
)
from partwise.testing.expect import raises


class QueueConformance:
    def test_shapes_come_in_order_before_any_model(self, catalog: Catalog) -> None:
        collection, shape_ids = ready_shapes(catalog, 3)
        ann = catalog.add_person("ann")
        assert [claim(catalog, collection, ann).shape_id for _ in shape_ids] == shape_ids

    def test_first_shapes_come_first(self, catalog: Catalog) -> None:
        collection, shape_ids = ready_shapes(catalog, 4)
        catalog.replace_first_shapes(collection.id, [FirstShape(shape_ids[2], 0, 0), FirstShape(shape_ids[1], 1, 1)])
        ann = catalog.add_person("ann")
        found = [claim(catalog, collection, ann).shape_id for _ in shape_ids]
        assert found == [shape_ids[2], shape_ids[1], shape_ids[0], shape_ids[3]]

    def test_first_shapes_leave_the_ranks_of_a_model(self, catalog: Catalog) -> None:
        collection, shape_ids = ready_shapes(catalog, 2)
        save_model(catalog, collection.id)
        catalog.replace_first_shapes(collection.id, [FirstShape(shape_ids[1], 0, 0)])
        assert claim(catalog, collection, catalog.add_person("ann")).shape_id == shape_ids[0]

    def test_only_ready_shapes_without_labels_wait(self, catalog: Catalog) -> None:
        collection, (_, failed, ready, labelled) = add_collection(catalog, 4)
        for shape_id in (ready, labelled):
            publish_mesh(catalog, shape_id)
        publish(catalog, [ready, labelled])
        catalog.record_failure(NewFailure(failed, "mesh", "k", "no faces"))
        label(catalog, labelled)
        assert n_waiting(catalog, collection) == 1
        assert claim(catalog, collection, catalog.add_person("ben")).shape_id == ready

    def test_a_shape_labelled_before_it_is_ready_does_not_wait(self, catalog: Catalog) -> None:
        collection, (shape_id,) = add_collection(catalog, 1)
        publish_mesh(catalog, shape_id)
        label(catalog, shape_id, RevisionKind.IMPORTED)
        publish(catalog, [shape_id])
        assert n_waiting(catalog, collection) == 0

    def test_a_shape_that_lost_its_description_does_not_wait(self, catalog: Catalog) -> None:
        collection, (shape_id,) = add_collection(catalog, 1)
        name = publish(catalog, [shape_id])
        assert n_waiting(catalog, collection) == 1
        catalog.supersede_block(name)
        assert n_waiting(catalog, collection) == 0

    def test_nobody_gets_what_another_holds(self, catalog: Catalog) -> None:
        collection, shape_ids = ready_shapes(catalog, 2)
        ann, bob, cat = (catalog.add_person(name) for name in ("ann", "bob", "cat"))
        assert {claim(catalog, collection, each).shape_id for each in (ann, bob)} == set(shape_ids)
        assert catalog.claim_next(NewClaim(collection.id, cat.id, 60, 0.5)) is None
        with raises(ConflictError, "someone else"):
            catalog.claim_shape(shape_ids[0], cat.id, 60)

    def test_what_a_person_holds_is_the_same_after_a_reload(self, catalog: Catalog) -> None:
        collection, _ = ready_shapes(catalog, 3)
        ann = catalog.add_person("ann")
        held = [claim(catalog, collection, ann) for _ in range(2)]
        assert catalog.leases_of(ann.id) == held
        assert [catalog.lease(each.id) for each in held] == held
        assert catalog.active_leases(collection.id) == held
        assert catalog.held_shapes([held[0].shape_id]) == {held[0].shape_id: [held[0]]}

    def test_leases_come_with_what_is_leased(self, catalog: Catalog) -> None:
        collection, _ = ready_shapes(catalog, 3)
        ann, bob = (catalog.add_person(name) for name in ("ann", "bob"))
        begun, untouched = (claim(catalog, collection, ann) for _ in range(2))
        draft = blank_draft(catalog, begun)
        shapes = catalog.listed_shapes([begun.shape_id, untouched.shape_id])
        expected = [
            LeasedShape(lease, row.shape.source_key, row.state, row.shape.mesh_hash, draft_id)
            for lease, row, draft_id in (
                (begun, shapes[begun.shape_id], draft.id),
                (untouched, shapes[untouched.shape_id], None),
            )
        ]
        assert catalog.leased_by(ann.id) == expected
        assert catalog.leased_by(bob.id) == []
        assert catalog.leased_shapes([untouched.id, begun.id, 999]) == {each.lease.id: each for each in expected}

    def test_what_has_ended_is_told_but_not_held(self, catalog: Catalog) -> None:
        collection, _ = ready_shapes(catalog, 1)
        ann = catalog.add_person("ann")
        lease = claim(catalog, collection, ann)
        draft = blank_draft(catalog, lease)
        ended = catalog.release_lease(lease.id, ann.id)
        assert catalog.leased_by(ann.id) == []
        assert catalog.leased_shapes([lease.id])[lease.id].lease == ended
        assert catalog.leased_shapes([lease.id])[lease.id].draft_id == draft.id
        catalog.discard_draft(draft.id, ann.id)
        assert catalog.leased_shapes([lease.id])[lease.id].draft_id is None

    def test_a_person_holds_four_and_one_prefetched(self, catalog: Catalog) -> None:
        collection, shape_ids = ready_shapes(catalog, MAX_HELD + 2)
        ann = catalog.add_person("ann")
        for _ in range(MAX_HELD):
            claim(catalog, collection, ann)
        ahead = claim(catalog, collection, ann, is_prefetch=True)
        assert ahead.is_prefetched
        with raises(ConflictError, "at most 4"):
            claim(catalog, collection, ann)
        with raises(ConflictError, "at most 4"):
            catalog.claim_shape(shape_ids[-1], ann.id, 60)
        with raises(ConflictError, "at most 4"):
            catalog.renew_lease(ahead.id, ann.id, 60, is_prefetched=False)

    def test_one_shape_is_prefetched_at_a_time_and_taken_next(self, catalog: Catalog) -> None:
        collection, _ = ready_shapes(catalog, 3)
        ann = catalog.add_person("ann")
        ahead = claim(catalog, collection, ann, is_prefetch=True)
        assert claim(catalog, collection, ann, is_prefetch=True).id == ahead.id
        taken = claim(catalog, collection, ann)
        assert (taken.id, taken.is_prefetched) == (ahead.id, False)

    def test_one_shape_is_prefetched_at_a_time_in_all_collections(self, catalog: Catalog) -> None:
        chairs, _ = ready_shapes(catalog, 2)
        mugs = catalog.create_collection("mugs", ["body"])
        _, (mug,) = _ready_in(catalog, mugs.id)
        ann = catalog.add_person("ann")
        chair = claim(catalog, chairs, ann, is_prefetch=True)
        ahead = claim(catalog, mugs, ann, is_prefetch=True)
        assert catalog.leases_of(ann.id) == [ahead]
        assert (ahead.shape_id, catalog.lease(chair.id).outcome) == (mug, LeaseOutcome.RELEASED)
        assert claim(catalog, chairs, ann).shape_id == chair.shape_id
        assert [each.is_prefetched for each in catalog.leases_of(ann.id)] == [True, False]

    def test_what_a_person_works_on_is_prefetched_no_more(self, catalog: Catalog) -> None:
        collection, _ = ready_shapes(catalog, 1)
        ann = catalog.add_person("ann")
        lease = claim(catalog, collection, ann)
        assert not catalog.renew_lease(lease.id, ann.id, 60, is_prefetched=True).is_prefetched

    def test_released_shapes_go_back_to_their_rank(self, catalog: Catalog) -> None:
        collection, _ = ready_shapes(catalog, 2)
        ann, bob = catalog.add_person("ann"), catalog.add_person("bob")
        lease = claim(catalog, collection, ann)
        ended = catalog.release_lease(lease.id, ann.id)
        assert ended.outcome is LeaseOutcome.RELEASED
        assert catalog.release_lease(lease.id, ann.id) == ended
        assert claim(catalog, collection, bob).shape_id == lease.shape_id

    def test_skips_are_told_with_their_reasons_newest_first(self, catalog: Catalog) -> None:
        collection, _ = ready_shapes(catalog, 3)
        _, others = ready_shapes(catalog, 1, "mugs")
        ann = catalog.add_person("ann")
        first, second = (claim(catalog, collection, ann) for _ in range(2))
        for lease, reason in ((first, "two chairs in one"), (second, "a hole")):
            catalog.skip_lease(lease.id, ann.id, reason)
        catalog.skip_lease(catalog.claim_shape(others[0], ann.id, 60).id, ann.id, "no mug")
        catalog.release_lease(claim(catalog, collection, ann).id, ann.id)
        newest, oldest = catalog.skips(collection.id)
        assert (newest.shape_id, newest.person_name, newest.reason) == (second.shape_id, "ann", "a hole")
        assert (oldest.shape_id, oldest.reason) == (first.shape_id, "two chairs in one")
        assert newest.skipped_at == catalog.lease(second.id).released_at
        assert catalog.skips(collection.id, limit=1) == [newest]
        assert catalog.skips(collection.id, before=newest.lease_id) == [oldest]

    def test_skipped_shapes_go_to_others(self, catalog: Catalog) -> None:
        collection, (first, second) = ready_shapes(catalog, 2)
        ann, bob = catalog.add_person("ann"), catalog.add_person("bob")
        skipped = catalog.skip_lease(claim(catalog, collection, ann).id, ann.id, " two chairs in one ")
        assert (skipped.outcome, skipped.reason) == (LeaseOutcome.SKIPPED, "two chairs in one")
        assert claim(catalog, collection, ann).shape_id == second
        assert claim(catalog, collection, bob).shape_id == first

    def test_a_skipped_shape_can_be_asked_for_by_name(self, catalog: Catalog) -> None:
        collection, (shape_id,) = ready_shapes(catalog, 1)
        ann = catalog.add_person("ann")
        catalog.skip_lease(claim(catalog, collection, ann).id, ann.id, "unclear")
        assert catalog.claim_next(NewClaim(collection.id, ann.id, 60, 0.5)) is None
        assert catalog.claim_shape(shape_id, ann.id, 60).shape_id == shape_id

    def test_a_skip_needs_a_reason(self, catalog: Catalog) -> None:
        collection, _ = ready_shapes(catalog, 1)
        ann = catalog.add_person("ann")
        lease = claim(catalog, collection, ann)
        with raises(ParameterError, "reason"):
            catalog.skip_lease(lease.id, ann.id, "  ")

    def test_leases_are_their_holders_own(self, catalog: Catalog) -> None:
        collection, _ = ready_shapes(catalog, 1)
        ann, bob = catalog.add_person("ann"), catalog.add_person("bob")
        lease = claim(catalog, collection, ann)
        uses: list[Callable[[], object]] = [
            lambda: catalog.renew_lease(lease.id, bob.id, 60),
            lambda: catalog.release_lease(lease.id, bob.id),
            lambda: catalog.skip_lease(lease.id, bob.id, "no"),
        ]
        for use in uses:
            with raises(ConflictError, "another person's"):
                use()

    def test_what_has_ended_is_not_renewed(self, catalog: Catalog) -> None:
        collection, _ = ready_shapes(catalog, 1)
        ann = catalog.add_person("ann")
        lease = claim(catalog, collection, ann)
        catalog.release_lease(lease.id, ann.id)
        with raises(ConflictError, "released"):
            catalog.renew_lease(lease.id, ann.id, 60)
        with raises(ConflictError, "released"):
            catalog.skip_lease(lease.id, ann.id, "no")

    def test_an_operator_clears_a_lease(self, catalog: Catalog) -> None:
        collection, _ = ready_shapes(catalog, 1)
        ann, bob = catalog.add_person("ann"), catalog.add_person("bob")
        lease = claim(catalog, collection, ann)
        cleared = catalog.clear_lease(lease.id, bob.id)
        assert cleared.outcome is LeaseOutcome.CLEARED
        assert catalog.clear_lease(lease.id, bob.id) == cleared
        assert (catalog.audit()[-1].actor, catalog.audit()[-1].action) == ("bob", "clear lease")
        assert claim(catalog, collection, bob).shape_id == lease.shape_id

    def test_labelled_shapes_are_claimed_by_name_only(self, catalog: Catalog) -> None:
        collection, (shape_id,) = ready_shapes(catalog, 1)
        ann = catalog.add_person("ann")
        confirm(catalog, claim(catalog, collection, ann))
        assert catalog.claim_next(NewClaim(collection.id, ann.id, 60, 0.5)) is None
        again = catalog.claim_shape(shape_id, ann.id, 60)
        assert catalog.claim_shape(shape_id, ann.id, 60).id == again.id
        assert again.purpose is LeasePurpose.LABEL

    def test_a_shape_without_a_surface_is_not_claimed_by_name(self, catalog: Catalog) -> None:
        _, (shape_id,) = add_collection(catalog, 1)
        with raises(ConflictError, "needs a surface"):
            catalog.claim_shape(shape_id, catalog.add_person("ann").id, 60)

    def test_a_reopened_shape_comes_first_for_everyone_again(self, catalog: Catalog) -> None:
        collection, (first, second) = ready_shapes(catalog, 2)
        ann, bob = catalog.add_person("ann"), catalog.add_person("bob")
        held = claim(catalog, collection, ann)
        with raises(ConflictError, "works on shape"):
            catalog.reopen_shape(first, bob.id)
        confirm(catalog, held)
        catalog.reopen_shape(first, bob.id)
        again = claim(catalog, collection, ann)
        assert (again.shape_id, again.round) == (first, 2)
        assert claim(catalog, collection, bob).shape_id == second

    def test_a_shape_reopened_for_one_goes_to_no_other(self, catalog: Catalog) -> None:
        collection, (shape_id,) = ready_shapes(catalog, 1)
        ann, bob = catalog.add_person("ann"), catalog.add_person("bob")
        confirm(catalog, claim(catalog, collection, ann))
        catalog.reopen_shape(shape_id, bob.id, for_person_id=ann.id)
        assert catalog.claim_next(NewClaim(collection.id, bob.id, 60, 0.5)) is None
        assert claim(catalog, collection, ann).shape_id == shape_id

    def test_a_shape_without_a_surface_is_not_reopened(self, catalog: Catalog) -> None:
        _, (shape_id,) = add_collection(catalog, 1)
        with raises(ConflictError, "no surface"):
            catalog.reopen_shape(shape_id, catalog.add_person("ann").id)

    def test_assigned_shapes_are_kept_for_one(self, catalog: Catalog) -> None:
        collection, (first, second, third) = ready_shapes(catalog, 3)
        ann, bob = catalog.add_person("ann"), catalog.add_person("bob")
        assert catalog.assign_shapes([third, first], ann.id, bob.id) == 2
        assert claim(catalog, collection, bob).shape_id == second
        assert [claim(catalog, collection, ann).shape_id for _ in range(2)] == [first, third]
        catalog.release_lease(catalog.leases_of(ann.id)[0].id, ann.id)
        assert catalog.queue_depth(collection.id).n_assigned == 1
        assert catalog.assign_shapes([first], None, bob.id) == 1
        assert claim(catalog, collection, bob).shape_id == first

    def test_what_is_kept_for_one_is_no_others_by_name_either(self, catalog: Catalog) -> None:
        _, (shape_id,) = ready_shapes(catalog, 1)
        ann, bob = catalog.add_person("ann"), catalog.add_person("bob")
        catalog.assign_shapes([shape_id], ann.id, bob.id)
        with raises(ConflictError, "kept for someone else"):
            catalog.claim_shape(shape_id, bob.id, 60)
        assert catalog.claim_shape(shape_id, ann.id, 60).shape_id == shape_id

    def test_a_round_is_not_passed_by_when_all_its_labels_are_in_work(self, catalog: Catalog) -> None:
        collection, (shape_id,) = ready_shapes(catalog, 1)
        catalog.update_collection_settings(collection.id, {"labels_per_shape": 2})
        catalog.fill_queue(collection.id)
        ann, bob, cleo = (catalog.add_person(name) for name in ("ann", "bob", "cleo"))
        confirm(catalog, claim(catalog, collection, ann))
        claim(catalog, collection, bob)
        with raises(ConflictError, "with someone else"):
            catalog.claim_shape(shape_id, cleo.id, 60)

    def test_ranks_say_who_is_next_and_disturb_nobody(self, catalog: Catalog) -> None:
        collection, (first, second, third) = ready_shapes(catalog, 3)
        ann, bob = catalog.add_person("ann"), catalog.add_person("bob")
        held = claim(catalog, collection, ann)
        assert catalog.set_ranks(collection.id, {first: 3, second: 2, third: 1}) == 3
        assert catalog.set_ranks(collection.id, {third: 1}) == 0
        assert catalog.leases_of(ann.id) == [held]
        assert [claim(catalog, collection, bob).shape_id for _ in range(2)] == [third, second]

    def test_each_label_of_a_shape_is_another_persons(self, catalog: Catalog) -> None:
        collection, (shape_id, other) = ready_shapes(catalog, 2)
        catalog.update_collection_settings(collection.id, {"labels_per_shape": 2})
        assert catalog.fill_queue(collection.id) == other
        assert catalog.fill_queue(collection.id, after=other) is None
        ann, bob, cat = (catalog.add_person(name) for name in ("ann", "bob", "cat"))
        leases = [claim(catalog, collection, each) for each in (ann, bob)]
        assert [(each.shape_id, each.slot) for each in leases] == [(shape_id, 0), (shape_id, 1)]
        assert {each.purpose for each in leases} == {LeasePurpose.INDEPENDENT}
        assert claim(catalog, collection, ann).shape_id == other
        confirm(catalog, leases[0])
        with raises(ConflictError, "different people's"):
            catalog.claim_shape(shape_id, ann.id, 60)
        assert claim(catalog, collection, cat).shape_id == other

    def test_fewer_labels_per_shape_take_places_away(self, catalog: Catalog) -> None:
        collection = catalog.create_collection("mugs", ["body"], {"labels_per_shape": 3})
        _, (shape_id,) = _ready_in(catalog, collection.id)
        assert catalog.queue_depth(collection.id).n_free == 3
        catalog.update_collection_settings(collection.id, {"labels_per_shape": 1})
        catalog.fill_queue(collection.id)
        assert catalog.queue_depth(collection.id).n_free == 1
        lease = claim(catalog, collection, catalog.add_person("ann"))
        assert (lease.shape_id, lease.purpose) == (shape_id, LeasePurpose.LABEL)

    def test_depth_counts_what_waits_and_what_is_held(self, catalog: Catalog) -> None:
        collection, _ = ready_shapes(catalog, 3)
        claim(catalog, collection, catalog.add_person("ann"))
        depth = catalog.queue_depth(collection.id)
        assert (depth.n_free, depth.n_held, depth.n_assigned) == (2, 1, 0)
        assert depth.oldest_at is not None

    def test_known_shapes_are_served_blind(self, catalog: Catalog) -> None:
        collection, (first, known) = ready_shapes(catalog, 2)
        catalog.update_collection_settings(collection.id, {"honeypot_share": 0.5})
        label(catalog, known, RevisionKind.REFERENCE)
        ann = catalog.list_people()[0]
        blind = catalog.claim_next(NewClaim(collection.id, ann.id, 60, 0.49))
        assert blind is not None
        assert (blind.shape_id, blind.purpose) == (known, LeasePurpose.BLIND)
        plain = catalog.claim_next(NewClaim(collection.id, ann.id, 60, 0.5))
        assert plain is not None
        assert (plain.shape_id, plain.purpose) == (first, LeasePurpose.LABEL)

    def test_a_lease_tells_the_rank_and_the_score_that_ranks(self, catalog: Catalog) -> None:
        collection, (first, second, third) = ready_shapes(catalog, 3)
        model = save_model(catalog, collection.id)
        scores = {first: 0.1, second: 0.3, third: 0.2}
        catalog.record_done([], [NewScore(i, model.id, "bald", value) for i, value in scores.items()])
        assert catalog.ranking_score(collection.id) == DEFAULT_RANKING
        catalog.set_ranks(collection.id, {first: 3, second: 1, third: 2})
        ann = catalog.add_person("ann")
        named = catalog.claim_shape(first, ann.id, 60)
        assert (named.rank, named.score_name, named.score) == (3, None, None)
        catalog.record_ranking(collection.id, "bald")
        assert catalog.ranking_score(collection.id) == "bald"
        lease = claim(catalog, collection, ann)
        assert (lease.shape_id, lease.rank, lease.score_name, lease.score) == (second, 1, "bald", 0.3)
        assert lease.model_version == model.version
        assert catalog.leases_of(ann.id)[1] == lease

    def test_blind_work_tells_what_other_work_would(self, catalog: Catalog) -> None:
        collection, (first, second, third, known) = ready_shapes(catalog, 4)
        model = save_model(catalog, collection.id)
        scores = {first: 0.9, second: 0.8, third: 0.7, known: 0.01}
        catalog.record_done([], [NewScore(i, model.id, "entropy", value) for i, value in scores.items()])
        catalog.set_ranks(collection.id, {first: 1, second: 2, third: 3, known: 4})
        label(catalog, known, RevisionKind.REFERENCE)
        catalog.update_collection_settings(collection.id, {"honeypot_share": 0.5})
        ann = catalog.list_people()[0]
        blind = catalog.claim_next(NewClaim(collection.id, ann.id, 60, 0.1))
        plain = catalog.claim_next(NewClaim(collection.id, ann.id, 60, 0.9))
        assert blind is not None
        assert plain is not None
        assert (blind.shape_id, plain.shape_id) == (known, first)
        assert (blind.rank, blind.score_name, blind.model_version) == (1, "entropy", 1)
        assert blind.score == pytest.approx(0.85)
        assert (plain.rank, plain.score) == (1, 0.9)

    @pytest.mark.parametrize("by_name", [True, False])
    def test_a_blind_check_that_was_given_back_is_one_again(self, catalog: Catalog, by_name: bool) -> None:
        collection, (known,) = ready_shapes(catalog, 1)
        model = save_model(catalog, collection.id)
        catalog.record_done([], [NewScore(known, model.id, "entropy", 0.1)])
        catalog.update_collection_settings(collection.id, {"honeypot_share": 0.5})
        label(catalog, known, RevisionKind.REFERENCE)
        ann, bob = catalog.list_people()[0], catalog.add_person("bob")
        blind = catalog.claim_next(NewClaim(collection.id, ann.id, 60, 0.1))
        assert blind is not None
        catalog.release_lease(blind.id, ann.id)
        catalog.record_done([], [NewScore(known, model.id, "entropy", 0.9)])

        def again(person: Person) -> Lease:
            return catalog.claim_shape(known, person.id, 60) if by_name else claim(catalog, collection, person)

        told = ("purpose", "rank", "score_name", "score", "model_version")
        second = again(ann)
        assert [getattr(second, name) for name in told] == [getattr(blind, name) for name in told]
        assert second.purpose is LeasePurpose.BLIND
        catalog.release_lease(second.id, ann.id)
        theirs = again(bob)
        assert (theirs.purpose, theirs.score) == (LeasePurpose.LABEL, 0.9)

    def test_a_blind_check_that_was_given_back_is_work_once_the_shape_is_assigned(self, catalog: Catalog) -> None:
        collection, (known,) = ready_shapes(catalog, 1)
        catalog.update_collection_settings(collection.id, {"honeypot_share": 0.5})
        label(catalog, known, RevisionKind.REFERENCE)
        ann = catalog.list_people()[0]
        blind = catalog.claim_next(NewClaim(collection.id, ann.id, 60, 0.1))
        assert blind is not None
        assert blind.purpose is LeasePurpose.BLIND
        catalog.release_lease(blind.id, ann.id)
        catalog.assign_shapes([known], ann.id, ann.id)
        assert claim(catalog, collection, ann).purpose is LeasePurpose.LABEL

    def test_who_did_a_blind_check_labels_the_shape_when_they_ask_for_it(self, catalog: Catalog) -> None:
        collection, (known,) = ready_shapes(catalog, 1)
        catalog.update_collection_settings(collection.id, {"honeypot_share": 1.0})
        label(catalog, known, RevisionKind.REFERENCE)
        ann = catalog.list_people()[0]
        confirm(catalog, claim(catalog, collection, ann))
        assert catalog.claim_shape(known, ann.id, 60).purpose is LeasePurpose.LABEL

    def test_only_what_waits_like_all_else_is_served_blind(self, catalog: Catalog) -> None:
        collection, (confirmed, assigned, other) = ready_shapes(catalog, 3)
        catalog.update_collection_settings(collection.id, {"honeypot_share": 1.0})
        for shape_id in (confirmed, assigned):
            label(catalog, shape_id, RevisionKind.REFERENCE)
        ann, ben = catalog.list_people()[0], catalog.add_person("ben")
        label(catalog, confirmed)
        catalog.assign_shapes([assigned], ben.id, ann.id)
        lease = claim(catalog, collection, ann)
        assert (lease.shape_id, lease.purpose) == (other, LeasePurpose.LABEL)

    def test_nobody_is_checked_twice_with_one_shape(self, catalog: Catalog) -> None:
        collection, (known, other) = ready_shapes(catalog, 2)
        catalog.update_collection_settings(collection.id, {"honeypot_share": 1.0})
        label(catalog, known, RevisionKind.REFERENCE)
        ann = catalog.list_people()[0]
        confirm(catalog, claim(catalog, collection, ann))
        assert claim(catalog, collection, ann).shape_id == other
        assert claim(catalog, collection, catalog.add_person("bob")).purpose is LeasePurpose.BLIND

    def test_unknown_ids_are_refused(self, catalog: Catalog) -> None:
        collection, (shape_id,) = ready_shapes(catalog, 1)
        ann = catalog.add_person("ann")
        uses: list[Callable[[], object]] = [
            lambda: catalog.lease(99),
            lambda: catalog.claim_next(NewClaim(99, ann.id, 60, 0.5)),
            lambda: catalog.claim_next(NewClaim(collection.id, 99, 60, 0.5)),
            lambda: catalog.claim_shape(99, ann.id, 60),
            lambda: catalog.claim_shape(shape_id, 99, 60),
            lambda: catalog.queue_depth(99),
        ]
        for use in uses:
            with raises(NotFoundError, "99"):
                use()

    @pytest.mark.parametrize("lease_s", [0.0, -1.0, 86_401.0])
    def test_lease_times_have_limits(self, catalog: Catalog, lease_s: float) -> None:
        collection, (shape_id,) = ready_shapes(catalog, 1)
        ann = catalog.add_person("ann")
        with raises(ParameterError, "lease"):
            NewClaim(collection.id, ann.id, lease_s, 0.5)
        with raises(ParameterError, "lease"):
            catalog.claim_shape(shape_id, ann.id, lease_s)


def _ready_in(catalog: Catalog, collection_id: int) -> tuple[int, list[int]]:
    """A shape of an existing collection that waits."""
    (ingested,) = catalog.add_shapes(collection_id, [NewShape("a.off", "x", ".off")])
    publish_mesh(catalog, ingested.shape_id)
    publish(catalog, [ingested.shape_id])
    return collection_id, [ingested.shape_id]
