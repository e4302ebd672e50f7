"""How a run over shapes looks: a view that renews itself on a terminal, plain lines elsewhere. On stderr."""

import sys
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager

import typer
from rich.console import Console, Group, RenderableType
from rich.live import Live
from rich.progress_bar import ProgressBar
from rich.table import Table
from rich.text import Text

from partwise.workspace.progress import RunProgress
from partwise_cli.run_tally import RunTally

LINE_S, LINE_SHARE, SILENCE_S = 10.0, 0.05, 60.0
"""Without a terminal: a line when 5 % more is done, but not within 10 s of the last one; one a minute in any case."""

REFRESH_PER_S = 4
BAR_WIDTH = 40


@contextmanager
def run_progress(title: str) -> Iterator[RunTally]:
    """A tally to be told of the run, shown while the block lasts. Nothing is shown of a run with nothing to do."""
    if sys.stderr.isatty():
        with _live(title) as tally:
            yield tally
        return
    lines = RunLines(title)
    yield lines
    lines.finish()


@contextmanager
def _live(title: str) -> Iterator[RunTally]:
    tally = RunTally()
    console = Console(stderr=True, highlight=False)
    with Live(get_renderable=lambda: view(title, tally), console=console, refresh_per_second=REFRESH_PER_S):
        yield tally


def view(title: str, tally: RunTally) -> RenderableType:
    """The whole view as it is now."""
    progress = tally.progress
    if not progress.n_total:
        return Text("")
    head = Table.grid(padding=(0, 1))
    bar = ProgressBar(total=progress.n_total, completed=tally.n_seen, width=BAR_WIDTH)
    count = f"{tally.n_seen:,}/{progress.n_total:,}"
    head.add_row(Text(title, style="bold"), bar, count, f"{tally.n_seen / progress.n_total:.0%}", Text(_pace(tally)))
    return Group(head, *([_stages(tally)] if tally.stages else []), Text(_state(tally), style="dim"))


def _stages(tally: RunTally) -> Table:
    table = Table(box=None, padding=(0, 2, 0, 2), header_style="dim")
    table.add_column("stage")
    table.add_column("done", justify="right")
    table.add_column("failed", justify="right")
    for stage, (n_done, n_failed) in tally.stages.items():
        table.add_row(stage, f"{n_done:,}", Text(f"{n_failed:,}", style="red" if n_failed else "dim"))
    return table


class RunLines(RunTally):
    """A tally that prints lines."""

    def __init__(
        self,
        title: str,
        show: Callable[[str], None] = lambda line: typer.echo(line, err=True),
        clock: Callable[[], float] = time.monotonic,
    ) -> None:
        super().__init__(clock)
        self._title = title
        self._show = show
        self._shown_at = clock()
        self._shown: RunProgress | None = None

    def on_progress(self, progress: RunProgress) -> None:
        before = self.progress
        super().on_progress(progress)
        if before.n_total not in (0, progress.n_total):
            self._shown = None  # a new round
        silent_s = self._clock() - self._shown_at
        n_shown = 0 if self._shown is None else self._shown.n_done + self._shown.n_failed
        is_much = self.n_seen - n_shown >= LINE_SHARE * progress.n_total
        if silent_s >= SILENCE_S or (silent_s >= LINE_S and is_much) or self.n_seen == progress.n_total:
            self._tell()

    def finish(self) -> None:
        """Says how far it came, unless the last line did."""
        self._tell()

    def _tell(self) -> None:
        if self.progress.n_total and self.progress != self._shown:
            self._shown, self._shown_at = self.progress, self._clock()
            parts = [f"{self.n_seen:,} of {self.progress.n_total:,}", _pace(self), _state(self)]
            self._show(f"{self._title}: " + " · ".join(part for part in parts if part))


def _pace(tally: RunTally) -> str:
    """Rate and time left, or the time it took."""
    parts = [] if tally.per_min is None else [f"{_rate(tally.per_min)} shapes/min"]
    if tally.n_seen == tally.progress.n_total:
        parts.append(f"in {duration(tally.elapsed_s)}")
    elif tally.left_s is not None:
        parts.append(f"{duration(tally.left_s)} left")
    return " · ".join(parts)


def _rate(per_min: float) -> str:
    return f"{per_min:.1f}" if per_min < 10 else f"{per_min:,.0f}"


def _state(tally: RunTally) -> str:
    is_over = tally.n_seen == tally.progress.n_total  # the last shape is counted before it is out of the run's hands
    parts = [f"{tally.n_in_flight:,} in flight"] if tally.n_in_flight and not is_over else []
    if tally.progress.n_failed:
        kinds = ", ".join(f"{kind.value} {n:,}" for kind, n in tally.failures.most_common())
        parts.append(f"{tally.progress.n_failed:,} failed" + (f" ({kinds})" if kinds else ""))
    if tally.n_restarted:
        parts.append(f"{tally.n_restarted:,} process{'es' if tally.n_restarted > 1 else ''} lost")
    if tally.n_recycled:
        parts.append(f"{tally.n_recycled:,} recycled")
    return " · ".join(parts)


def duration(seconds: float) -> str:
    """`45 s`, `12 min`, `3 h 05 min`, `12 days`."""
    if seconds < 90:
        return f"{seconds:.0f} s"
    minutes = round(seconds / 60)
    if minutes < 90:
        return f"{minutes} min"
    hours, minutes = divmod(minutes, 60)
    return f"{hours} h {minutes:02} min" if hours < 72 else f"{round(hours / 24)} days"
