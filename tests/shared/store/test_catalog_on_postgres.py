"""The SQL catalog on PostgreSQL is a `Catalog`."""

import pytest

from partwise.store.sql_catalog import SqlCatalog
from partwise.testing.catalog import CatalogConformance


class TestPostgresCatalog(CatalogConformance):
    @pytest.fixture
    def catalog(self, postgres_catalog: SqlCatalog) -> SqlCatalog:
        return postgres_catalog
