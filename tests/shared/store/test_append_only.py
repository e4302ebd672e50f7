"""The databases themselves refuse to change label revisions and the audit trail."""

import pytest
from sqlalchemy import text
from sqlalchemy.exc import DBAPIError

from partwise.store.sql_catalog import SqlCatalog
from partwise.testing.catalog.samples import claim, confirm, label, ready_shapes

_CHANGES = [
    "UPDATE label_revision SET author_id = author_id",
    "UPDATE label_revision SET labels = ''",
    "DELETE FROM label_revision",
    "UPDATE audit SET actor = 'bob'",
    "DELETE FROM audit",
    "UPDATE stroke SET sequence = 7",
    "DELETE FROM stroke",
    "UPDATE answer SET slot = 1",
    "DELETE FROM answer",
]
_REPLACE = "REPLACE INTO label_revision SELECT * FROM label_revision"


def _labelled(catalog: SqlCatalog) -> int:
    """Labels, the strokes they came from, and an answer that waits for another person's."""
    collection, (shape_id,) = ready_shapes(catalog, 1)
    catalog.update_collection_settings(collection.id, {"labels_per_shape": 2})
    catalog.fill_queue(collection.id)
    confirm(catalog, claim(catalog, collection, catalog.add_person("ann")))
    return label(catalog, shape_id).id


def _refuses(catalog: SqlCatalog, statement: str) -> None:
    revision_id = _labelled(catalog)
    before = (catalog.revision(revision_id), catalog.labels(revision_id).tolist(), catalog.audit())
    with pytest.raises(DBAPIError, match="append-only"), catalog._engine.begin() as connection:
        connection.execute(text(statement))
    assert (catalog.revision(revision_id), catalog.labels(revision_id).tolist(), catalog.audit()) == before


@pytest.mark.parametrize("statement", [*_CHANGES, _REPLACE])
def test_sqlite_refuses(catalog: SqlCatalog, statement: str) -> None:
    _refuses(catalog, statement)


@pytest.mark.parametrize(
    "statement",
    [*_CHANGES, "TRUNCATE label_revision CASCADE", "TRUNCATE audit", "TRUNCATE stroke", "TRUNCATE answer CASCADE"],
)
def test_postgres_refuses(postgres_catalog: SqlCatalog, statement: str) -> None:
    _refuses(postgres_catalog, statement)
