"""Connections to the catalog's database: SQLite's settings, transactions, and drivers' errors in one line.

SQLite has one writer at a time. A write transaction therefore takes the write lock when it begins (BEGIN IMMEDIATE):
taken later, it could fail after reading what another writer has changed since.
"""

import math
import time
from collections.abc import Iterator
from contextlib import contextmanager
from functools import partial
from typing import Any

from sqlalchemy import URL, Connection, Engine, create_engine, event, make_url
from sqlalchemy.exc import ArgumentError, DBAPIError, DisconnectionError, IntegrityError, NoSuchModuleError

from partwise.errors import ConfigError, ConflictError, StoreError

BUSY_TIMEOUT_S = 30.0
KEPT_CONNECTIONS = 20  # more than handlers run at once: making one costs more than all that a request asks of it
CONNECT_TIMEOUT_S = 10  # the driver's own is over two minutes
_WRITES = "partwise_writes"
_RESTS_SINCE = "partwise_rests_since"
_TRUSTED_FOR_S = 5.0  # a connection that was in use so lately


def parsed_url(url: str) -> URL:
    """`sqlite:///path` or `postgresql://…` (spoken through psycopg) as SQLAlchemy's URL.

    Raises
    ------
    ConfigError : not a URL, another database, or SQLite in memory, which would lose people's work.
    """
    try:
        parsed = make_url(url)
    except ArgumentError as error:
        raise ConfigError(
            f"a database URL must look like sqlite:///catalog.sqlite or postgresql://host/name but is {url!r}"
        ) from error
    if parsed.drivername in ("postgresql", "postgres"):
        parsed = parsed.set(drivername="postgresql+psycopg")
    if parsed.drivername not in ("sqlite", "postgresql+psycopg"):
        raise ConfigError(f"the database must be sqlite or postgresql but the URL names {parsed.drivername!r}")
    if parsed.drivername == "sqlite" and parsed.database in (None, "", ":memory:"):
        raise ConfigError("a SQLite catalog must be a file, for example sqlite:///catalog.sqlite: memory loses labels")
    return parsed


def connect_engine(url: URL) -> Engine:
    """An engine for the database at `url`; nothing is opened yet. Dispose it when done.

    Raises
    ------
    StoreError : the database's driver is not installed.
    """
    is_sqlite = url.drivername == "sqlite"
    patience = {} if is_sqlite or "connect_timeout" in url.query else {"connect_timeout": CONNECT_TIMEOUT_S}
    try:
        # callers bound their threads: one that may run is not made to wait for a connection, and fail
        engine = create_engine(
            url, pool_size=KEPT_CONNECTIONS, max_overflow=-1, pool_use_lifo=True, connect_args=patience
        )
    except (ImportError, NoSuchModuleError) as error:
        raise StoreError(f"{url.drivername} needs a driver ({error}); install partwise[cloud]") from error
    if is_sqlite:
        event.listen(engine, "connect", _prepare_sqlite)
        event.listen(engine, "begin", _begin_sqlite)
    else:
        event.listen(engine, "checkin", _note_rest)
        event.listen(engine, "checkout", partial(_refuse_broken, engine))
    return engine


def _prepare_sqlite(connection: Any, _record: Any) -> None:
    connection.isolation_level = None  # the driver's own BEGIN comes too late and is never IMMEDIATE
    cursor = connection.cursor()
    cursor.execute(f"PRAGMA busy_timeout = {int(BUSY_TIMEOUT_S * 1000)}")
    cursor.execute("PRAGMA journal_mode = WAL")
    cursor.execute("PRAGMA synchronous = FULL")
    cursor.execute("PRAGMA foreign_keys = ON")
    cursor.execute("PRAGMA recursive_triggers = ON")  # else REPLACE deletes past the triggers that refuse it
    cursor.close()


def _note_rest(_connection: Any, record: Any) -> None:
    record.info[_RESTS_SINCE] = time.monotonic()


def _refuse_broken(engine: Engine, connection: Any, record: Any, _proxy: Any) -> None:
    """Has the pool replace a connection that the server has closed while it rested. One that was in use a moment ago
    is not asked: that would double what the shortest queries take.
    """
    if time.monotonic() - record.info.get(_RESTS_SINCE, -math.inf) < _TRUSTED_FOR_S:
        return
    try:
        engine.dialect.do_ping(connection)
    except engine.dialect.loaded_dbapi.Error as error:
        raise DisconnectionError(str(error)) from error


def _begin_sqlite(connection: Connection) -> None:
    is_writing = connection.get_execution_options().get(_WRITES, False)
    connection.exec_driver_sql("BEGIN IMMEDIATE" if is_writing else "BEGIN")


@contextmanager
def reading(engine: Engine) -> Iterator[Connection]:
    """What only reads. In SQLite one consistent state of the catalog; in PostgreSQL, whose transactions show each query
    what is committed by then, queries go without a transaction, which would be two more trips to the server.
    """
    with _in_one_line(engine), engine.connect() as connection:
        if engine.dialect.name == "postgresql":
            yield connection.execution_options(isolation_level="AUTOCOMMIT")
            return
        with connection.begin():
            yield connection


@contextmanager
def writing(engine: Engine) -> Iterator[Connection]:
    """A transaction that writes: committed as a whole when the block ends, rolled back when it raises."""
    with (
        _in_one_line(engine),
        engine.connect().execution_options(**{_WRITES: True}) as connection,
        connection.begin(),
    ):
        yield connection


@contextmanager
def writing_at_once(engine: Engine) -> Iterator[Connection]:
    """As `writing`, for what is one statement in PostgreSQL: there that is a transaction by itself, without the trips
    to the server that begin and end one. Several statements would be as many transactions.
    """
    with reading(engine) if engine.dialect.name == "postgresql" else writing(engine) as connection:
        yield connection


@contextmanager
def _in_one_line(engine: Engine) -> Iterator[None]:
    """Turn the driver's errors into the project's, with a remedy."""
    try:
        yield
    except IntegrityError as error:
        raise ConflictError(f"the catalog must stay consistent and refused a change: {_reason(error)}") from error
    except DBAPIError as error:
        where = engine.url.render_as_string(hide_password=True)
        raise StoreError(f"the catalog at {where} {_complaint(_reason(error))}") from error


def _reason(error: DBAPIError) -> str:
    lines = str(error.orig).strip().splitlines()
    return lines[0] if lines else type(error.orig).__name__


def _complaint(reason: str) -> str:
    remedies = {
        "disk is full": "has no room on its disk; nothing was written: free some space and run again",
        "No space left": "has no room on its disk; nothing was written: free some space and run again",
        "disk I/O error": "cannot use its disk, which is full or failing; nothing was written: free some space",
        "database is locked": f"was locked by another process for {BUSY_TIMEOUT_S:g} s; run again when that has ended",
        "unable to open": "cannot be opened; is its folder there and may you write to it?",
        "readonly": "is read-only; may you write to the file and its folder?",
        "not a database": "is not a database; restore it from a backup",
        "malformed": "is damaged; restore it from a backup",
    }
    for sign, remedy in remedies.items():
        if sign in reason:
            return remedy
    return f"failed: {reason}; is the database running and reachable?"
