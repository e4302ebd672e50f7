"""What SQLite and PostgreSQL say differently, and batches small enough for both."""

from collections.abc import Iterable, Iterator, Sequence
from itertools import islice
from typing import Any, TypeVar

from sqlalchemy import Boolean, Connection, Table
from sqlalchemy.dialects import postgresql, sqlite
from sqlalchemy.ext.compiler import compiles
from sqlalchemy.sql.compiler import SQLCompiler
from sqlalchemy.sql.functions import FunctionElement

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


def insert_for(connection: Connection, table: Table) -> sqlite.Insert | postgresql.Insert:
    """An INSERT that can say ON CONFLICT, in the connection's dialect."""
    return postgresql.insert(table) if connection.dialect.name == "postgresql" else sqlite.insert(table)
