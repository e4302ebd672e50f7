"""The SQL catalog on PostgreSQL is a `Catalog`."""

import os

import pytest

from partwise.store.sql_catalog import SqlCatalog
from partwise.testing.catalog import CatalogConformance

if not os.environ.get("PARTWISE_TEST_POSTGRES"):  # once for the file: a line for each test would drown the summary
    pytest.skip("PARTWISE_TEST_POSTGRES names no PostgreSQL server", allow_module_level=True)


class TestPostgresCatalog(CatalogConformance):
    @pytest.fixture
    def catalog(self, postgres_catalog: SqlCatalog) -> SqlCatalog:
        return postgres_catalog
