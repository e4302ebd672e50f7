"""The SQL catalog is a `Catalog`, on SQLite and on PostgreSQL."""

import pytest

from partwise.store.sql_catalog import SqlCatalog
from partwise.testing.catalog import CatalogConformance


class TestSqliteCatalog(CatalogConformance):
    """The `catalog` fixture is SQLite's."""


class TestPostgresCatalog(CatalogConformance):
    @pytest.fixture
    def catalog(self, postgres_catalog: SqlCatalog) -> SqlCatalog:
        return postgres_catalog
