"""The SQL catalog on SQLite is a `Catalog`."""

from partwise.testing.catalog import CatalogConformance


class TestSqliteCatalog(CatalogConformance):
    """The `catalog` fixture is SQLite's."""
