"""What the command line shows: one line for an error, tables, and progress that also reads well in a log file."""

import json
import sys
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from typing import TYPE_CHECKING, Protocol

import typer
from rich.console import Console
from rich.progress import (
    BarColumn,
    MofNCompleteColumn,
    Progress,
    TextColumn,
    TimeElapsedColumn,
    TimeRemainingColumn,
)
from rich.table import Table
from rich.text import Text

from partwise.workspace.progress import RunProgress

if TYPE_CHECKING:
    from partwise.workspace.relabel import MoveReport

PLAIN_STEP = 0.25
"""Share of the work between two lines where there is no terminal."""


class Advance(Protocol):
    """Tells how much is done of how much, with a short note."""

    def __call__(self, done: int, total: int, note: str = "") -> None: ...


def console() -> Console:
    """A console on today's stdout; wide enough for tables when there is no terminal."""
    return Console(file=sys.stdout, highlight=False, width=None if sys.stdout.isatty() else 120)


def error_line(message: str) -> None:
    """One line on stderr, whatever the message holds."""
    typer.secho(f"error: {' '.join(message.split())}", fg=typer.colors.RED, err=True)


def warning_lines(messages: Sequence[str], total: int | None = None, most: int = 20) -> None:
    """A line each on stderr, at most so many; then how many more there are, of `total` if not all are given."""
    for message in messages[:most]:
        typer.secho(f"warning: {' '.join(message.split())}", fg=typer.colors.YELLOW, err=True)
    n_more = (len(messages) if total is None else total) - min(len(messages), most)
    if n_more > 0:
        typer.secho(f"warning: and {n_more:,} more", fg=typer.colors.YELLOW, err=True)


def counted(n: int, noun: str) -> str:
    """`1 shape`, `2 shapes`, `1,000 shapes`."""
    return f"{n:,} {noun}" if n == 1 else f"{n:,} {noun}s"


def moved_line(moves: "MoveReport") -> None:
    """What became of labels whose shapes have another mesh now; nothing where there were none."""
    if moves.n_moved or moves.n_failed:
        typer.echo(
            f"labels of {counted(moves.n_moved, 'shape')} moved to the working mesh: "
            f"{moves.n_in_review:,} to be reviewed, {moves.n_failed:,} failed"
        )


def print_json(value: object) -> None:
    """One JSON document on one line of stdout."""
    typer.echo(json.dumps(value))


def print_table(title: str, columns: Sequence[str], rows: Sequence[Sequence[str]], right: Sequence[int] = ()) -> None:
    """A table with a title; the columns numbered in `right` are set right."""
    table = Table(title=Text(title), title_justify="left", title_style="bold", header_style="bold")
    for number, column in enumerate(columns):
        table.add_column(column, justify="right" if number in right else "left", overflow="fold")
    for row in rows:
        table.add_row(*(Text(cell) for cell in row))  # as it is: a file's name may have [brackets]
    console().print(table)


@contextmanager
def progress(title: str) -> Iterator[Advance]:
    """A bar with elapsed and remaining time on a terminal, a line every quarter elsewhere. On stderr."""
    if sys.stderr.isatty():
        with _bar(title) as advance:
            yield advance
    else:
        yield _plain(title)


@contextmanager
def shape_progress(title: str) -> Iterator[Callable[[RunProgress], None]]:
    """As `progress`, for a run over shapes: says how many failed."""
    with progress(title) as advance:
        yield lambda run: advance(
            run.n_done + run.n_failed, run.n_total, f"({run.n_failed} failed)" if run.n_failed else ""
        )


@contextmanager
def _bar(title: str) -> Iterator[Advance]:
    columns = (
        TextColumn("{task.description:<11}"), BarColumn(), MofNCompleteColumn(), TimeElapsedColumn(),
        TextColumn("[dim]left[/dim]"), TimeRemainingColumn(), TextColumn("{task.fields[note]}"),
    )  # fmt: skip
    with Progress(*columns, console=Console(stderr=True)) as bars:
        task = bars.add_task(title, total=None, note="")
        yield lambda done, total, note="": bars.update(task, completed=done, total=total, note=note)


def _plain(title: str) -> Advance:
    shown = 0.0

    def advance(done: int, total: int, note: str = "") -> None:
        nonlocal shown
        if done < shown * total:  # a new round under the same title
            shown = 0.0
        if total and (done >= (shown + PLAIN_STEP) * total or done == total > shown * total):
            shown = done / total
            typer.echo(f"{title}: {done} of {total} {note}".rstrip(), err=True)

    return advance
