"""`Supervisor`: commands are kept running, and end together. Real processes, of quick commands."""

import os
import signal
import subprocess
import sys
import threading

import psutil
import pytest

from partwise_cli.supervisor import FIRST_PAUSE_S, Command, CommandEndedError, Supervisor

VERSION = Command("version", ["version"], ["version"])


class Lines:
    """What was shown; `stop_at` raises KeyboardInterrupt in the supervisor's clock once a line has the text."""

    def __init__(self, stop_at: str, times: int = 1) -> None:
        self.shown: list[str] = []
        self._stop_at = stop_at
        self._left = times
        self._skipped_s = 0.0
        self._lock = threading.Lock()

    def __call__(self, line: str) -> None:
        with self._lock:
            self.shown.append(line)
            self._left -= self._stop_at in line

    def clock(self) -> float:
        """Time flies, so that no pause is waited for."""
        if self._left <= 0:
            raise KeyboardInterrupt
        self._skipped_s += FIRST_PAUSE_S
        return self._skipped_s


@pytest.fixture
def children():
    """Processes that this one has started and that live."""
    return lambda: [child for child in psutil.Process().children() if child.status() != psutil.STATUS_ZOMBIE]


def test_a_command_that_ended_is_started_again() -> None:
    lines = Lines("ended with exit code 0; starts again", times=2)
    with pytest.raises(KeyboardInterrupt):
        Supervisor([VERSION], lines, lines.clock).run()
    assert lines.shown.count("version | 0.1.0") == 2


def test_a_wrong_command_ends_all(children) -> None:
    before = len(children())
    lines = Lines("never")
    with pytest.raises(CommandEndedError, match="worker ended with exit code 2") as ended:
        Supervisor([Command("worker", ["work", "--colour"], ["version"]), VERSION], lines).run()
    assert ended.value.code == 2
    assert len(children()) == before


def test_what_is_wrong_only_later_is_tried_again() -> None:
    lines = Lines("ended with exit code 2; starts again")
    with pytest.raises(KeyboardInterrupt):
        Supervisor([Command("version", ["version"], ["work", "--colour"])], lines, lines.clock).run()
    assert any("No such option" in line for line in lines.shown)


def test_a_child_ends_with_its_parent(tmp_path) -> None:
    """The parent is killed as soon as its child says that it runs."""
    program = (
        "import os, subprocess, sys\n"
        "child = subprocess.Popen([sys.executable, '-m', 'partwise_cli.child', str(os.getpid()), *sys.argv[1:]],"
        " stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)\n"
        "print(child.pid, flush=True)\n"
        "print(child.stdout.readline(), flush=True)\n"
        "child.wait()\n"
    )
    subprocess.run([sys.executable, "-m", "partwise_cli.child", str(os.getpid()), "init", str(tmp_path / "ws"), "-c",
                    "mugs", "--parts", "body"], check=True, capture_output=True)  # fmt: skip
    command = [sys.executable, "-c", program, "work", str(tmp_path / "ws")]
    with subprocess.Popen(command, stdout=subprocess.PIPE, text=True) as parent:
        child = psutil.Process(int(parent.stdout.readline()))
        assert "waits for jobs" in parent.stdout.readline()
        parent.send_signal(signal.SIGKILL)
        child.wait(timeout=60)


def test_a_child_without_its_parent_does_nothing(tmp_path) -> None:
    command = [sys.executable, "-m", "partwise_cli.child", "1", "version"]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    assert (done.returncode, done.stdout) == (1, "")
