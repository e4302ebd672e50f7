"""What annotators wait for is answered from indexes, whatever the size of the collection."""

from collections.abc import Callable
from contextlib import suppress

import pytest
from sqlalchemy import event

from partwise.store.records import QueueAnchor, RevisionKind
from partwise.store.sql_catalog import SqlCatalog

_QUERIES: dict[str, Callable[[SqlCatalog, int], object]] = {
    "queue": lambda catalog, i: catalog.queue(i, "entropy"),
    "queue page": lambda catalog, i: catalog.queue(i, "entropy", descending=False, after=QueueAnchor(0.5, 7)),
    "shapes": lambda catalog, i: catalog.shapes(i, after=7),
    "by key": lambda catalog, i: catalog.shape_by_key(i, "x"),
    "stage runs": lambda catalog, i: catalog.stage_runs([1, 2], "describe"),
    "failed runs": lambda catalog, i: catalog.failed_runs([1, 2], "describe"),
    "states": lambda catalog, i: catalog.shape_states([1, 2]),
    "meshes": lambda catalog, i: catalog.meshes([1, 2]),
    "original meshes": lambda catalog, i: catalog.original_meshes([1, 2]),
    "open reviews": lambda catalog, i: catalog.open_reviews(i),
    "reviews": lambda catalog, i: catalog.reviews(1),
    "labelled without reviews": lambda catalog, i: catalog.labelled_shapes(i, leave_out_reviews=True),
    "part in use": lambda catalog, i: catalog.remove_part(i, 1),
    "heads": lambda catalog, i: catalog.head_revisions([1, 2], [RevisionKind.HUMAN]),
    "revisions": lambda catalog, i: catalog.revisions(1),
    "scores": lambda catalog, i: catalog.scores([1, 2], "entropy"),
    "latest model": lambda catalog, i: catalog.latest_model(i),
}


@pytest.mark.parametrize("name", _QUERIES)
def test_no_table_is_scanned(catalog: SqlCatalog, name: str) -> None:
    collection = catalog.create_collection("chairs", ["seat"])
    catalog.create_collection("mugs", ["body"])
    plans: list[str] = []

    @event.listens_for(catalog._engine, "before_cursor_execute")
    def explain(connection: object, cursor: object, statement: str, parameters: object, *_: object) -> None:
        if statement.startswith("SELECT"):
            cursor.execute("EXPLAIN QUERY PLAN " + statement, parameters)  # type: ignore[attr-defined]
            plans.extend(row[3] for row in cursor.fetchall())  # type: ignore[attr-defined]

    with suppress(LookupError):  # an empty catalog has no such shape: the plan is what counts
        _QUERIES[name](catalog, collection.id)
    assert plans
    assert [step for step in plans if step.startswith("SCAN") and "SUBQUERY" not in step] == []


def test_queue_is_read_in_order_of_the_index(catalog: SqlCatalog) -> None:
    collection = catalog.create_collection("chairs", ["seat"])
    plans: list[str] = []

    @event.listens_for(catalog._engine, "before_cursor_execute")
    def explain(connection: object, cursor: object, statement: str, parameters: object, *_: object) -> None:
        if "score" in statement:
            cursor.execute("EXPLAIN QUERY PLAN " + statement, parameters)  # type: ignore[attr-defined]
            plans.extend(row[3] for row in cursor.fetchall())  # type: ignore[attr-defined]

    catalog.queue(collection.id, "entropy", after=QueueAnchor(0.5, 7))
    assert any("ix_score_collection_id_name_value_shape_id" in step for step in plans)
    assert not any("TEMP B-TREE" in step for step in plans)
