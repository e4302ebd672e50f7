"""What annotators wait for is answered from indexes, whatever the size of the collection."""

from collections.abc import Callable
from contextlib import suppress
from datetime import timedelta

import pytest
from sqlalchemy import event

from partwise.store.records import (
    ANY_STAGE,
    BY_NAME,
    ListAnchor,
    NewClaim,
    QueueAnchor,
    RevisionKind,
    ShapeFilter,
    ShapeOrder,
    ShapeState,
)
from partwise.store.sql_catalog import SqlCatalog
from partwise.testing.catalog.samples import ready_shapes

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
    "claim": lambda catalog, i: catalog.claim_next(NewClaim(i, _person(catalog), 60, 0.5)),
    "claim by name": lambda catalog, i: catalog.claim_shape(1, _person(catalog), 60),
    "leases of a person": lambda catalog, i: catalog.leases_of(1),
    "leases of a person with shapes": lambda catalog, i: catalog.leased_by(1),
    "leases with shapes": lambda catalog, i: catalog.leased_shapes([1, 2]),
    "active leases": lambda catalog, i: catalog.active_leases(i),
    "skips": lambda catalog, i: catalog.skips(i, before=7),
    "held shapes": lambda catalog, i: catalog.held_shapes([1, 2]),
    "score that ranks": lambda catalog, i: catalog.ranking_score(i),
    "highest that wait": lambda catalog, i: catalog.highest_waiting(i, "entropy", 9),
    "out of rank": lambda catalog, i: catalog.out_of_rank(i, "entropy"),
    "strokes": lambda catalog, i: catalog.strokes(1),
    "open drafts": lambda catalog, i: catalog.open_drafts(1),
    "drafts of a shape": lambda catalog, i: catalog.drafts_of_shape(1),
    "answers": lambda catalog, i: catalog.answers(1),
    "consensus": lambda catalog, i: catalog.consensus_of(1),
    "blind checks": lambda catalog, i: catalog.blind_checks(i),
    "jobs": lambda catalog, i: catalog.jobs(i),
    "claim a job": lambda catalog, i: catalog.claim_job("w1"),
    "lost jobs": lambda catalog, i: catalog.requeue_lost_jobs(timedelta(hours=1)),
    "authenticate": lambda catalog, i: catalog.authenticate("pw_x"),
    "tokens of a person": lambda catalog, i: catalog.tokens(person_id=1),
    "events": lambda catalog, i: catalog.events(after=7, collection_ids=[i]),
    "table": lambda catalog, i: catalog.list_shapes(i, after=ListAnchor(7)),
    "table of a state": lambda catalog, i: catalog.list_shapes(i, where=ShapeFilter(state=ShapeState.READY)),
    "table of a cluster": lambda catalog, i: catalog.list_shapes(i, where=ShapeFilter(cluster=1)),
    "table of an author": lambda catalog, i: catalog.list_shapes(i, where=ShapeFilter(author_id=1)),
    "table of a failure": lambda catalog, i: catalog.list_shapes(i, where=ShapeFilter(failed_stage="mesh")),
    "table of a name": lambda catalog, i: catalog.list_shapes(i, where=ShapeFilter(name="a")),
    "table of a name by score": lambda catalog, i: catalog.shapes_from_rank(
        i, 7, where=ShapeFilter(name="a"), order=ShapeOrder("entropy")
    ),
    "table of a part": lambda catalog, i: catalog.list_shapes(i, where=ShapeFilter(part_id=1)),
    "table of any failure": lambda catalog, i: catalog.list_shapes(i, where=ShapeFilter(failed_stage=ANY_STAGE)),
    "table by name": lambda catalog, i: catalog.list_shapes(i, order=ShapeOrder(BY_NAME), after=ListAnchor(7)),
    "jump by id": lambda catalog, i: catalog.shapes_from_rank(i, 7),
    "jump by name": lambda catalog, i: catalog.shapes_from_rank(i, 7, order=ShapeOrder(BY_NAME)),
    "jump by score": lambda catalog, i: catalog.shapes_from_rank(i, 7, order=ShapeOrder("entropy")),
    "scores that exist": lambda catalog, i: catalog.score_names(i),
    "tiles": lambda catalog, i: catalog.shape_tiles([1, 2]),
    "table by score": lambda catalog, i: catalog.list_shapes(i, order=ShapeOrder("entropy")),
    "ordering": lambda catalog, i: catalog.ordering(i, "entropy"),
}
_INDEX_ALONE = ("table of a name", "table of a name by score")
"""Passing over a shape whose name is another takes no look at the shape."""
_NOT_SORTED = (
    "table of a name",
    "queue page",
    "skips",
    "highest that wait",
    "claim",
    "table",
    "table of a state",
    "table of a cluster",
    "table of a part",
    "table by score",
    "table by name",
    "jump by id",
    "jump by name",
    "jump by score",
    "jobs",
    "events",
)


def _person(catalog: SqlCatalog) -> int:
    return catalog.add_person("ann").id


def _plans(catalog: SqlCatalog, name: str) -> list[str]:
    """How SQLite does what a query asks for, step by step."""
    collection, _ = ready_shapes(catalog, 2)
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
    return plans


@pytest.mark.parametrize("name", _QUERIES)
def test_no_table_is_scanned(catalog: SqlCatalog, name: str) -> None:
    plans = _plans(catalog, name)
    # the index of pending jobs holds nothing else, and places ahead are counted up to a limit
    harmless = ("SUBQUERY", "ix_job_pending", "SCAN ahead")
    assert [step for step in plans if step.startswith("SCAN") and not any(each in step for each in harmless)] == []


@pytest.mark.parametrize("name", _NOT_SORTED)
def test_nothing_is_sorted(catalog: SqlCatalog, name: str) -> None:
    assert not any("TEMP B-TREE" in step for step in _plans(catalog, name))


@pytest.mark.parametrize("name", _INDEX_ALONE)
def test_names_are_searched_in_an_index_alone(catalog: SqlCatalog, name: str) -> None:
    searched = [step for step in _plans(catalog, name) if "collection_id=?)" in step]
    assert searched
    assert all("USING COVERING INDEX" in step for step in searched)


def test_queue_is_read_in_order_of_the_index(catalog: SqlCatalog) -> None:
    collection = catalog.create_collection("chairs", ["seat"])
    plans: list[str] = []

    @event.listens_for(catalog._engine, "before_cursor_execute")
    def explain(connection: object, cursor: object, statement: str, parameters: object, *_: object) -> None:
        if "score" in statement:
            cursor.execute("EXPLAIN QUERY PLAN " + statement, parameters)  # type: ignore[attr-defined]
            plans.extend(row[3] for row in cursor.fetchall())  # type: ignore[attr-defined]

    catalog.queue(collection.id, "entropy", after=QueueAnchor(0.5, 7))
    assert any("ix_score_by_value" in step for step in plans)
    assert not any("TEMP B-TREE" in step for step in plans)


def test_closed_drafts_are_passed_by(catalog: SqlCatalog) -> None:
    drafts = [step for step in _plans(catalog, "open drafts") if "draft" in step]
    assert drafts
    assert all("uq_draft_open" in step for step in drafts)


def test_free_places_are_read_in_order_of_their_own_index(catalog: SqlCatalog) -> None:
    places = [step for step in _plans(catalog, "claim") if "queue_rank" in step]
    assert any("ix_queue_rank_free" in step for step in places)
    assert all("ix_queue_rank_free" in step or "ix_queue_rank_assigned" in step for step in places)
