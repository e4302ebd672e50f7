"""Help: a line and an example for every command, and nothing heavy loaded to show it."""

import re
import shlex
import subprocess
import sys
from typing import Any

import pytest
import typer

from partwise_cli.main import app

HEAVY = {
    "torch", "ray", "numba", "cv2", "scipy", "sklearn", "sqlalchemy", "alembic", "zarr", "trimesh", "pyrender",
    "embreex", "pymeshlab", "PIL", "concurrent.futures.process",
}  # fmt: skip


def _commands(group: Any, path: tuple[str, ...] = ()) -> dict[str, Any]:
    """Every command by its full name, groups of commands included."""
    found = {}
    for name, command in group.commands.items():
        found[" ".join((*path, name))] = command
        if hasattr(command, "commands"):
            found.update(_commands(command, (*path, name)))
    return found


COMMANDS = _commands(typer.main.get_command(app))


def _example(command: Any) -> list[str]:
    found = re.search(r"\[dim\](.+)\[/dim\]$", command.help or "")
    assert found, f"{command.name} has no example"
    return shlex.split(found[1])


def test_the_commands_are_these() -> None:
    assert set(COMMANDS) == {
        "init", "settings", "ingest", "preprocess", "retry", "status", "gc", "migrate", "import", "confirm", "export",
        "segment", "segment patches", "segment refine", "segment replay",
        "train", "evaluate", "refine", "select", "queue", "serve", "up", "work", "token", "token create", "token list",
        "token revoke", "reviews", "reviews list", "reviews accept", "simulate", "demo", "doctor", "version", "bench",
        "bench describe", "bench service-tools",
        "bench loo", "bench remeshing", "bench calibration", "bench scheduling", "bench throughput", "bench toolbox",
        "bench load", "bench page",
    }  # fmt: skip


@pytest.mark.parametrize("name", sorted(COMMANDS))
def test_help_is_one_line_with_an_example(name: str) -> None:
    assert re.fullmatch(r"[A-Z][^\n]*\.  \[dim\]partwise [^\n]+\[/dim\]", COMMANDS[name].help)


@pytest.mark.parametrize("name", sorted(COMMANDS))
def test_the_example_is_a_valid_use_of_the_command(name: str) -> None:
    partwise, *words = _example(COMMANDS[name])
    assert partwise == "partwise"
    assert " ".join(words).startswith(name)
    arguments, command = words, typer.main.get_command(app)
    while hasattr(command, "commands"):
        command, arguments = command.commands[arguments[0]], arguments[1:]
    command.make_context("partwise", arguments)  # raises for a missing argument, an unknown option, a bad value


def test_each_command_takes_one_line_on_a_narrow_terminal(invoke, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("COLUMNS", "80")
    text = invoke("--help").output
    shown = {line.strip("│ ").split()[0]: line for line in text.splitlines() if "partwise " in line and "│" in line}
    for name, command in COMMANDS.items():
        if " " not in name:
            assert shlex.join(_example(command)) in shown[name]


def test_help_explains_the_exit_codes(invoke) -> None:
    text = " ".join(invoke("--help").output.split())
    for code in (
        "0 done",
        "1 done, but some",
        "2 wrong usage",
        "3 wrong input",
        "4 a store",
        "70 a fault",
        "130 interr",
    ):
        assert code in text


@pytest.mark.parametrize("name", sorted(COMMANDS))
def test_every_option_is_explained(name: str) -> None:
    assert [each.name for each in COMMANDS[name].params if not getattr(each, "help", None)] == []


@pytest.mark.parametrize("arguments", [["--help"], ["preprocess", "--help"], ["bench", "loo", "--help"], ["version"]])
def test_showing_help_loads_nothing_heavy(arguments: list[str]) -> None:
    program = (
        f"import sys; sys.argv = ['partwise', *{arguments}]\n"
        "from partwise_cli.main import main\n"
        "try: main()\n"
        "except SystemExit as stop: assert stop.code == 0\n"
        "sys.stderr.write(' '.join(sys.modules))"
    )
    ended = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, check=True)
    assert HEAVY.isdisjoint(ended.stderr.split())
