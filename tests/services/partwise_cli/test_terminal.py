"""What commands show: single lines, tables as they are, progress that reads well in a log."""

import json
import logging

import pytest

from partwise.workspace.progress import RunProgress
from partwise_cli.logs import FieldFormatter, StderrHandler, configure_logging
from partwise_cli.terminal import (
    counted,
    error_line,
    print_json,
    print_table,
    progress,
    shape_progress,
    warning_lines,
)

Captured = pytest.CaptureFixture[str]


@pytest.mark.parametrize(("n", "text"), [(0, "0 shapes"), (1, "1 shape"), (2, "2 shapes"), (1000, "1,000 shapes")])
def test_counts_have_their_plural(n: int, text: str) -> None:
    assert counted(n, "shape") == text


def test_an_error_is_one_line_on_stderr(capsys: Captured) -> None:
    error_line("a\n  b")
    assert capsys.readouterr() == ("", "error: a b\n")


def test_warnings_are_a_line_each(capsys: Captured) -> None:
    warning_lines(["a\nb", "c"])
    assert capsys.readouterr().err == "warning: a b\nwarning: c\n"


def test_too_many_warnings_are_counted(capsys: Captured) -> None:
    warning_lines(["a", "b", "c"], most=2)
    assert capsys.readouterr().err == "warning: a\nwarning: b\nwarning: and 1 more\n"


def test_warnings_that_were_not_handed_in_are_counted(capsys: Captured) -> None:
    warning_lines(["a"], total=1200)
    assert capsys.readouterr().err == "warning: a\nwarning: and 1,199 more\n"


def test_json_is_one_line(capsys: Captured) -> None:
    print_json({"a": [1, "é"]})
    out = capsys.readouterr().out
    assert out.count("\n") == 1
    assert json.loads(out) == {"a": [1, "é"]}


def test_tables_show_cells_as_they_are(capsys: Captured) -> None:
    print_table("Shapes [of mine]", ("name", "n"), [("[bold]chair[/bold].off", "3"), ("x", "12")], right=(1,))
    out = capsys.readouterr().out
    assert "Shapes [of mine]" in out
    assert "[bold]chair[/bold].off │  3 │" in out


def test_without_a_terminal_progress_is_a_line_every_quarter(capsys: Captured) -> None:
    with progress("train") as advance:
        for done in range(101):
            advance(done, 100)
    assert capsys.readouterr().err.splitlines() == [f"train: {n} of 100" for n in (25, 50, 75, 100)]


def test_without_a_terminal_the_end_is_told_once(capsys: Captured) -> None:
    with progress("train") as advance:
        for done in (1, 3, 3):
            advance(done, 3)
    assert capsys.readouterr().err.splitlines() == ["train: 1 of 3", "train: 3 of 3"]


def test_nothing_to_do_has_no_progress(capsys: Captured) -> None:
    with shape_progress("preprocess") as on_run:
        on_run(RunProgress(0, 0, 0))
    assert capsys.readouterr().err == ""


def test_progress_over_shapes_counts_failures(capsys: Captured) -> None:
    with shape_progress("preprocess") as on_run:
        on_run(RunProgress(1, 0, 2))
        on_run(RunProgress(1, 1, 2))
    assert capsys.readouterr().err.splitlines() == ["preprocess: 1 of 2", "preprocess: 2 of 2 (1 failed)"]


def test_log_lines_have_the_fields_of_their_record() -> None:
    record = logging.makeLogRecord({"levelname": "WARNING", "msg": "attempt %d failed", "args": (1,), "shape": "a.off"})
    assert FieldFormatter().format(record) == "warning: attempt 1 failed (shape=a.off)"


def test_log_lines_without_fields_are_the_message() -> None:
    record = logging.makeLogRecord({"levelname": "INFO", "msg": "done"})
    assert FieldFormatter().format(record) == "info: done"


@pytest.mark.parametrize(("verbose", "lines"), [(False, ["warning: b"]), (True, ["info: a", "warning: b"])])
def test_verbose_shows_what_partwise_does(capsys: Captured, verbose: bool, lines: list[str]) -> None:
    configure_logging(verbose)
    logging.getLogger("partwise.store").info("a")
    logging.getLogger("partwise.store").warning("b")
    logging.getLogger("alembic").info("noise")
    assert capsys.readouterr().err.splitlines() == lines


def test_logging_is_configured_once() -> None:
    for _ in range(2):
        configure_logging(False)
    assert sum(isinstance(handler, StderrHandler) for handler in logging.getLogger().handlers) == 1
