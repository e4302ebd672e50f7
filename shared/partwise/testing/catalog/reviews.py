"""Conformance: reviews of labels."""
# ruff: noqa: S101 # a test suite asserts

from partwise.errors import ConflictError, LabelError, NotFoundError, ParameterError
from partwise.store.catalog import Catalog
from partwise.store.records import Collection, EventKind, JobKind, LabelRevision, RevisionKind, ShapeState
from partwise.store.reviews import NewReview, ReviewOutcome, ReviewReason
from partwise.testing.catalog.samples import add_collection, label, move, publish_mesh, ready_shapes
from partwise.testing.expect import raises

_MAP_BACK = NewReview(ReviewReason.MAP_BACK, {"agreement": 0.9})


def _labelled(catalog: Catalog, kind: RevisionKind = RevisionKind.HUMAN) -> LabelRevision:
    """The labels of the one shape of a new collection."""
    _, (shape_id,) = add_collection(catalog, 1)
    publish_mesh(catalog, shape_id)
    return label(catalog, shape_id, kind)


class ReviewConformance:
    def test_review_comes_back_as_added(self, catalog: Catalog) -> None:
        revision = _labelled(catalog)
        review = catalog.add_review(revision.id, _MAP_BACK)
        assert (review.reason, review.detail, review.revision_id) == (
            ReviewReason.MAP_BACK,
            {"agreement": 0.9},
            revision.id,
        )
        assert (review.resolved_at, review.resolved_by, review.outcome) == (None, None, None)
        assert catalog.reviews(revision.shape_id) == [review]
        assert catalog.open_reviews(review.collection_id) == [review]

    def test_an_open_review_of_the_same_reason_stays_the_one(self, catalog: Catalog) -> None:
        revision = _labelled(catalog)
        review = catalog.add_review(revision.id, _MAP_BACK)
        assert catalog.add_review(revision.id, NewReview(ReviewReason.MAP_BACK, {"agreement": 0.1})) == review

    def test_accepted_labels_are_confirmed_again(self, catalog: Catalog) -> None:
        revision = _labelled(catalog)
        review = catalog.add_review(revision.id, _MAP_BACK)
        bob = catalog.add_person("bob")
        accepted = catalog.accept_review(review.id, bob.id)
        assert (accepted.outcome, accepted.resolved_by) == (ReviewOutcome.ACCEPTED, bob.id)
        assert accepted.resolved_at is not None
        assert catalog.open_reviews(review.collection_id) == []
        assert catalog.reviews(revision.shape_id) == [accepted]
        assert catalog.shape_states([revision.shape_id]) == {revision.shape_id: ShapeState.CONFIRMED}
        entry = catalog.audit()[-1]
        assert (entry.actor, entry.subject) == ("bob", f"label_revision {revision.id}")

    def test_a_review_is_resolved_once(self, catalog: Catalog) -> None:
        revision = _labelled(catalog)
        review = catalog.add_review(revision.id, _MAP_BACK)
        catalog.accept_review(review.id, revision.author_id)
        with raises(ConflictError, "accepted"):
            catalog.accept_review(review.id, revision.author_id)

    def test_unknown_reviews_people_and_revisions_are_refused(self, catalog: Catalog) -> None:
        revision = _labelled(catalog)
        review = catalog.add_review(revision.id, _MAP_BACK)
        with raises(NotFoundError, "person", "99"):
            catalog.accept_review(review.id, 99)
        with raises(NotFoundError, "review", "99"):
            catalog.accept_review(99, revision.author_id)
        with raises(NotFoundError, "revision", "99"):
            catalog.add_review(99, _MAP_BACK)

    def test_reference_labels_are_not_reviewed(self, catalog: Catalog) -> None:
        revision = _labelled(catalog, RevisionKind.REFERENCE)
        with raises(LabelError, "reference"):
            catalog.add_review(revision.id, _MAP_BACK)

    def test_labels_that_gave_way_are_not_reviewed(self, catalog: Catalog) -> None:
        revision = _labelled(catalog)
        newer = label(catalog, revision.shape_id)
        with raises(ConflictError, f"gave way to {newer.id}"):
            catalog.add_review(revision.id, _MAP_BACK)

    def test_better_labels_resolve_a_review(self, catalog: Catalog) -> None:
        revision = _labelled(catalog)
        catalog.add_review(revision.id, _MAP_BACK)
        better = label(catalog, revision.shape_id)
        (review,) = catalog.reviews(revision.shape_id)
        assert (review.outcome, review.resolved_by) == (ReviewOutcome.CORRECTED, better.author_id)
        assert catalog.shape_states([revision.shape_id]) == {revision.shape_id: ShapeState.CONFIRMED}

    def test_reference_labels_resolve_nothing(self, catalog: Catalog) -> None:
        revision = _labelled(catalog)
        review = catalog.add_review(revision.id, _MAP_BACK)
        label(catalog, revision.shape_id, RevisionKind.REFERENCE)
        assert catalog.open_reviews(review.collection_id) == [review]

    def test_a_move_ends_the_review_of_an_earlier_move(self, catalog: Catalog) -> None:
        revision = _labelled(catalog)
        catalog.add_review(revision.id, _MAP_BACK)
        publish_mesh(catalog, revision.shape_id, 2)
        move(catalog, revision, 2)
        (review,) = catalog.reviews(revision.shape_id)
        assert (review.outcome, review.resolved_by) == (ReviewOutcome.SUPERSEDED, None)

    def test_a_move_takes_other_reviews_along(self, catalog: Catalog) -> None:
        revision = _labelled(catalog)
        catalog.add_review(revision.id, NewReview(ReviewReason.SCHEMA, {"version": 2}))
        publish_mesh(catalog, revision.shape_id, 2)
        moved = move(catalog, revision, 2, 0.5, _MAP_BACK)
        old, schema, map_back = catalog.reviews(revision.shape_id)
        assert old.outcome is ReviewOutcome.SUPERSEDED
        assert (schema.reason, schema.detail, schema.revision_id) == (ReviewReason.SCHEMA, {"version": 2}, moved.id)
        assert (map_back.reason, map_back.revision_id) == (ReviewReason.MAP_BACK, moved.id)
        assert catalog.open_reviews(schema.collection_id) == [schema, map_back]

    def test_labels_come_with_their_review_or_not_at_all(self, catalog: Catalog) -> None:
        revision = _labelled(catalog, RevisionKind.REFERENCE)
        publish_mesh(catalog, revision.shape_id, 2)
        with raises(LabelError, "reference"):
            move(catalog, revision, 2, 0.5, _MAP_BACK)
        assert catalog.revisions(revision.shape_id) == [revision]

    def test_open_reviews_are_paged(self, catalog: Catalog) -> None:
        collection, ids = add_collection(catalog, 3)
        made = []
        for shape_id in ids:
            publish_mesh(catalog, shape_id)
            made.append(catalog.add_review(label(catalog, shape_id).id, _MAP_BACK))
        first = catalog.open_reviews(collection.id, limit=2)
        assert [*first, *catalog.open_reviews(collection.id, after=first[-1].id)] == made
        assert catalog.count_open_reviews(collection.id) == 3

    def test_open_reviews_of_some_reasons_are_paged_and_counted(self, catalog: Catalog) -> None:
        collection, ids = add_collection(catalog, 4)
        made = []
        for shape_id, reason in zip(ids, (ReviewReason.CHECK, ReviewReason.SCHEMA) * 2, strict=True):
            publish_mesh(catalog, shape_id)
            made.append(catalog.add_review(label(catalog, shape_id).id, NewReview(reason)))
        asked = (ReviewReason.SCHEMA, ReviewReason.REWORK)
        (first,) = catalog.open_reviews(collection.id, limit=1, reasons=asked)
        assert [first, *catalog.open_reviews(collection.id, after=first.id, reasons=asked)] == made[1::2]
        counts = {reason: catalog.count_open_reviews(collection.id, reasons=(reason,)) for reason in ReviewReason}
        assert counts == {reason: sum(each.reason is reason for each in made) for reason in ReviewReason}
        assert catalog.open_reviews(collection.id, reasons=()) == []

    def test_another_part_has_older_labels_looked_at(self, catalog: Catalog) -> None:
        collection, heads = _labelled_shapes(catalog, 2)
        add_collection(catalog, 1, "mugs")
        catalog.add_part(collection.id, "lid")
        found = catalog.open_reviews(collection.id)
        assert [(each.revision_id, each.reason, each.detail) for each in found] == [
            (head.id, ReviewReason.SCHEMA, {"version": 2}) for head in heads
        ]
        assert {row.state for row in catalog.list_shapes(collection.id)} == {ShapeState.REVIEW}
        assert catalog.labelled_shapes(collection.id, leave_out_reviews=True) == []
        event = catalog.events(after=0)[-1]
        assert (event.kind, event.payload) == (EventKind.SHAPE, {"what": "parts changed", "schema_version": 2})

    def test_labels_that_are_right_under_the_present_parts_are_learned_from_again(self, catalog: Catalog) -> None:
        collection, heads = _labelled_shapes(catalog, 2)
        catalog.add_part(collection.id, "lid")
        review = catalog.open_reviews(collection.id)[0]
        catalog.accept_review(review.id, heads[0].author_id)
        assert catalog.labelled_shapes(collection.id, leave_out_reviews=True) == heads[:1]
        states = [row.state for row in catalog.list_shapes(collection.id)]
        assert states == [ShapeState.CONFIRMED, ShapeState.REVIEW]

    def test_one_review_stays_for_all_parts_that_have_changed(self, catalog: Catalog) -> None:
        collection, heads = _labelled_shapes(catalog, 2)
        catalog.add_part(collection.id, "lid")
        first, second = catalog.open_reviews(collection.id)
        catalog.accept_review(first.id, heads[0].author_id)
        catalog.remove_part(collection.id, 3)
        found = [(each.id, each.revision_id, each.detail) for each in catalog.open_reviews(collection.id)]
        assert found[0] == (second.id, heads[1].id, {"version": 3})
        assert [each[1:] for each in found[1:]] == [(heads[0].id, {"version": 3})]

    def test_other_words_and_colours_leave_labels_as_they_are(self, catalog: Catalog) -> None:
        collection, heads = _labelled_shapes(catalog, 1)
        catalog.update_part(collection.id, 1, name="cushion", colour="#000000", gloss="soft", parent_id=2)
        assert catalog.open_reviews(collection.id) == []
        assert catalog.labelled_shapes(collection.id, leave_out_reviews=True) == heads

    def test_reference_labels_are_not_looked_at_when_parts_change(self, catalog: Catalog) -> None:
        collection, _ = _labelled_shapes(catalog, 1, RevisionKind.REFERENCE)
        catalog.add_part(collection.id, "lid")
        assert catalog.open_reviews(collection.id) == []

    def test_labels_of_older_parts_that_come_late_are_looked_at(self, catalog: Catalog) -> None:
        collection, (shape_id,) = add_collection(catalog, 1)
        publish_mesh(catalog, shape_id)
        catalog.add_part(collection.id, "lid")
        late = label(catalog, shape_id)
        (review,) = catalog.open_reviews(collection.id)
        assert (review.revision_id, review.reason, review.detail) == (late.id, ReviewReason.SCHEMA, {"version": 2})

    def test_accepted_labels_are_not_looked_at_again_when_they_move(self, catalog: Catalog) -> None:
        collection, (head,) = _labelled_shapes(catalog, 1)
        catalog.add_part(collection.id, "lid")
        catalog.accept_review(catalog.open_reviews(collection.id)[0].id, head.author_id)
        publish_mesh(catalog, head.shape_id, 2)
        move(catalog, head, 2)
        assert catalog.open_reviews(collection.id) == []

    def test_what_waits_for_one_reason_is_accepted_at_once(self, catalog: Catalog) -> None:
        collection, heads = _labelled_shapes(catalog, 4)
        catalog.update_collection_settings(collection.id, {"train_after": 3})
        check = catalog.add_review(heads[0].id, NewReview(ReviewReason.CHECK))
        catalog.add_part(collection.id, "lid")
        rita = catalog.add_person("rita")
        assert [catalog.accept_reviews(collection.id, ReviewReason.SCHEMA, rita.id, limit=3) for _ in range(3)] == [
            3,
            1,
            0,
        ]
        assert catalog.open_reviews(collection.id) == [check]
        assert catalog.labelled_shapes(collection.id, leave_out_reviews=True) == heads[1:]
        assert [row.state for row in catalog.list_shapes(collection.id)] == [ShapeState.REVIEW] + 3 * [
            ShapeState.CONFIRMED
        ]
        resolved = catalog.reviews(heads[1].shape_id)[0]
        assert (resolved.outcome, resolved.resolved_by) == (ReviewOutcome.ACCEPTED, rita.id)
        assert [job.kind for job in catalog.jobs(collection.id)] == [JobKind.TRAIN]
        entry = catalog.audit()[-1]
        assert (entry.actor, entry.action, entry.detail["n_shapes"]) == ("rita", "accept labels", 1)

    def test_what_was_sent_back_is_not_accepted_at_once(self, catalog: Catalog) -> None:
        collection, (head,) = _labelled_shapes(catalog, 1)
        with raises(ParameterError, "rework"):
            catalog.accept_reviews(collection.id, ReviewReason.REWORK, head.author_id)
        with raises(NotFoundError, "99"):
            catalog.accept_reviews(99, ReviewReason.SCHEMA, head.author_id)
        with raises(NotFoundError, "99"):
            catalog.accept_reviews(collection.id, ReviewReason.SCHEMA, 99)

    def test_labels_without_a_review_are_sent_back(self, catalog: Catalog) -> None:
        collection, (shape_id,) = ready_shapes(catalog, 1)
        head = label(catalog, shape_id)
        rework = catalog.reject_labels(shape_id, head.author_id, " the back is missing ")
        assert (rework.reason, rework.detail["note"]) == (ReviewReason.REWORK, "the back is missing")
        assert [each.reason for each in catalog.reviews(shape_id)] == [ReviewReason.CHECK, ReviewReason.REWORK]
        assert catalog.queue_depth(collection.id).n_free == 1
        with raises(ConflictError, "sent back once"):
            catalog.reject_labels(shape_id, head.author_id, "still")

    def test_a_refused_rejection_leaves_labels_as_they_were(self, catalog: Catalog) -> None:
        collection, (shape_id,) = ready_shapes(catalog, 1)
        with raises(NotFoundError, "no labels"):
            catalog.reject_labels(shape_id, catalog.add_person("ann").id, "no")
        head = label(catalog, shape_id)
        before = catalog.event_bounds()
        with raises(ParameterError, "note"):
            catalog.reject_labels(shape_id, head.author_id, "  ")
        with raises(NotFoundError, "99"):
            catalog.reject_labels(99, head.author_id, "no")
        assert (catalog.reviews(shape_id), catalog.event_bounds()) == ([], before)
        catalog.claim_shape(shape_id, head.author_id, 60)
        with raises(ConflictError, "works on shape"):
            catalog.reject_labels(shape_id, head.author_id, "no")
        assert catalog.reviews(shape_id) == []
        assert catalog.labelled_shapes(collection.id, leave_out_reviews=True) == [head]


def _labelled_shapes(
    catalog: Catalog, n_shapes: int, kind: RevisionKind = RevisionKind.HUMAN
) -> tuple[Collection, list[LabelRevision]]:
    """A collection whose shapes are all labelled, and their labels."""
    collection, shape_ids = add_collection(catalog, n_shapes)
    for shape_id in shape_ids:
        publish_mesh(catalog, shape_id)
    return collection, [label(catalog, shape_id, kind) for shape_id in shape_ids]
