"""Fixtures of the stores' tests. The catalogs are copies of one that was migrated once, because that takes longest."""

import shutil
from collections.abc import Iterator
from pathlib import Path

import pytest

from partwise.store.open import create_catalog, open_catalog
from partwise.store.open_arrays import open_array_store
from partwise.store.sql_catalog import SqlCatalog
from partwise.store.zarr_store import ZarrArrayStore
from partwise.testing.postgres import (
    ReusedDatabase,
    database_name,
    postgres_database,
    reused_database,
)

pytest.register_assert_rewrite("partwise.testing.array_store", "partwise.testing.catalog")


@pytest.fixture(scope="session")
def migrated_file(tmp_path_factory: pytest.TempPathFactory) -> Path:
    file = tmp_path_factory.mktemp("migrated") / "catalog.sqlite"
    create_catalog(f"sqlite:///{file}").close()
    return file


@pytest.fixture
def catalog_file(migrated_file: Path, tmp_path: Path) -> Path:
    return Path(shutil.copy(migrated_file, tmp_path / "catalog.sqlite"))


@pytest.fixture
def catalog(catalog_file: Path) -> Iterator[SqlCatalog]:
    with open_catalog(f"sqlite:///{catalog_file}") as catalog:
        yield catalog


@pytest.fixture
def store(tmp_path: Path) -> ZarrArrayStore:
    return open_array_store(str(tmp_path / "arrays"))


@pytest.fixture(scope="session")
def migrated_database(postgres: str) -> Iterator[str]:
    with postgres_database(postgres) as url:
        create_catalog(url).close()
        yield url


@pytest.fixture(scope="session")
def reused(postgres: str, migrated_database: str) -> Iterator[ReusedDatabase]:
    with reused_database(postgres, database_name(migrated_database)) as database:
        yield database


@pytest.fixture
def postgres_catalog(reused: ReusedDatabase) -> Iterator[SqlCatalog]:
    reused.restore()
    with open_catalog(reused.url) as catalog:
        yield catalog


@pytest.fixture
def empty_database(postgres: str) -> Iterator[str]:
    """URL of a PostgreSQL database without a catalog."""
    with postgres_database(postgres) as url:
        yield url
