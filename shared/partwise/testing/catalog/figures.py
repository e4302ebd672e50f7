"""What every catalog counts alike: the pace of stages, and failures by kind."""

# ruff: noqa: S101 # a test suite asserts

from datetime import UTC, datetime, timedelta

import numpy as np

from partwise.errors import ConflictError
from partwise.store.catalog import Catalog
from partwise.store.records import (
    Closeness,
    FailureKind,
    NewBlindCheck,
    NewFailure,
    NewRevision,
    NewScore,
    NewStageRun,
    RecheckResult,
    RevisionKind,
)
from partwise.testing.catalog.samples import (
    add_collection,
    claim,
    confirm,
    label,
    mesh_hash,
    publish,
    publish_mesh,
    ready_shapes,
    save_model,
)
from partwise.testing.expect import raises

HOUR = timedelta(hours=1)


class FigureConformance:
    def test_the_pace_of_a_stage_counts_what_was_done_since(self, catalog: Catalog) -> None:
        collection, ids = add_collection(catalog, 3)
        publish(catalog, ids, "mesh")
        publish(catalog, ids[:2], "describe")
        now = datetime.now(UTC)
        assert catalog.stage_paces(collection.id, now - HOUR) == {"mesh": 3, "describe": 2}
        assert catalog.stage_paces(collection.id, now + HOUR) == {}

    def test_the_pace_is_of_one_collection(self, catalog: Catalog) -> None:
        collection, _ = add_collection(catalog, 1)
        _, others = add_collection(catalog, 1, "tables")
        publish(catalog, others, "mesh")
        assert catalog.stage_paces(collection.id, datetime.now(UTC) - HOUR) == {}

    def test_stages_count_for_the_model_and_mesh_they_were_done_with(self, catalog: Catalog) -> None:
        collection, ids = ready_shapes(catalog, 3)
        old, new = ({"model_version": version} for version in (1, 2))
        summaries = [old, new, new]
        runs = [
            NewStageRun(shape_id, "evaluate", "k1", None, summary={**summary, "mesh_hash": mesh_hash(shape_id)})
            for shape_id, summary in zip(ids, summaries, strict=True)
        ]
        catalog.record_done([*runs, NewStageRun(ids[1], "refine", "k1", None, summary=runs[1].summary)])
        publish_mesh(catalog, ids[2], version=2)
        assert catalog.stages_of_model(collection.id, 2) == {"evaluate": 1, "refine": 1}
        assert catalog.stages_of_model(collection.id, 1) == {"evaluate": 1}
        assert catalog.stages_of_model(collection.id, 3) == {}

    def test_failures_are_counted_by_kind(self, catalog: Catalog) -> None:
        collection, ids = add_collection(catalog, 3)
        for shape_id, detail in zip(ids, ({"kind": "memory"}, {"kind": "memory"}, {}), strict=True):
            catalog.record_failure(NewFailure(shape_id, "mesh", "k1", "why", detail=detail))
        counts = catalog.failure_kinds(collection.id)
        assert counts == {**dict.fromkeys(FailureKind, 0), FailureKind.MEMORY: 2, FailureKind.ERROR: 1}

    def test_people_rounds_and_days_count_what_was_confirmed(self, catalog: Catalog) -> None:
        collection, (known, _) = ready_shapes(catalog, 2)
        model = save_model(catalog, collection.id)
        catalog.record_done([], [NewScore(known, model.id, "entropy", 0.5)])
        reference = label(catalog, known, RevisionKind.REFERENCE)
        catalog.update_collection_settings(collection.id, {"honeypot_share": 1.0})
        ann = catalog.list_people()[0]
        check = NewBlindCheck(reference.id, Closeness(0.8, 0.7, 0.1))
        confirm(catalog, claim(catalog, collection, ann), blind_check=check)
        now = datetime.now(UTC)
        (person,) = catalog.person_figures(collection.id, now - HOUR)
        assert (person.name, person.n_confirmed, person.n_timed, person.n_checks) == ("ann", 1, 0, 1)
        assert catalog.person_figures(collection.id, now + HOUR) == []
        (day,) = catalog.blind_check_days(collection.id)
        assert (day.person_id, day.n_checks, day.mean) == (ann.id, 1, check.closeness)
        (found,) = catalog.model_rounds(collection.id, "entropy")
        assert (found.n_scores, found.mean_score, found.n_checks, found.area_agreement) == (1, 0.5, 1, 0.8)
        assert catalog.scored_by(collection.id, "entropy") == {1: 1}
        assert catalog.lease_counts(collection.id).n_active == 0
        assert catalog.database_bytes() > 0
        assert sum(each.n_blocks for each in catalog.block_totals()) == 3

    def test_accepted_labels_are_counted_with_their_checks(self, catalog: Catalog) -> None:
        collection, (first, second, third) = ready_shapes(catalog, 3)
        rita = catalog.add_person("rita")
        batch_id = catalog.begin_accept(collection.id, rita.id, "predicted", 0.9)
        labels = np.ones(6, dtype=np.uint16)
        revision = NewRevision(first, mesh_hash(first), RevisionKind.HUMAN, rita.id, 1, labels)
        catalog.accept_shape(batch_id, revision)
        drawn = catalog.draw_shape(batch_id, third, mesh_hash(third), 1, labels)
        for again in (revision, NewRevision(third, mesh_hash(third), RevisionKind.HUMAN, rita.id, 1, labels)):
            with raises(ConflictError, "shape"):
                catalog.accept_shape(batch_id, again)
        assert catalog.open_rechecks(collection.id, shape_id=third) == [drawn]
        assert catalog.recheck_labels(drawn.id).tolist() == [1] * 6
        lease = claim(catalog, collection, catalog.add_person("ann"))
        assert lease.shape_id == third
        revision_id = confirm(catalog, lease).revision_id
        assert revision_id is not None
        result = RecheckResult(drawn.id, revision_id, Closeness(0.5, 0.4, 0.2))
        assert [catalog.settle_recheck(result) for _ in range(2)] == [True, True]
        (batch,) = catalog.accept_batches(collection.id)
        assert (batch.n_accepted, batch.n_drawn, batch.n_rechecked, batch.n_false) == (1, 1, 1, 1)
        assert catalog.open_rechecks(collection.id) == []
        assert catalog.put_first(collection.id, [first, second], rita.id) == [second]
