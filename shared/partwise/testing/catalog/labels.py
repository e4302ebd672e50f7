"""Conformance: label revisions."""
# ruff: noqa: S101 # a test suite asserts

import dataclasses

import numpy as np

from partwise.errors import ConflictError, LabelError, NotFoundError
from partwise.store.catalog import Catalog
from partwise.store.records import NewRevision, RevisionKind
from partwise.store.reviews import NewReview, ReviewReason, RevisionOrigin
from partwise.testing.catalog.samples import N_FACES, add_collection, label, mesh_hash, move, publish_mesh
from partwise.testing.expect import raises


def _revision(catalog: Catalog, **changes: object) -> NewRevision:
    """A revision that would be accepted, of the first shape of a new collection, with some fields replaced."""
    _, (shape_id, _) = add_collection(catalog, 2)
    publish_mesh(catalog, shape_id)
    author = catalog.add_person("ann")
    good = NewRevision(shape_id, mesh_hash(shape_id), RevisionKind.HUMAN, author.id, 1, np.zeros(N_FACES, np.int64))
    return dataclasses.replace(good, **changes)  # type: ignore[arg-type]  # fields by name


class LabelConformance:
    def test_labels_come_back_as_committed(self, catalog: Catalog) -> None:
        labels = np.array([0, 1, 2, 2, 1, 0])
        committed = catalog.add_revision(_revision(catalog, labels=labels))
        found = catalog.labels(committed.id)
        assert found.dtype == np.uint16
        np.testing.assert_array_equal(found, labels)
        assert catalog.revision(committed.id) == committed
        assert (committed.n_faces, committed.kind) == (N_FACES, RevisionKind.HUMAN)

    def test_committing_leaves_an_audit_entry(self, catalog: Catalog) -> None:
        committed = catalog.add_revision(_revision(catalog))
        (entry,) = catalog.audit()
        assert (entry.actor, entry.action, entry.subject) == ("ann", "label", f"label_revision {committed.id}")

    def test_a_refused_revision_leaves_nothing(self, catalog: Catalog) -> None:
        revision = _revision(catalog, labels=np.full(N_FACES, 9))
        with raises(LabelError, "9"):
            catalog.add_revision(revision)
        assert catalog.revisions(revision.shape_id) == []
        assert catalog.audit() == []

    def test_wrong_number_of_labels_is_refused(self, catalog: Catalog) -> None:
        with raises(LabelError, "5 labels", "6 faces"):
            catalog.add_revision(_revision(catalog, labels=np.zeros(5, np.int64)))

    def test_labels_that_are_not_whole_numbers_are_refused(self, catalog: Catalog) -> None:
        with raises(LabelError, "float64"):
            catalog.add_revision(_revision(catalog, labels=np.zeros(N_FACES)))

    def test_a_mesh_the_shape_does_not_have_is_refused(self, catalog: Catalog) -> None:
        with raises(LabelError, "mesh"):
            catalog.add_revision(_revision(catalog, mesh_hash="f" * 64))

    def test_a_mesh_of_another_shape_is_refused(self, catalog: Catalog) -> None:
        revision = _revision(catalog)
        with raises(LabelError, "mesh"):
            catalog.add_revision(dataclasses.replace(revision, shape_id=revision.shape_id + 1))

    def test_an_unknown_schema_version_is_refused(self, catalog: Catalog) -> None:
        with raises(LabelError, "version", "2"):
            catalog.add_revision(_revision(catalog, schema_version=2))

    def test_an_unknown_author_is_refused(self, catalog: Catalog) -> None:
        with raises(NotFoundError, "person", "99"):
            catalog.add_revision(_revision(catalog, author_id=99))

    def test_an_unknown_shape_is_refused(self, catalog: Catalog) -> None:
        with raises(NotFoundError, "shape", "99"):
            catalog.add_revision(_revision(catalog, shape_id=99))

    def test_an_unknown_parent_is_refused(self, catalog: Catalog) -> None:
        with raises(LabelError, "parent", "99"):
            catalog.add_revision(_revision(catalog, parent_id=99))

    def test_a_parent_of_another_shape_is_refused(self, catalog: Catalog) -> None:
        revision = _revision(catalog)
        publish_mesh(catalog, revision.shape_id + 1)
        other = label(catalog, revision.shape_id + 1)
        with raises(LabelError, "parent", f"shape {other.shape_id}"):
            catalog.add_revision(dataclasses.replace(revision, parent_id=other.id))

    def test_labels_follow_the_version_they_name(self, catalog: Catalog) -> None:
        revision = _revision(catalog, labels=np.full(N_FACES, 1))
        collection = catalog.get_collection("chairs")
        catalog.add_part(collection.id, "leg")
        assert catalog.add_revision(revision).schema_version == 1
        with raises(LabelError, "3"):
            catalog.add_revision(dataclasses.replace(revision, labels=np.full(N_FACES, 3)))

    def test_no_labels_come_in_with_a_part_that_is_gone(self, catalog: Catalog) -> None:
        revision = _revision(catalog, labels=np.full(N_FACES, 2))
        catalog.remove_part(catalog.get_collection("chairs").id, 2)
        with raises(LabelError, "part id 2", "schema version 2"):
            catalog.add_revision(revision)
        assert catalog.add_revision(dataclasses.replace(revision, kind=RevisionKind.REFERENCE)).schema_version == 1

    def test_revisions_are_listed_oldest_first(self, catalog: Catalog) -> None:
        revision = _revision(catalog)
        first = catalog.add_revision(revision)
        second = catalog.add_revision(dataclasses.replace(revision, parent_id=first.id))
        assert catalog.revisions(revision.shape_id) == [first, second]

    def test_head_is_the_newest_of_its_kinds(self, catalog: Catalog) -> None:
        revision = _revision(catalog)
        catalog.add_revision(revision)
        human = catalog.add_revision(revision)
        reference = catalog.add_revision(dataclasses.replace(revision, kind=RevisionKind.REFERENCE))
        assert catalog.head_revision(revision.shape_id) == human
        assert catalog.head_revision(revision.shape_id, [RevisionKind.REFERENCE]) == reference
        assert catalog.head_revisions([revision.shape_id, revision.shape_id + 1]) == {revision.shape_id: human}
        assert catalog.head_revision(revision.shape_id + 1) is None

    def test_labelled_shapes_are_paged_heads(self, catalog: Catalog) -> None:
        collection, ids = add_collection(catalog, 4)
        mugs, (mug,) = add_collection(catalog, 1, "mugs")
        for shape_id in [*ids[:3], mug]:
            publish_mesh(catalog, shape_id)
            label(catalog, shape_id)
        heads = [label(catalog, shape_id).id for shape_id in ids[:3]]
        first = catalog.labelled_shapes(collection.id, limit=2)
        rest = catalog.labelled_shapes(collection.id, after=first[-1].shape_id)
        assert [revision.id for revision in [*first, *rest]] == heads
        assert [revision.shape_id for revision in catalog.labelled_shapes(mugs.id)] == [mug]

    def test_reference_labels_are_labelled_shapes_only_when_asked_for(self, catalog: Catalog) -> None:
        collection, (shape_id,) = add_collection(catalog, 1)
        publish_mesh(catalog, shape_id)
        label(catalog, shape_id, RevisionKind.REFERENCE)
        assert catalog.labelled_shapes(collection.id) == []
        assert len(catalog.labelled_shapes(collection.id, kinds=[RevisionKind.REFERENCE])) == 1

    def test_labels_of_shapes_in_review_are_left_out_when_asked(self, catalog: Catalog) -> None:
        collection, ids = add_collection(catalog, 2)
        for shape_id in ids:
            publish_mesh(catalog, shape_id)
        heads = [label(catalog, shape_id) for shape_id in ids]
        catalog.add_review(heads[0].id, NewReview(ReviewReason.MAP_BACK))
        assert catalog.labelled_shapes(collection.id) == heads
        assert catalog.labelled_shapes(collection.id, leave_out_reviews=True) == heads[1:]

    def test_a_part_in_use_is_not_removed(self, catalog: Catalog) -> None:
        collection, ids = add_collection(catalog, 3)
        for shape_id in ids:
            publish_mesh(catalog, shape_id)
        for shape_id in ids[:2]:
            label(catalog, shape_id, labels=(1, 1, 2, 2, 0, 0))
        label(catalog, ids[2], RevisionKind.IMPORTED, (1,) * N_FACES)
        with raises(ConflictError, "back", "2 shapes"):
            catalog.remove_part(collection.id, 2)
        label(catalog, ids[0], labels=(1,) * N_FACES)
        with raises(ConflictError, "back", "1 shape;"):
            catalog.remove_part(collection.id, 2)
        label(catalog, ids[1], RevisionKind.IMPORTED, (0,) * N_FACES)
        assert catalog.remove_part(collection.id, 2).ids == (1,)

    def test_reference_labels_do_not_hold_a_part(self, catalog: Catalog) -> None:
        collection, (shape_id,) = add_collection(catalog, 1)
        publish_mesh(catalog, shape_id)
        label(catalog, shape_id, RevisionKind.REFERENCE)
        assert catalog.remove_part(collection.id, 2).ids == (1,)

    def test_another_collections_labels_do_not_hold_a_part(self, catalog: Catalog) -> None:
        collection, _ = add_collection(catalog, 0, "chairs")
        _, (mug,) = add_collection(catalog, 1, "mugs")
        publish_mesh(catalog, mug)
        label(catalog, mug)
        assert catalog.remove_part(collection.id, 2).ids == (1,)

    def test_moved_labels_say_where_they_came_from(self, catalog: Catalog) -> None:
        _, (shape_id,) = add_collection(catalog, 1)
        publish_mesh(catalog, shape_id, 1)
        first = label(catalog, shape_id)
        publish_mesh(catalog, shape_id, 2)
        moved = move(catalog, first, 2, 0.99)
        assert moved.origin == RevisionOrigin(mesh_hash(shape_id, 1), first.id, 0.99)
        assert catalog.revision(moved.id) == moved
        assert (first.origin, catalog.revision(first.id)) == (None, first)
        assert (moved.parent_id, moved.author_id, moved.kind) == (first.id, first.author_id, first.kind)

    def test_moved_labels_never_hide_newer_ones(self, catalog: Catalog) -> None:
        _, (shape_id,) = add_collection(catalog, 1)
        publish_mesh(catalog, shape_id, 1)
        first = label(catalog, shape_id)
        publish_mesh(catalog, shape_id, 2)
        newest = label(catalog, shape_id)
        with raises(ConflictError, f"revision {newest.id}"):
            move(catalog, first, 2)
        assert catalog.head_revision(shape_id) == newest

    def test_moved_labels_are_the_machines_doing_on_the_audit_trail(self, catalog: Catalog) -> None:
        _, (shape_id,) = add_collection(catalog, 1)
        publish_mesh(catalog, shape_id, 1)
        first = label(catalog, shape_id)
        publish_mesh(catalog, shape_id, 2)
        moved = move(catalog, first, 2, 0.99)
        entry = catalog.audit()[-1]
        assert (entry.actor, entry.action, entry.subject) == ("partwise", "move labels", f"label_revision {moved.id}")
        assert (entry.detail["source_id"], entry.detail["agreement"]) == (first.id, 0.99)

    def test_an_unknown_revision_is_refused(self, catalog: Catalog) -> None:
        for ask in (catalog.revision, catalog.labels):
            with raises(NotFoundError, "99"):
                ask(99)
