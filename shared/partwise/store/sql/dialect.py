"""What SQLite and PostgreSQL say differently, and batches small enough for both."""

from collections.abc import Iterable, Iterator, Sequence
from itertools import islice
from typing import TypeVar

from sqlalchemy import Connection, Table
from sqlalchemy.dialects import postgresql, sqlite

T = TypeVar("T")

_BATCH = 5_000  # ids in one statement: SQLite takes 32,766 parameters, PostgreSQL 65,535


def batches(values: Iterable[T], size: int = _BATCH) -> Iterator[Sequence[T]]:
    """The values in runs of at most `size`."""
    remaining = iter(values)
    while batch := list(islice(remaining, size)):
        yield batch


def insert_for(connection: Connection, table: Table) -> sqlite.Insert | postgresql.Insert:
    """An INSERT that can say ON CONFLICT, in the connection's dialect."""
    return postgresql.insert(table) if connection.dialect.name == "postgresql" else sqlite.insert(table)
