"""Conformance: stage runs and blocks."""
# ruff: noqa: S101 # a test suite asserts

import math

from partwise.errors import ConflictError, NotFoundError, ParameterError
from partwise.store.catalog import Catalog
from partwise.store.records import FailureKind, NewFailure, NewScore, NewStageRun, RunStatus, StageCount
from partwise.testing.catalog.samples import (
    add_collection,
    label,
    mesh_hash,
    new_block,
    publish,
    publish_mesh,
    save_model,
)
from partwise.testing.expect import raises


class StageConformance:
    def test_published_run_comes_back(self, catalog: Catalog) -> None:
        _, (shape_id, other) = add_collection(catalog, 2)
        block = new_block(2)
        run = NewStageRun(shape_id, "describe", "k1", 1, attempts=2, seconds=1.5, summary={"faces": 10})
        block_id = catalog.publish_block(block, [run])
        runs = catalog.stage_runs([shape_id, other], "describe")
        assert set(runs) == {shape_id}
        found = runs[shape_id]
        assert (found.status, found.block_id, found.block_name, found.row) == (RunStatus.DONE, block_id, block.name, 1)
        assert (found.key, found.attempts, found.seconds, found.summary) == ("k1", 2, 1.5, {"faces": 10})

    def test_published_block_is_visible(self, catalog: Catalog) -> None:
        _, ids = add_collection(catalog, 1)
        name = publish(catalog, ids)
        assert [block.name for block in catalog.visible_blocks()] == [name]
        assert catalog.block(name).n_shapes == 1

    def test_blocks_are_paged(self, catalog: Catalog) -> None:
        _, ids = add_collection(catalog, 3)
        names = [publish(catalog, [shape_id]) for shape_id in ids]
        first = catalog.visible_blocks(limit=2)
        rest = catalog.visible_blocks(after=first[-1].id)
        assert [block.name for block in [*first, *rest]] == names

    def test_unknown_block_is_refused(self, catalog: Catalog) -> None:
        with raises(NotFoundError, "blocks/x/y"):
            catalog.block("blocks/x/y")

    def test_a_block_is_published_once(self, catalog: Catalog) -> None:
        _, (shape_id,) = add_collection(catalog, 1)
        block = new_block(1)
        catalog.publish_block(block, [NewStageRun(shape_id, "describe", "k1", 0)])
        with raises(ConflictError, block.name):
            catalog.publish_block(block, [NewStageRun(shape_id, "describe", "k2", 0)])
        assert catalog.stage_runs([shape_id], "describe")[shape_id].key == "k1"

    def test_a_row_outside_the_block_is_refused(self, catalog: Catalog) -> None:
        _, (shape_id,) = add_collection(catalog, 1)
        for row in (1, -1, None):
            with raises(ParameterError, "row"):
                catalog.publish_block(new_block(1), [NewStageRun(shape_id, "describe", "k1", row)])
        assert catalog.visible_blocks() == []

    def test_a_publication_that_fails_leaves_nothing(self, catalog: Catalog) -> None:
        _, (shape_id,) = add_collection(catalog, 1)
        runs = [NewStageRun(shape_id, "describe", "k1", 0), NewStageRun(99, "describe", "k1", 1)]
        with raises(NotFoundError, "99"):
            catalog.publish_block(new_block(2), runs)
        assert catalog.visible_blocks() == []
        assert catalog.stage_runs([shape_id], "describe") == {}

    def test_two_runs_of_a_stage_for_a_shape_at_once_are_refused(self, catalog: Catalog) -> None:
        _, (shape_id,) = add_collection(catalog, 1)
        with raises(ParameterError, "one run"):
            catalog.record_done([NewStageRun(shape_id, "check", "k1"), NewStageRun(shape_id, "check", "k2")])

    def test_a_new_key_supersedes_the_old_run(self, catalog: Catalog) -> None:
        _, ids = add_collection(catalog, 1)
        old = publish(catalog, ids, key="k1")
        new = publish(catalog, ids, key="k2")
        assert catalog.stage_runs(ids, "describe")[ids[0]].block_name == new
        assert [block.name for block in catalog.unused_blocks()] == [old]

    def test_a_return_to_an_earlier_key_makes_it_current_again(self, catalog: Catalog) -> None:
        _, ids = add_collection(catalog, 1)
        for key in ("k1", "k2"):
            publish(catalog, ids, key=key)
        back = publish(catalog, ids, key="k1")
        current = catalog.stage_runs(ids, "describe")[ids[0]]
        assert (current.key, current.block_name, current.is_superseded) == ("k1", back, False)

    def test_the_runs_of_a_lost_block_are_current_no_more(self, catalog: Catalog) -> None:
        _, ids = add_collection(catalog, 2)
        lost, whole = publish(catalog, ids[:1]), publish(catalog, ids[1:])
        assert catalog.supersede_block(lost) == 1
        assert catalog.stage_runs(ids, "describe").keys() == {ids[1]}
        assert [block.name for block in catalog.unused_blocks()] == [lost]
        assert catalog.block(whole).name == whole

    def test_an_unknown_block_cannot_be_lost(self, catalog: Catalog) -> None:
        with raises(NotFoundError, "nowhere"):
            catalog.supersede_block("nowhere")

    def test_a_block_is_used_while_any_of_its_shapes_needs_it(self, catalog: Catalog) -> None:
        _, ids = add_collection(catalog, 2)
        publish(catalog, ids, key="k1")
        publish(catalog, ids[:1], key="k2")
        assert catalog.unused_blocks() == []

    def test_stages_do_not_supersede_each_other(self, catalog: Catalog) -> None:
        _, ids = add_collection(catalog, 1)
        publish(catalog, ids, "describe")
        publish(catalog, ids, "evaluate")
        assert catalog.unused_blocks() == []

    def test_a_stage_without_arrays_is_recorded(self, catalog: Catalog) -> None:
        _, (shape_id,) = add_collection(catalog, 1)
        catalog.record_done([NewStageRun(shape_id, "check", "k1", summary={"components": 1})])
        run = catalog.stage_runs([shape_id], "check")[shape_id]
        assert (run.block_name, run.row, run.summary) == (None, None, {"components": 1})

    def test_failure_keeps_its_reason(self, catalog: Catalog) -> None:
        collection, (shape_id,) = add_collection(catalog, 1)
        catalog.record_failure(NewFailure(shape_id, "describe", "k1", "no faces", 3, 0.5, {"log": "…"}))
        (failure,) = catalog.failures(collection.id)
        run = failure.run
        assert (failure.source_key, run.stage, run.reason, run.attempts) == ("0.off", "describe", "no faces", 3)
        assert (run.status, run.seconds, run.summary) == (RunStatus.FAILED, 0.5, {"log": "…"})
        assert catalog.failed_runs([shape_id], "describe") == {shape_id: run}

    def test_failing_again_replaces_the_reason(self, catalog: Catalog) -> None:
        collection, (shape_id,) = add_collection(catalog, 1)
        for reason in ("crashed", "hung"):
            catalog.record_failure(NewFailure(shape_id, "describe", "k1", reason))
        assert [failure.run.reason for failure in catalog.failures(collection.id)] == ["hung"]

    def test_failing_under_other_parameters_replaces_the_failure_too(self, catalog: Catalog) -> None:
        collection, ids = add_collection(catalog, 2)
        for key in ("k1", "k2"):
            catalog.record_failure(NewFailure(ids[0], "describe", key, "crashed"))
            catalog.record_failure(NewFailure(ids[1], "remesh", "k1", "hung"))
        found = [(failure.run.shape_id, failure.run.key) for failure in catalog.failures(collection.id)]
        assert sorted(found) == [(ids[0], "k2"), (ids[1], "k1")]

    def test_failure_never_displaces_a_done_run(self, catalog: Catalog) -> None:
        _, ids = add_collection(catalog, 1)
        publish(catalog, ids, key="k1")
        before = catalog.stage_runs(ids, "describe")
        for key in ("k1", "k2"):
            catalog.record_failure(NewFailure(ids[0], "describe", key, "crashed"))
        assert catalog.stage_runs(ids, "describe") == before

    def test_failure_under_a_superseded_key_is_recorded(self, catalog: Catalog) -> None:
        _, ids = add_collection(catalog, 1)
        for key in ("k1", "k2"):
            publish(catalog, ids, key=key)
        catalog.record_failure(NewFailure(ids[0], "describe", "k1", "crashed"))
        assert catalog.failed_runs(ids, "describe")[ids[0]].key == "k1"
        assert catalog.stage_runs(ids, "describe")[ids[0]].key == "k2"

    def test_success_clears_failures_of_its_stage_only(self, catalog: Catalog) -> None:
        collection, ids = add_collection(catalog, 1)
        for stage in ("describe", "evaluate"):
            catalog.record_failure(NewFailure(ids[0], stage, "k1", "crashed"))
        publish(catalog, ids, "describe", "k2")
        assert [failure.run.stage for failure in catalog.failures(collection.id)] == ["evaluate"]

    def test_failures_are_paged_and_filtered_by_stage(self, catalog: Catalog) -> None:
        collection, ids = add_collection(catalog, 3)
        for shape_id in ids:
            catalog.record_failure(NewFailure(shape_id, "describe", "k1", "crashed"))
        catalog.record_failure(NewFailure(ids[0], "check", "k1", "open"))
        first = catalog.failures(collection.id, stage="describe", limit=2)
        rest = catalog.failures(collection.id, stage="describe", after=first[-1].run.id)
        assert [failure.run.shape_id for failure in [*first, *rest]] == ids

    def test_cleared_failures_are_forgotten(self, catalog: Catalog) -> None:
        collection, ids = add_collection(catalog, 3)
        for shape_id in ids:
            catalog.record_failure(NewFailure(shape_id, "describe", "k1", "crashed"))
        assert catalog.clear_failures(collection.id, shape_ids=ids[:1]) == 1
        assert catalog.clear_failures(collection.id, stage="check") == 0
        assert catalog.clear_failures(collection.id) == 2
        assert catalog.failures(collection.id) == []

    def test_failures_are_cleared_by_kind(self, catalog: Catalog) -> None:
        collection, ids = add_collection(catalog, 3)
        for shape_id, detail in zip(ids, ({"kind": "memory"}, {"kind": "crash"}, {}), strict=True):
            catalog.record_failure(NewFailure(shape_id, "describe", "k1", "too much memory", detail=detail))
        assert catalog.clear_failures(collection.id, kind=FailureKind.DEADLINE) == 0
        assert catalog.clear_failures(collection.id, kind=FailureKind.MEMORY, reason_contains="slow") == 0
        assert catalog.clear_failures(collection.id, kind=FailureKind.MEMORY, reason_contains="much") == 1
        assert {failure.run.shape_id for failure in catalog.failures(collection.id)} == set(ids[1:])

    def test_failures_are_cleared_by_what_their_reason_says(self, catalog: Catalog) -> None:
        collection, ids = add_collection(catalog, 2)
        for shape_id, reason in zip(ids, ("Lost 50% of it", "50 faces_left"), strict=True):
            catalog.record_failure(NewFailure(shape_id, "describe", "k1", reason))
        assert catalog.clear_failures(collection.id, reason_contains="0_") == 0  # no wildcards
        assert catalog.clear_failures(collection.id, reason_contains="lost 50% OF") == 1
        assert [failure.run.shape_id for failure in catalog.failures(collection.id)] == ids[1:]

    def test_failure_of_an_unknown_shape_is_refused(self, catalog: Catalog) -> None:
        with raises(NotFoundError, "99"):
            catalog.record_failure(NewFailure(99, "describe", "k1", "crashed"))

    def test_stages_are_counted(self, catalog: Catalog) -> None:
        collection, ids = add_collection(catalog, 3)
        publish(catalog, ids[:2], key="k1")
        publish(catalog, ids[:1], key="k2")
        for key in ("k1", "k2"):
            catalog.record_failure(NewFailure(ids[2], "describe", key, "crashed"))
        assert catalog.stage_counts(collection.id) == [StageCount("describe", n_done=2, n_failed=1)]

    def test_scores_become_visible_with_their_block(self, catalog: Catalog) -> None:
        collection, (shape_id,) = add_collection(catalog, 1)
        model = save_model(catalog, collection.id)
        runs = [NewStageRun(shape_id, "evaluate", "k1", 0)]
        catalog.publish_block(new_block(1), runs, [NewScore(shape_id, model.id, "entropy", 0.25)])
        score = catalog.scores([shape_id], "entropy")[shape_id]
        assert (score.value, score.model_id) == (0.25, model.id)

    def test_a_late_score_of_an_older_model_is_ignored(self, catalog: Catalog) -> None:
        collection, (shape_id,) = add_collection(catalog, 1)
        older, newer = (save_model(catalog, collection.id) for _ in range(2))
        catalog.record_done([], [NewScore(shape_id, newer.id, "entropy", 0.1)])
        catalog.record_done([], [NewScore(shape_id, older.id, "entropy", 0.9)])
        assert catalog.scores([shape_id], "entropy")[shape_id].value == 0.1

    def test_a_score_that_is_not_finite_is_refused(self, catalog: Catalog) -> None:
        collection, (shape_id,) = add_collection(catalog, 1)
        model = save_model(catalog, collection.id)
        for value in (math.nan, math.inf):
            with raises(ParameterError, "finite"):
                catalog.record_done([], [NewScore(shape_id, model.id, "entropy", value)])

    def test_a_score_of_an_unknown_or_foreign_model_is_refused(self, catalog: Catalog) -> None:
        _, (shape_id,) = add_collection(catalog, 1)
        mugs, _ = add_collection(catalog, 1, "mugs")
        with raises(NotFoundError, "99"):
            catalog.record_done([], [NewScore(shape_id, 99, "entropy", 0.5)])
        with raises(ParameterError, "own collection"):
            catalog.record_done([], [NewScore(shape_id, save_model(catalog, mugs.id).id, "entropy", 0.5)])

    def test_deleted_blocks_are_forgotten(self, catalog: Catalog) -> None:
        _, ids = add_collection(catalog, 1)
        old = publish(catalog, ids, key="k1")
        new = publish(catalog, ids, key="k2")
        catalog.delete_blocks([old])
        catalog.delete_blocks([old])
        assert [block.name for block in catalog.visible_blocks()] == [new]

    def test_blocks_in_use_are_not_deleted(self, catalog: Catalog) -> None:
        _, ids = add_collection(catalog, 1)
        old = publish(catalog, ids, key="k1")
        new = publish(catalog, ids, key="k2")
        with raises(ConflictError, new):
            catalog.delete_blocks([old, new])
        assert len(catalog.visible_blocks()) == 2

    def test_the_only_copy_of_a_labelled_mesh_is_in_use(self, catalog: Catalog) -> None:
        _, (shape_id,) = add_collection(catalog, 1)
        block_name = publish_mesh(catalog, shape_id, 1)
        label(catalog, shape_id)
        publish_mesh(catalog, shape_id, 2)
        assert catalog.unused_blocks() == []
        with raises(ConflictError, block_name):
            catalog.delete_blocks([block_name])

    def test_a_labelled_mesh_survives_its_block_once_kept(self, catalog: Catalog) -> None:
        _, (shape_id,) = add_collection(catalog, 1)
        block_name = publish_mesh(catalog, shape_id, 1)
        label(catalog, shape_id)
        catalog.keep_mesh(mesh_hash(shape_id), "kept/meshes/x")
        publish_mesh(catalog, shape_id, 2)
        catalog.delete_blocks([block_name])
        mesh = catalog.mesh(shape_id, mesh_hash(shape_id))
        assert (mesh.block_name, mesh.row, mesh.kept_key) == (None, None, "kept/meshes/x")
        assert catalog.meshes([shape_id])[shape_id].mesh_hash == mesh_hash(shape_id, 2)
