"""`Supervisor`: keeps a few commands running as processes of their own, and ends them together."""

import os
import subprocess
import sys
import threading
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import IO

from partwise_cli.failures import INPUT_ERROR

POLL_S = 0.2
STOP_S = 15.0
"""Seconds that a command has to end before it is killed."""
FIRST_PAUSE_S, MAX_PAUSE_S = 1.0, 60.0
"""Before a command is started again; twice as long each time, unless it ran for `MAX_PAUSE_S`."""
USAGE_ERROR = 2
LASTING = (USAGE_ERROR, INPUT_ERROR)
"""Exit codes with which a command would only end again."""


@dataclass(frozen=True, slots=True)
class Command:
    """first, again : what is run, as arguments of `partwise`, at first and when it had ended."""

    name: str
    first: Sequence[str]
    again: Sequence[str]


class CommandEndedError(Exception):
    """A command cannot be kept running. code : its exit code."""

    def __init__(self, name: str, code: int) -> None:
        super().__init__(f"{name} ended with exit code {code}")
        self.code = code


class _Child:
    """A command and the process that it is in now, if it is in one."""

    def __init__(self, command: Command, show: Callable[[str], None], clock: Callable[[], float]) -> None:
        self._command = command
        self._show = show
        self._clock = clock
        self._process: subprocess.Popen[str] | None = None
        self._reader: threading.Thread | None = None
        self._n_starts = 0
        self._started_at = self._start_at = clock()
        self._pause_s = FIRST_PAUSE_S

    def look(self) -> None:
        """Starts it if it is time; notices that it has ended.

        Raises
        ------
        CommandEndedError : it ended the first time because of what it was told.
        """
        if self._process is None:
            if self._clock() >= self._start_at:
                self._start()
            return
        code = self._process.poll()
        if code is None:
            return
        self._collect()
        if self._n_starts == 1 and code in LASTING:
            raise CommandEndedError(self._command.name, code)
        now = self._clock()
        if now - self._started_at >= MAX_PAUSE_S:
            self._pause_s = FIRST_PAUSE_S
        self._start_at = now + self._pause_s
        self._line(f"ended with exit code {code}; starts again in {self._pause_s:g} s")
        self._pause_s = min(2 * self._pause_s, MAX_PAUSE_S)

    def ask_to_end(self) -> None:
        if self._process is not None:
            self._process.terminate()

    def end(self, until: float) -> None:
        """Waits for its end, and kills it when its time is over."""
        if self._process is None:
            return
        try:
            self._process.wait(max(0.0, until - self._clock()))
        except subprocess.TimeoutExpired:
            self._line("does not end; it is killed")
            self._process.kill()
            self._process.wait()
        self._collect()

    def _start(self) -> None:
        arguments = self._command.again if self._n_starts else self._command.first
        self._process = subprocess.Popen(  # noqa: S603 - our own command
            [sys.executable, "-m", "partwise_cli.child", str(os.getpid()), *arguments],
            stdin=subprocess.DEVNULL,
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            text=True,
            errors="replace",
            env={**os.environ, "PYTHONUNBUFFERED": "1"},
            start_new_session=True,  # Ctrl-C is for the supervisor, which passes it on once
        )
        self._n_starts += 1
        self._started_at = self._clock()
        self._reader = threading.Thread(target=self._read, args=(self._process.stdout,), daemon=True)
        self._reader.start()

    def _read(self, output: IO[str]) -> None:
        for line in output:
            self._line(line.rstrip("\n"))

    def _collect(self) -> None:
        if self._reader is not None:
            self._reader.join(STOP_S)  # grandchildren may hold the pipe open
        self._process = None

    def _line(self, text: str) -> None:
        self._show(f"{self._command.name:<7} | {text}")


class Supervisor:
    """show : takes each line that the commands print, with the command's name before it; from several threads."""

    def __init__(
        self,
        commands: Sequence[Command],
        show: Callable[[str], None],
        clock: Callable[[], float] = time.monotonic,
    ) -> None:
        self._clock = clock
        self._children = [_Child(command, show, clock) for command in commands]

    def run(self) -> None:
        """Keeps the commands running until it is interrupted; then all have ended.

        Raises
        ------
        CommandEndedError : one cannot be run as it was told; the others have ended, too.
        """
        pause = threading.Event()
        try:
            while True:
                for child in self._children:
                    child.look()
                pause.wait(POLL_S)
        finally:
            self._end()

    def _end(self) -> None:
        for child in self._children:
            child.ask_to_end()
        until = self._clock() + STOP_S
        for child in self._children:
            child.end(until)
