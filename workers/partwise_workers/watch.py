"""The actor's end of its sentinel: starts it, sends it all output, tells it what the actor is at."""

import faulthandler
import json
import os
import subprocess
import sys
import uuid
from pathlib import Path
from typing import Protocol

from partwise_workers import sentinel
from partwise_workers.sentinel import MARK

BYTES_PER_GB = 1e9


class Watch(Protocol):
    """What watches over an actor's process."""

    def at(self, name: str, memory_gb: float) -> None:
        """From now on the process is at something: where its last words go if it dies, and its ceiling."""

    def idle(self) -> None:
        """From now on the process is at nothing, and may die without a word."""


class Unwatched:
    """For stages that run in a process of somebody else's, such as a test's."""

    def at(self, name: str, memory_gb: float) -> None:
        pass

    def idle(self) -> None:
        pass


class Sentinel:
    """Takes over stdout and stderr of this process for good: one for each process, started by it."""

    def __init__(self, array_url: str) -> None:
        self._token = uuid.uuid4().hex
        ours, self._pipe = os.pipe()
        settings = {
            "actor_pid": os.getpid(),
            "log_fd": ours,
            "token": self._token,
            "array_url": array_url,
            "path": sys.path,
        }
        command = [sys.executable, "-I", "-S", str(Path(sentinel.__file__))]
        process = subprocess.Popen(  # noqa: S603 - our own script
            command, stdin=subprocess.PIPE, pass_fds=(ours,), start_new_session=True
        )
        process.communicate(json.dumps(settings).encode() + b"\n")  # returns as soon as it has left this process
        os.close(ours)
        if process.returncode:
            raise OSError(f"the process that watches memory must start but ended with {process.returncode}")
        os.dup2(self._pipe, 1)
        os.dup2(self._pipe, 2)
        faulthandler.enable(file=2)

    def at(self, name: str, memory_gb: float) -> None:
        self._tell({"name": name, "max_bytes": int(memory_gb * BYTES_PER_GB)})

    def idle(self) -> None:
        self._tell({})

    def _tell(self, words: dict[str, str | int]) -> None:
        """One write, shorter than what a pipe takes at once, so that it is not torn by other output."""
        line = MARK + self._token.encode() + json.dumps(words).encode() + b"\n"
        try:
            os.write(self._pipe, line)
        except BrokenPipeError:
            os._exit(1)  # nobody watches any more, and whatever is printed would fail: the driver starts another
