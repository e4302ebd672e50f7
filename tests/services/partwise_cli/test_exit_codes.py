"""The true command in a process of its own: its exit codes mean what its help says."""

import signal
import subprocess
import sys
from pathlib import Path

import pytest

from partwise import __version__

WAITING = """
import signal, sys
from partwise_cli import main as module
@module.app.command()
def wait() -> None:
    print("ready", flush=True)
    signal.pause()
sys.argv = ["partwise", "wait"]
module.main()
"""
BROKEN = """
import sys
from partwise_cli import main as module
@module.app.command()
def break_down() -> None:
    raise {error}
sys.argv = ["partwise", "break-down"]
module.main()
"""


def _one_line(ended: "subprocess.CompletedProcess[str]", *words: str) -> None:
    assert ended.stderr.startswith("error: ")
    assert ended.stderr.count("\n") == 1
    assert [word for word in words if word not in ended.stderr] == []


def test_0_is_done(run) -> None:
    ended = run("version")
    assert (ended.returncode, ended.stdout, ended.stderr) == (0, f"{__version__}\n", "")


def test_1_is_done_but_some_failed(run, empty: Path) -> None:
    (empty.parent / "in").mkdir()
    (empty.parent / "in" / "a.off").write_bytes(b"")
    ended = run("ingest", empty, "in")
    assert ended.returncode == 1
    *_, last = ended.stderr.splitlines()
    assert last == "warning: a.off: a mesh file must have content but is empty; was the download cut off?"
    assert ended.stdout == "0 shapes added, 0 unchanged, 0 changed, 1 file refused\n"


@pytest.mark.parametrize("arguments", [["fly"], ["queue"], ["queue", "ws", "--score", "beauty"], []])
def test_2_is_wrong_usage(run, arguments: list[str]) -> None:
    ended = run(*arguments)
    assert ended.returncode == 2
    assert "Usage: partwise" in ended.stdout + ended.stderr
    assert "Traceback" not in ended.stderr


def test_3_is_wrong_input(run, tmp_path: Path) -> None:
    ended = run("status", "nowhere")
    assert ended.returncode == 3
    _one_line(ended, "nowhere/partwise.toml is missing", "partwise init")


def test_4_is_a_store_out_of_reach(run, empty: Path) -> None:
    (empty / "catalog.sqlite").write_bytes(b"this is not a database, whatever its name says" * 100)
    ended = run("status", empty)
    assert ended.returncode == 4
    _one_line(ended, "catalog.sqlite", "is not a database", "restore it from a backup")


def test_130_is_interrupted() -> None:
    process = subprocess.Popen(
        [sys.executable, "-c", WAITING], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True
    )
    assert process.stdout is not None
    assert process.stdout.readline() == "ready\n"
    process.send_signal(signal.SIGINT)
    _, err = process.communicate(timeout=60)
    assert process.returncode == 130
    assert err == "error: interrupted; what was finished is kept: run the same command again to go on\n"


def _broken(error: str) -> "subprocess.CompletedProcess[str]":
    program = BROKEN.format(error=error)
    return subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, timeout=60)


def test_70_is_a_fault_with_its_traceback() -> None:
    ended = _broken("KeyError('colour')")
    assert ended.returncode == 70
    assert "Traceback" in ended.stderr
    assert ended.stderr.splitlines()[-1].startswith("error: a fault in partwise, please report it")


def test_a_full_disk_that_nobody_foresaw_is_one_line() -> None:
    ended = _broken("OSError(28, 'No space left on device', '/scratch/x')")
    assert ended.returncode == 4
    _one_line(ended, "/scratch/x", "the disk is full", "free some space")


def test_a_message_of_several_lines_becomes_one() -> None:
    ended = _broken("__import__('partwise.errors').errors.LabelError('a\\nb')")
    assert ended.returncode == 3
    assert ended.stderr == "error: a b\n"


def test_a_reader_that_stops_reading_is_no_fault(refined: Path) -> None:
    command = f"{Path(sys.executable).with_name('partwise')} queue {refined} | true"
    ended = subprocess.run(["bash", "-c", command], capture_output=True, text=True, timeout=60)
    assert ended.stderr == ""
