"""What every catalog counts alike: the pace of stages, and failures by kind."""

# ruff: noqa: S101 # a test suite asserts

from datetime import UTC, datetime, timedelta

from partwise.store.catalog import Catalog
from partwise.store.records import FailureKind, NewFailure
from partwise.testing.catalog.samples import add_collection, publish

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

    def test_failures_are_counted_by_kind(self, catalog: Catalog) -> None:
        collection, ids = add_collection(catalog, 3)
        for shape_id, detail in zip(ids, ({"kind": "memory"}, {"kind": "memory"}, {}), strict=True):
            catalog.record_failure(NewFailure(shape_id, "mesh", "k1", "why", detail=detail))
        counts = catalog.failure_kinds(collection.id)
        assert counts == {**dict.fromkeys(FailureKind, 0), FailureKind.MEMORY: 2, FailureKind.ERROR: 1}
