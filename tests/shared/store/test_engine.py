"""What databases raise becomes one line with a remedy, and writers wait for each other."""

import multiprocessing
import sqlite3
from concurrent.futures import ThreadPoolExecutor
from contextlib import ExitStack
from pathlib import Path

import pytest
from sqlalchemy import create_engine, event, text

from partwise.errors import ConfigError, ConflictError, StoreError
from partwise.store import engine as engines
from partwise.store import tables
from partwise.store.engine import parsed_url, reading, writing
from partwise.store.open import open_catalog
from partwise.store.records import NewShape, NewStageRun
from partwise.store.sql_catalog import SqlCatalog
from partwise.testing.catalog.samples import add_collection, new_block, publish

_N_WRITES = 20


def _write_many(url: str, name: str) -> None:
    with open_catalog(url) as catalog:
        for i in range(_N_WRITES):
            catalog.add_person(f"{name} {i}")


def test_two_processes_write_at_once(catalog_file: Path) -> None:
    url = f"sqlite:///{catalog_file}"
    context = multiprocessing.get_context("spawn")
    processes = [context.Process(target=_write_many, args=(url, name)) for name in ("a", "b")]
    for process in processes:
        process.start()
    for process in processes:
        process.join()
    assert [process.exitcode for process in processes] == [0, 0]
    with open_catalog(url) as catalog:
        assert len(catalog.list_people()) == 2 * _N_WRITES


def test_threads_share_a_catalog(catalog: SqlCatalog) -> None:
    _, ids = add_collection(catalog, 24)
    with ThreadPoolExecutor(4) as pool:
        list(pool.map(lambda shape_id: publish(catalog, [shape_id]), ids))
    assert set(catalog.stage_runs(ids, "describe")) == set(ids)


def test_as_many_read_at_once_as_have_threads(catalog: SqlCatalog) -> None:
    n_readers = 2 * engines.KEPT_CONNECTIONS
    with ExitStack() as stack:
        readers = [stack.enter_context(reading(catalog._engine)) for _ in range(n_readers)]
        assert [reader.execute(text("SELECT 1")).scalar() for reader in readers] == [1] * n_readers


def test_reads_go_on_while_another_writes(catalog: SqlCatalog) -> None:
    catalog.add_person("ann")
    with writing(catalog._engine) as connection:
        connection.execute(tables.person.delete())
        assert [person.name for person in catalog.list_people()] == ["ann"]


def test_an_interrupted_write_leaves_nothing(catalog: SqlCatalog) -> None:
    def interrupted() -> None:
        with writing(catalog._engine) as connection:
            connection.execute(tables.person.insert().values(name="ann", created_at=catalog._clock()))
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        interrupted()
    assert catalog.list_people() == []


def test_a_full_disk_is_said_and_leaves_nothing(catalog: SqlCatalog) -> None:
    collection, ids = add_collection(catalog, 1)
    catalog._engine.dispose()

    @event.listens_for(catalog._engine, "connect")
    def no_more_pages(connection: sqlite3.Connection, _record: object) -> None:
        (n_pages,) = connection.execute("PRAGMA page_count").fetchone()
        connection.execute(f"PRAGMA max_page_count = {n_pages}")

    many = [NewShape(f"{i:050}.off", f"{i:064}", ".off") for i in range(2_000)]
    with pytest.raises(StoreError, match="no room on its disk; nothing was written: free some space"):
        catalog.add_shapes(collection.id, many)
    assert [shape.id for shape in catalog.shapes(collection.id)] == ids


def test_a_lock_that_is_never_released_is_said(catalog_file: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(engines, "BUSY_TIMEOUT_S", 0.0)
    other = sqlite3.connect(catalog_file, isolation_level=None)
    with open_catalog(f"sqlite:///{catalog_file}") as catalog:
        other.execute("BEGIN IMMEDIATE")
        with pytest.raises(StoreError, match="locked by another process"):
            catalog.add_person("ann")
    other.close()


def test_a_file_that_is_no_database_is_said(tmp_path: Path) -> None:
    file = tmp_path / "catalog.sqlite"
    file.write_bytes(b"these are labels, honestly " * 100)
    with pytest.raises(StoreError, match=r"catalog\.sqlite is not a database; restore it"):
        open_catalog(f"sqlite:///{file}")


def test_an_unreachable_server_is_said_without_its_password() -> None:
    with pytest.raises(StoreError, match="reachable") as caught:
        open_catalog("postgresql://ann:secret@127.0.0.1:1/partwise")
    assert "secret" not in str(caught.value)
    assert "\n" not in str(caught.value)


def test_what_only_the_database_notices_is_a_conflict(catalog: SqlCatalog) -> None:
    with pytest.raises(ConflictError, match="consistent"), writing(catalog._engine) as connection:
        connection.execute(tables.person.insert().values([{"name": "ann", "created_at": catalog._clock()}] * 2))


def test_the_database_refuses_a_second_current_run(catalog: SqlCatalog) -> None:
    _, (shape_id,) = add_collection(catalog, 1)
    catalog.publish_block(new_block(1), [NewStageRun(shape_id, "describe", "k1", 0)])
    with pytest.raises(ConflictError, match="stage_run"), writing(catalog._engine) as connection:
        connection.exec_driver_sql(
            "INSERT INTO stage_run (shape_id, stage, key, status, attempts, seconds, summary, finished_at,"
            " is_superseded) SELECT shape_id, stage, 'k2', status, 1, 0, '{}', finished_at, 0 FROM stage_run"
        )


@pytest.mark.parametrize(
    ("url", "words"),
    [
        ("catalog.sqlite", "must look like"),
        ("mysql://host/name", "sqlite or postgresql"),
        ("sqlite://", "memory loses labels"),
        ("sqlite:///:memory:", "memory loses labels"),
    ],
)
def test_other_urls_are_refused(url: str, words: str) -> None:
    with pytest.raises(ConfigError, match=words):
        parsed_url(url)


def test_postgres_is_spoken_through_psycopg() -> None:
    assert parsed_url("postgresql://host/name").drivername == "postgresql+psycopg"


def test_a_connection_that_the_server_closed_while_it_rested_is_replaced(
    postgres_catalog: SqlCatalog, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(engines, "_TRUSTED_FOR_S", 0.0)
    postgres_catalog.list_people()  # from now on a connection rests
    other = create_engine(postgres_catalog._engine.url, isolation_level="AUTOCOMMIT")
    of_others = "FROM pg_stat_activity WHERE datname = current_database() AND pid <> pg_backend_pid()"
    with other.connect() as connection:
        assert connection.execute(text(f"SELECT pg_terminate_backend(pid) {of_others}")).all()
    other.dispose()
    assert list(postgres_catalog.list_people()) == []
