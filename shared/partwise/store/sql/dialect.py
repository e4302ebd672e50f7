"""What SQLite and PostgreSQL say differently, and batches small enough for both."""

from collections.abc import Iterable, Iterator, Sequence
from datetime import datetime
from itertools import islice
from typing import Any, TypeVar

from sqlalchemy import Boolean, Connection, Table
from sqlalchemy.dialects import postgresql, sqlite
from sqlalchemy.ext.compiler import compiles
from sqlalchemy.sql.compiler import SQLCompiler
from sqlalchemy.sql.functions import FunctionElement

from partwise.store.tables.base import UtcDateTime

T = TypeVar("T")

_BATCH = 5_000  # ids in one statement: SQLite takes 32,766 parameters, PostgreSQL 65,535


def batches(values: Iterable[T], size: int = _BATCH) -> Iterator[Sequence[T]]:
    """The values in runs of at most `size`."""
    remaining = iter(values)
    while batch := list(islice(remaining, size)):
        yield batch


class has_in_it(FunctionElement[bool]):  # noqa: N801 # named like the functions of SQL that it stands beside
    """Whether a text has another in it: the letters A to Z in either case, all else as it is, no wildcards.

    Only these letters are alike in both databases, and a language's rules take twice as long as comparing bytes.
    """

    inherit_cache = True
    type = Boolean()


@compiles(has_in_it, "sqlite")
def _in_sqlite(element: has_in_it, compiler: SQLCompiler, **options: Any) -> str:
    text, part = (compiler.process(each, **options) for each in element.clauses)
    return f"instr(lower({text}), lower({part})) > 0"


@compiles(has_in_it, "postgresql")
def _in_postgresql(element: has_in_it, compiler: SQLCompiler, **options: Any) -> str:
    text, part = (compiler.process(each, **options) for each in element.clauses)
    return f'strpos(lower({text} COLLATE "C"), lower({part} COLLATE "C")) > 0'


class seconds_ago(FunctionElement[datetime]):  # noqa: N801 # as above
    """The database's own time, so many seconds ago: times that hosts compare with each other must be of one clock."""

    inherit_cache = True
    type = UtcDateTime()


@compiles(seconds_ago, "sqlite")
def _ago_in_sqlite(element: seconds_ago, compiler: SQLCompiler, **options: Any) -> str:
    (seconds,) = (compiler.process(each, **options) for each in element.clauses)
    return f"strftime('%Y-%m-%d %H:%M:%f', 'now', (0 - {seconds}) || ' seconds') || '000'"  # as times are held there


@compiles(seconds_ago, "postgresql")
def _ago_in_postgresql(element: seconds_ago, compiler: SQLCompiler, **options: Any) -> str:
    (seconds,) = (compiler.process(each, **options) for each in element.clauses)
    return f"now() - {seconds} * interval '1 second'"


def insert_for(connection: Connection, table: Table) -> sqlite.Insert | postgresql.Insert:
    """An INSERT that can say ON CONFLICT, in the connection's dialect."""
    return postgresql.insert(table) if connection.dialect.name == "postgresql" else sqlite.insert(table)
