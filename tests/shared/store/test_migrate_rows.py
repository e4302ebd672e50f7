"""Rows of the oldest schema are whole after migrating, and what later schemas added is filled from them."""

from collections.abc import Iterator
from datetime import UTC, datetime
from pathlib import Path

import numpy as np
import pytest
from sqlalchemy import Engine, text

from partwise.errors import ConflictError
from partwise.labels.encoding import encode_labels
from partwise.store.engine import connect_engine, parsed_url, reading, writing
from partwise.store.migrate import migrate
from partwise.store.records import NewClaim, ShapeFilter, ShapeOrder, ShapeState
from partwise.store.reviews import ReviewOutcome, ReviewReason
from partwise.store.sql_catalog import SqlCatalog
from partwise.testing.expect import raises

LABELS = np.array([0, 1, 2, 2], dtype=np.uint16)
NOW = datetime(2024, 5, 1, 12, tzinfo=UTC)
OLDEST = "0001"


def _fill(engine: Engine) -> None:
    """Two shapes: the first had two meshes, and labels on the older; the second has none."""
    encoded = encode_labels(LABELS)
    values = {"now": NOW, "labels": encoded.blob, "sha256": encoded.sha256}
    statements = (
        "INSERT INTO collection (id, name, settings, schema_version, created_at) VALUES (1, 'mugs', '{}', 2, :now)",
        "INSERT INTO part VALUES (1, 1, 'body', '#E69F00', 'holds', 1, 1, NULL)",
        "INSERT INTO part VALUES (1, 2, 'handle', '#56B4E9', '', 2, 1, NULL)",
        "INSERT INTO part VALUES (1, 3, 'lid', '#009E73', '', 3, 1, 2)",
        "INSERT INTO person VALUES (1, 'ann', :now)",
        "INSERT INTO shape (id, collection_id, source_key, source_hash, source_suffix, ingested_at) "
        "VALUES (1, 1, 'a.off', 'x', '.off', :now), (2, 1, 'b.off', 'y', '.off', :now)",
        "INSERT INTO block VALUES (1, 'blocks/mesh/1', 'mesh', 1, 1, 'c', :now)",
        "INSERT INTO block VALUES (2, 'blocks/mesh/2', 'mesh', 1, 1, 'c', :now)",
        "INSERT INTO mesh VALUES ('older', 4, 4, 'kept/meshes/older', :now), ('newer', 4, 4, NULL, :now)",
        "INSERT INTO shape_mesh VALUES (1, 'older', 1, 0), (1, 'newer', 2, 0)",
        "INSERT INTO stage_run (id, shape_id, stage, key, status, attempts, seconds, summary, finished_at, "
        "is_superseded) "
        "VALUES (1, 1, 'describe', 'k', 'done', 1, 0, '{}', :now, false), "
        "(2, 2, 'describe', 'k', 'done', 1, 0, '{}', :now, false)",
        "INSERT INTO label_revision (id, shape_id, mesh_hash, kind, parent_id, author_id, schema_version, labels, "
        "n_faces, sha256, created_at) VALUES (1, 1, 'older', 'human', NULL, 1, 1, :labels, 4, :sha256, :now)",
        "INSERT INTO model VALUES (1, 1, 1, '{}', 'models/1', '[1]', 1, :now)",
        "INSERT INTO score VALUES (1, 'entropy', 1, 0.25, :now, 1), (2, 'entropy', 1, 0.75, :now, 1)",
    )
    with writing(engine) as connection:
        for statement in statements:
            used = {name: value for name, value in values.items() if f":{name}" in statement}
            connection.execute(text(statement), used)


@pytest.fixture(params=["sqlite", "postgresql"])
def migrated(request: pytest.FixtureRequest, tmp_path: Path) -> Iterator[SqlCatalog]:
    """A catalog that began under the oldest schema."""
    if request.param == "sqlite":
        url = f"sqlite:///{tmp_path}/catalog.sqlite"
    else:
        url = request.getfixturevalue("empty_database")
    engine = connect_engine(parsed_url(url))
    migrate(engine, OLDEST)
    _fill(engine)
    migrate(engine)
    with SqlCatalog(engine) as catalog:
        yield catalog


def test_the_newest_mesh_is_the_working_and_the_original_one(migrated: SqlCatalog) -> None:
    for found in (migrated.meshes([1, 2]), migrated.original_meshes([1, 2])):
        assert {shape_id: mesh.mesh_hash for shape_id, mesh in found.items()} == {1: "newer"}


def test_labels_and_parts_are_as_they_were(migrated: SqlCatalog) -> None:
    revision = migrated.revision(1)
    np.testing.assert_array_equal(migrated.labels(1), LABELS)
    assert (revision.mesh_hash, revision.origin) == ("older", None)
    schema = migrated.parts(1)
    assert [(part.name, part.gloss, part.parent_id) for part in schema.parts] == [
        ("body", "holds", None),
        ("handle", "", None),
    ]
    assert migrated.parts(1, 1).names == ("body", "handle", "lid")


def test_parts_that_labels_use_are_known(migrated: SqlCatalog) -> None:
    with raises(ConflictError, "handle", "1 shape"):
        migrated.remove_part(1, 2)
    unused = migrated.add_part(1, "spout").id_of("spout")
    assert migrated.remove_part(1, unused).names == ("body", "handle")


def test_names_of_parts_still_occur_once(migrated: SqlCatalog) -> None:
    with raises(ConflictError, "body"):
        migrated.update_part(1, 2, name="body")
    with pytest.raises(Exception, match=r"(?i)unique"), writing(migrated._engine) as connection:
        connection.execute(text("UPDATE part SET name = 'body' WHERE id = 2"))


def test_revisions_are_still_append_only(migrated: SqlCatalog) -> None:
    with pytest.raises(Exception, match="append-only"), writing(migrated._engine) as connection:
        connection.execute(text("DELETE FROM label_revision"))


def test_ready_shapes_without_labels_wait_in_the_queue(migrated: SqlCatalog) -> None:
    assert migrated.queue_depth(1).n_free == 1
    claimed = migrated.claim_next(NewClaim(1, 1, 60, 0.5))
    assert claimed is not None
    assert claimed.shape_id == 2


def test_the_table_of_shapes_is_filled(migrated: SqlCatalog) -> None:
    rows = {row.shape.id: row for row in migrated.list_shapes(1)}
    assert {shape_id: row.state for shape_id, row in rows.items()} == migrated.shape_states([1, 2])
    assert (rows[1].author_id, rows[2].author_id) == (1, None)
    assert [row.shape.id for row in migrated.list_shapes(1, where=ShapeFilter(part_id=2))] == [1]


def test_orders_by_score_have_what_shapes_are_filtered_by(migrated: SqlCatalog) -> None:
    order = ShapeOrder("entropy", descending=True)
    assert [row.shape.id for row in migrated.list_shapes(1, order=order)] == [2, 1]
    with reading(migrated._engine) as connection:
        copies = connection.execute(text("SELECT shape_id, state, author_id, source_key FROM score ORDER BY shape_id"))
        assert [tuple(row) for row in copies] == [(1, "review", 1, "a.off"), (2, "ready", None, "b.off")]


def test_labels_of_other_parts_than_the_present_ones_wait_for_a_look(migrated: SqlCatalog) -> None:
    (review,) = migrated.open_reviews(1)
    assert (review.revision_id, review.reason, review.detail) == (1, ReviewReason.SCHEMA, {"version": 2})
    assert migrated.accept_review(review.id, 1).outcome is ReviewOutcome.ACCEPTED
    assert [row.state for row in migrated.list_shapes(1)] == [ShapeState.CONFIRMED, ShapeState.READY]
