"""Open the catalog at a URL, or make one."""

from collections.abc import Callable
from datetime import datetime
from pathlib import Path

from sqlalchemy import URL

from partwise.errors import NotFoundError, StoreError
from partwise.store.clock import utc_now
from partwise.store.engine import connect_engine, parsed_url
from partwise.store.migrate import migrate, refuse_other_schema
from partwise.store.sql_catalog import SqlCatalog


def open_catalog(url: str, clock: Callable[[], datetime] = utc_now) -> SqlCatalog:
    """The catalog at `url`, `sqlite:///path` or `postgresql://user@host/name`.

    Raises
    ------
    ConfigError : the URL is not one of those.
    NotFoundError : nothing is there; `partwise init` makes a catalog.
    StoreError : its schema is older (run `partwise migrate`) or newer, or the database cannot be reached.
    """
    parsed = parsed_url(url)
    file = _sqlite_file(parsed)
    if file is not None and not file.is_file():  # connecting would make an empty file
        raise NotFoundError(f"there is no catalog at {file}; make one with `partwise init`")
    engine = connect_engine(parsed)
    try:
        refuse_other_schema(engine)
    except BaseException:
        engine.dispose()
        raise
    return SqlCatalog(engine, clock)


def create_catalog(url: str, clock: Callable[[], datetime] = utc_now) -> SqlCatalog:
    """The catalog at `url`, made if it is not there and migrated if its schema is older.

    Raises
    ------
    ConfigError : the URL is not one that `open_catalog` takes.
    StoreError : its folder is missing, its schema is newer, or the database cannot be reached or written.
    """
    parsed = parsed_url(url)
    file = _sqlite_file(parsed)
    if file is not None and not file.parent.is_dir():
        raise StoreError(f"a catalog needs a folder to be in but {file.parent} is not one; create it first")
    engine = connect_engine(parsed)
    try:
        migrate(engine)
    except BaseException:
        engine.dispose()
        raise
    return SqlCatalog(engine, clock)


def _sqlite_file(url: URL) -> Path | None:
    return Path(url.database) if url.drivername == "sqlite" and url.database else None
