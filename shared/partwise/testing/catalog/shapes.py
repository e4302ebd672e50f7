"""Conformance: shapes, their states, their meshes."""
# ruff: noqa: S101 # a test suite asserts

from partwise.errors import ConflictError, NotFoundError, ParameterError
from partwise.store.catalog import Catalog
from partwise.store.records import (
    IngestOutcome,
    MeshRole,
    NewFailure,
    NewMesh,
    NewShape,
    NewStageRun,
    RevisionKind,
    ShapeState,
)
from partwise.store.reviews import NewReview, ReviewReason
from partwise.testing.catalog.samples import (
    N_FACES,
    add_collection,
    label,
    mesh_hash,
    new_block,
    publish,
    publish_mesh,
)
from partwise.testing.expect import raises


class ShapeConformance:
    def test_ingesting_again_changes_nothing(self, catalog: Catalog) -> None:
        collection, ids = add_collection(catalog, 3)
        before = catalog.shapes(collection.id)
        again = catalog.add_shapes(collection.id, [NewShape(f"{i}.off", f"source{i}", ".off") for i in range(3)])
        assert [each.outcome for each in again] == [IngestOutcome.UNCHANGED] * 3
        assert [each.shape_id for each in again] == ids
        assert catalog.shapes(collection.id) == before

    def test_changed_source_keeps_its_id(self, catalog: Catalog) -> None:
        collection, (shape_id,) = add_collection(catalog, 1)
        (changed,) = catalog.add_shapes(collection.id, [NewShape("0.off", "other", ".off")])
        assert (changed.shape_id, changed.outcome, changed.previous_hash) == (
            shape_id,
            IngestOutcome.CHANGED,
            "source0",
        )
        assert catalog.shape(shape_id).source_hash == "other"

    def test_changed_source_of_a_labelled_shape_is_a_conflict(self, catalog: Catalog) -> None:
        collection, ids = add_collection(catalog, len(RevisionKind))
        for number, (shape_id, kind) in enumerate(zip(ids, RevisionKind, strict=True)):
            publish_mesh(catalog, shape_id)
            label(catalog, shape_id, kind=kind)
            (conflict,) = catalog.add_shapes(collection.id, [NewShape(f"{number}.off", "other", ".off")])
            assert conflict.outcome == IngestOutcome.CONFLICT
            assert catalog.shape(shape_id).source_hash == f"source{number}"

    def test_same_key_twice_in_a_batch_adds_nothing(self, catalog: Catalog) -> None:
        collection, _ = add_collection(catalog, 0)
        with raises(ParameterError, "a.off"):
            catalog.add_shapes(collection.id, [NewShape("a.off", "1", ".off"), NewShape("a.off", "2", ".off")])
        assert catalog.shapes(collection.id) == []

    def test_same_key_in_two_collections_is_two_shapes(self, catalog: Catalog) -> None:
        _, (first,) = add_collection(catalog, 1, "chairs")
        second_collection, (second,) = add_collection(catalog, 1, "mugs")
        assert first != second
        assert catalog.shape_by_key(second_collection.id, "0.off").id == second

    def test_pages_cover_every_shape_once(self, catalog: Catalog) -> None:
        collection, ids = add_collection(catalog, 5)
        add_collection(catalog, 2, "mugs")
        seen: list[int] = []
        while page := catalog.shapes(collection.id, after=seen[-1] if seen else 0, limit=2):
            seen += [shape.id for shape in page]
        assert seen == sorted(ids)

    def test_many_shapes_go_in_at_once(self, catalog: Catalog) -> None:
        collection, ids = add_collection(catalog, 12_000)
        assert len(set(ids)) == 12_000
        assert len(catalog.shapes_by_id(ids)) == 12_000
        assert catalog.state_counts(collection.id)[ShapeState.NEW] == 12_000

    def test_unknown_shape_is_refused(self, catalog: Catalog) -> None:
        collection, _ = add_collection(catalog, 1)
        with raises(NotFoundError, "99"):
            catalog.shape(99)
        with raises(NotFoundError, "z.off"):
            catalog.shape_by_key(collection.id, "z.off")

    def test_unknown_ids_are_left_out_of_mappings(self, catalog: Catalog) -> None:
        _, (shape_id,) = add_collection(catalog, 1)
        assert set(catalog.shapes_by_id([shape_id, 99])) == {shape_id}
        assert set(catalog.shape_states([shape_id, 99])) == {shape_id}

    def test_states_follow_the_work(self, catalog: Catalog) -> None:
        collection, (new, failed, ready, in_review, confirmed) = add_collection(catalog, 5)
        catalog.record_failure(NewFailure(failed, "describe", "k1", "no faces"))
        publish(catalog, [ready])
        for shape_id in (in_review, confirmed):
            publish_mesh(catalog, shape_id)
            label(catalog, shape_id)
        catalog.add_review(label(catalog, in_review).id, NewReview(ReviewReason.MAP_BACK))
        expected = {
            new: ShapeState.NEW,
            failed: ShapeState.FAILED,
            ready: ShapeState.READY,
            in_review: ShapeState.REVIEW,
            confirmed: ShapeState.CONFIRMED,
        }
        assert catalog.shape_states(expected) == expected
        assert catalog.state_counts(collection.id) == dict.fromkeys(ShapeState, 1)
        for shape_id, state in expected.items():
            assert [shape.id for shape in catalog.shapes(collection.id, state=state)] == [shape_id]

    def test_imported_labels_confirm_and_reference_labels_do_not(self, catalog: Catalog) -> None:
        _, (imported, reference) = add_collection(catalog, 2)
        for shape_id, kind in ((imported, RevisionKind.IMPORTED), (reference, RevisionKind.REFERENCE)):
            publish_mesh(catalog, shape_id)
            label(catalog, shape_id, kind)
        assert catalog.shape_states([imported, reference]) == {
            imported: ShapeState.CONFIRMED,
            reference: ShapeState.NEW,
        }

    def test_a_ready_shape_stays_ready_when_a_later_stage_fails(self, catalog: Catalog) -> None:
        _, (shape_id,) = add_collection(catalog, 1)
        publish(catalog, [shape_id])
        catalog.record_failure(NewFailure(shape_id, "evaluate", "k1", "out of memory"))
        assert catalog.shape_states([shape_id]) == {shape_id: ShapeState.READY}

    def test_mesh_says_where_it_lies(self, catalog: Catalog) -> None:
        _, (shape_id,) = add_collection(catalog, 1)
        block_name = publish_mesh(catalog, shape_id)
        mesh = catalog.mesh(shape_id, mesh_hash(shape_id))
        assert (mesh.block_name, mesh.row, mesh.n_faces, mesh.kept_key) == (block_name, 0, N_FACES, None)

    def test_original_and_working_mesh_are_told_apart(self, catalog: Catalog) -> None:
        _, (shape_id, other) = add_collection(catalog, 2)
        publish_mesh(catalog, shape_id, 1, MeshRole.ORIGINAL)
        assert catalog.meshes([shape_id]) == {}
        publish_mesh(catalog, shape_id, 2)
        assert catalog.original_meshes([shape_id, other])[shape_id].mesh_hash == mesh_hash(shape_id, 1)
        assert set(catalog.original_meshes([shape_id, other])) == {shape_id}
        shape = catalog.shape(shape_id)
        assert (shape.original_mesh_hash, shape.mesh_hash) == (mesh_hash(shape_id, 1), mesh_hash(shape_id, 2))

    def test_one_mesh_may_be_original_and_working(self, catalog: Catalog) -> None:
        _, (shape_id,) = add_collection(catalog, 1)
        block_name = publish_mesh(catalog, shape_id, 1, MeshRole.ORIGINAL)
        publish_mesh(catalog, shape_id, 1)
        for found in (catalog.meshes([shape_id]), catalog.original_meshes([shape_id])):
            assert (found[shape_id].mesh_hash, found[shape_id].block_name) == (mesh_hash(shape_id), block_name)

    def test_an_original_taken_as_it_is_outlives_the_block_of_the_working_mesh(self, catalog: Catalog) -> None:
        _, (shape_id,) = add_collection(catalog, 1)
        original = publish_mesh(catalog, shape_id, 1, MeshRole.ORIGINAL)
        working = new_block(1, "remesh")
        runs = [NewStageRun(shape_id, "remesh", "k1", 0)]
        same = NewMesh(shape_id, mesh_hash(shape_id), 5, N_FACES, 0, MeshRole.WORKING)
        catalog.publish_block(working, runs, meshes=[same])
        catalog.supersede_block(working.name)
        catalog.delete_blocks([working.name])
        assert catalog.original_meshes([shape_id])[shape_id].block_name == original

    def test_newest_mesh_is_the_one_published_last(self, catalog: Catalog) -> None:
        _, (shape_id, other) = add_collection(catalog, 2)
        for version in (1, 2, 1):
            publish_mesh(catalog, shape_id, version)
        assert catalog.meshes([shape_id, other])[shape_id].mesh_hash == mesh_hash(shape_id, 1)
        assert set(catalog.meshes([shape_id, other])) == {shape_id}

    def test_one_mesh_may_belong_to_two_shapes(self, catalog: Catalog) -> None:
        _, ids = add_collection(catalog, 2)
        runs = [NewStageRun(shape_id, "mesh", "k1", row) for row, shape_id in enumerate(ids)]
        meshes = [NewMesh(shape_id, "a" * 64, 5, N_FACES, row) for row, shape_id in enumerate(ids)]
        catalog.publish_block(new_block(2), runs, meshes=meshes)
        assert [catalog.mesh(shape_id, "a" * 64).row for shape_id in ids] == [0, 1]

    def test_one_hash_with_two_sizes_is_refused(self, catalog: Catalog) -> None:
        _, (shape_id,) = add_collection(catalog, 1)
        publish_mesh(catalog, shape_id)
        with raises(ConflictError, "faces"):
            catalog.publish_block(new_block(1), [], meshes=[NewMesh(shape_id, mesh_hash(shape_id), 5, N_FACES + 1, 0)])

    def test_unknown_mesh_is_refused(self, catalog: Catalog) -> None:
        _, (shape_id,) = add_collection(catalog, 1)
        with raises(NotFoundError, "mesh"):
            catalog.mesh(shape_id, "b" * 64)
        with raises(NotFoundError, "mesh"):
            catalog.keep_mesh("b" * 64, "kept/meshes/b")

    def test_kept_mesh_says_so(self, catalog: Catalog) -> None:
        _, (shape_id,) = add_collection(catalog, 1)
        publish_mesh(catalog, shape_id)
        catalog.keep_mesh(mesh_hash(shape_id), "kept/meshes/x")
        assert catalog.mesh(shape_id, mesh_hash(shape_id)).kept_key == "kept/meshes/x"
