"""The databases themselves refuse to change label revisions and the audit trail."""

import pytest
from sqlalchemy import text
from sqlalchemy.exc import DBAPIError

from partwise.store.sql_catalog import SqlCatalog
from partwise.testing.catalog.samples import add_collection, label, publish_mesh

_CHANGES = [
    "UPDATE label_revision SET author_id = author_id",
    "UPDATE label_revision SET labels = ''",
    "DELETE FROM label_revision",
    "UPDATE audit SET actor = 'bob'",
    "DELETE FROM audit",
]
_REPLACE = "REPLACE INTO label_revision SELECT * FROM label_revision"


def _labelled(catalog: SqlCatalog) -> int:
    _, (shape_id,) = add_collection(catalog, 1)
    publish_mesh(catalog, shape_id)
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


@pytest.mark.parametrize("statement", [*_CHANGES, "TRUNCATE label_revision CASCADE", "TRUNCATE audit"])
def test_postgres_refuses(postgres_catalog: SqlCatalog, statement: str) -> None:
    _refuses(postgres_catalog, statement)
