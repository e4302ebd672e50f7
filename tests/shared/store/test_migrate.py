"""Migrations: from empty, all or nothing, and what is refused when versions differ."""

import shutil
from pathlib import Path

import pytest
from alembic.autogenerate import compare_metadata
from alembic.runtime.migration import MigrationContext
from sqlalchemy import inspect, text

from partwise.errors import NotFoundError, StoreError
from partwise.store import migrate, tables
from partwise.store.engine import reading
from partwise.store.open import create_catalog, open_catalog
from partwise.store.sql_catalog import SqlCatalog

_NEXT = """
from alembic import op
import sqlalchemy as sa
revision = "9999"
down_revision = "{newest}"
def upgrade():
    op.create_table("hat", sa.Column("id", sa.Integer, primary_key=True))
    {last}
"""

_NEWEST = max(file.stem[1:5] for file in (migrate._MIGRATIONS / "versions").glob("m*.py"))


@pytest.fixture
def later_migrations(tmp_path: Path) -> Path:
    """The package's migrations and one more."""
    folder = tmp_path / "migrations"
    shutil.copytree(migrate._MIGRATIONS, folder)
    (folder / "versions" / "m9999_hats.py").write_text(_NEXT.format(newest=_NEWEST, last=""))
    return folder


def test_migrated_schema_is_the_tables(catalog: SqlCatalog) -> None:
    with reading(catalog._engine) as connection:
        context = MigrationContext.configure(connection, opts={"compare_type": True})
        assert compare_metadata(context, tables.metadata) == []


def test_migrated_schema_is_the_tables_on_postgres(postgres_catalog: SqlCatalog) -> None:
    with reading(postgres_catalog._engine) as connection:
        context = MigrationContext.configure(connection, opts={"compare_type": True})
        assert compare_metadata(context, tables.metadata) == []


def test_creating_twice_keeps_what_is_there(tmp_path: Path) -> None:
    url = f"sqlite:///{tmp_path}/catalog.sqlite"
    with create_catalog(url) as catalog:
        catalog.add_person("ann")
    with create_catalog(url) as catalog:
        assert catalog.get_person("ann").name == "ann"


def test_opening_what_is_not_there_makes_nothing(tmp_path: Path) -> None:
    file = tmp_path / "catalog.sqlite"
    with pytest.raises(NotFoundError, match="partwise init"):
        open_catalog(f"sqlite:///{file}")
    assert not file.exists()


def test_opening_a_database_without_a_catalog_is_refused(tmp_path: Path) -> None:
    file = tmp_path / "catalog.sqlite"
    file.touch()
    with pytest.raises(NotFoundError, match="partwise init"):
        open_catalog(f"sqlite:///{file}")


def test_creating_in_a_missing_folder_is_refused(tmp_path: Path) -> None:
    with pytest.raises(StoreError, match="folder"):
        create_catalog(f"sqlite:///{tmp_path}/missing/catalog.sqlite")


def test_an_older_schema_asks_for_migrate(
    catalog_file: Path, later_migrations: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(migrate, "_MIGRATIONS", later_migrations)
    with pytest.raises(StoreError, match="older than 9999; run `partwise migrate`"):
        open_catalog(f"sqlite:///{catalog_file}")


def test_migrating_brings_an_older_schema_up(
    catalog_file: Path, later_migrations: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(migrate, "_MIGRATIONS", later_migrations)
    with create_catalog(f"sqlite:///{catalog_file}") as catalog:
        assert inspect(catalog._engine).has_table("hat")


def test_a_newer_schema_asks_for_a_newer_partwise(
    catalog_file: Path, later_migrations: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    with monkeypatch.context() as later:
        later.setattr(migrate, "_MIGRATIONS", later_migrations)
        create_catalog(f"sqlite:///{catalog_file}").close()
    for opened in (open_catalog, create_catalog):
        with pytest.raises(StoreError, match=f"newer than {_NEWEST}; use a newer partwise"):
            opened(f"sqlite:///{catalog_file}")


def test_a_migration_that_fails_leaves_the_old_schema(
    catalog_file: Path, later_migrations: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    broken = later_migrations / "versions" / "m9999_hats.py"
    broken.write_text(_NEXT.format(newest=_NEWEST, last="raise RuntimeError('power cut')"))
    with monkeypatch.context() as later:
        later.setattr(migrate, "_MIGRATIONS", later_migrations)
        with pytest.raises(RuntimeError, match="power cut"):
            create_catalog(f"sqlite:///{catalog_file}")
    with open_catalog(f"sqlite:///{catalog_file}") as catalog:
        assert not inspect(catalog._engine).has_table("hat")


def test_no_migrations_at_all_is_a_broken_installation(
    catalog_file: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "none" / "versions").mkdir(parents=True)
    monkeypatch.setattr(migrate, "_MIGRATIONS", tmp_path / "none")
    with pytest.raises(StoreError, match="reinstall"):
        migrate.known_schema()


def test_sqlite_is_set_up_for_peoples_work(catalog: SqlCatalog) -> None:
    with reading(catalog._engine) as connection:
        found = {
            name: connection.execute(text(f"PRAGMA {name}")).scalar()
            for name in ("journal_mode", "synchronous", "foreign_keys", "recursive_triggers")
        }
    assert found == {"journal_mode": "wal", "synchronous": 2, "foreign_keys": 1, "recursive_triggers": 1}
