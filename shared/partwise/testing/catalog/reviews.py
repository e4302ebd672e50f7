"""Conformance: reviews of labels."""
# ruff: noqa: S101 # a test suite asserts

from partwise.errors import ConflictError, LabelError, NotFoundError
from partwise.store.catalog import Catalog
from partwise.store.records import LabelRevision, RevisionKind, ShapeState
from partwise.store.reviews import NewReview, ReviewOutcome, ReviewReason
from partwise.testing.catalog.samples import add_collection, label, move, publish_mesh
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
