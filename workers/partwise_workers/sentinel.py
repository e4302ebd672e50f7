"""The small process beside an actor: it bounds its memory, keeps its log, and survives it to tell the last words.

Native code takes whole processes down, and holds the interpreter while it hangs, so that nothing inside the process can
be relied on. This one reads the pipe to which the actor's stdout and stderr go, passes everything on to where they went
before, and looks at the actor's memory. `Watch` in `watch.py` is the actor's end of it.

Run as a script by a bare interpreter (`-I -S`), it imports the standard library's small modules only: it is there in
tens of milliseconds and stays near 10 MB. The array store is imported when the actor is dead.
"""

import contextlib
import json
import os
import select
import signal
import sys

SAMPLE_MS = 100
READ_BYTES = 65536
MAX_READS = 16
"""Before memory is looked at again, however much is printed."""

LOG_BYTES = 8192
"""Of a step's log that are kept, the last ones."""

FAREWELL_S = 30
"""Seconds after its actor's death in which this process ends, whatever the store does."""

MARK = b"\x1e"
"""Begins a line of the actor for its sentinel, among all that is printed: MARK, the token, JSON, end of line."""


def main() -> None:
    """Reads its settings from stdin, leaves its parent, watches, and tells the last words."""
    settings = json.loads(sys.stdin.buffer.readline())
    death = _death_of(settings["actor_pid"])
    if os.fork():
        os._exit(0)  # Ray ends the children of an actor with it; a process whose parent is gone is nobody's child
    log = Log(settings["token"].encode(), forward_to=sys.stderr.fileno())
    is_over = watch(settings["actor_pid"], death, settings["log_fd"], log)
    if log.task is not None:
        signal.alarm(FAREWELL_S)
        sys.path[:] = settings["path"]
        _tell(settings["array_url"], str(log.task["name"]), log, is_over)


class Log:
    """What the actor prints, passed on; the tail of its present step is kept, and what the actor says of itself.

    task : what the actor says that it is at: the name for its last words and its ceiling `max_bytes`; None when idle.
    peak_bytes : most memory seen since the task began.
    """

    def __init__(self, token: bytes, forward_to: int) -> None:
        self._mark = MARK + token
        self._forward_to = forward_to
        self._rest = b""
        self.tail = b""
        self.task: dict[str, str | int] | None = None
        self.peak_bytes = 0

    def feed(self, data: bytes) -> None:
        """Takes what the pipe had."""
        data = self._rest + data
        while (at := data.find(self._mark)) >= 0 and (end := data.find(b"\n", at)) >= 0:
            self._keep(data[:at])
            self._heed(json.loads(data[at + len(self._mark) : end]))
            data = data[end + 1 :]
        cut = at if at >= 0 else _start_of_mark(data, self._mark)
        self._keep(data[:cut])
        self._rest = data[cut:]

    def finish(self) -> None:
        """Takes what looked like the beginning of a line for the sentinel."""
        self._keep(self._rest)
        self._rest = b""

    def _heed(self, told: dict[str, str | int]) -> None:
        self.tail = b""
        if self.task is None or self.task["name"] != told.get("name"):
            self.peak_bytes = 0
        self.task = told or None

    def _keep(self, data: bytes) -> None:
        self.tail = (self.tail + data)[-LOG_BYTES:]
        with contextlib.suppress(OSError):  # a full disk must not end the watch
            os.write(self._forward_to, data)


def _start_of_mark(data: bytes, mark: bytes) -> int:
    """Where a mark that is not whole yet begins at the end of the data; its length if there is none."""
    at = data.rfind(mark[:1])
    return at if at >= 0 and mark.startswith(data[at:]) else len(data)


def watch(actor_pid: int, death: int | None, log_fd: int, log: Log) -> bool:
    """Returns when the actor is dead: whether it was killed here, for its memory."""
    os.set_blocking(log_fd, False)
    poll = select.poll()
    poll.register(log_fd, select.POLLIN)
    if death is not None:
        poll.register(death, select.POLLIN)
    is_over = False
    while True:
        events = dict(poll.poll(SAMPLE_MS))
        is_dead = death in events or not _is_alive(actor_pid)
        for _ in range(MAX_READS):  # after the look at the process: what it had written is here by now
            if not (data := _read(log_fd)):
                break
            log.feed(data)
        if is_dead:
            log.finish()
            return is_over
        if events.get(log_fd, 0) & select.POLLHUP:  # the actor closed its own output and lives
            poll.unregister(log_fd)
        log.peak_bytes = max(log.peak_bytes, resident_bytes(actor_pid))
        if log.task is not None and log.peak_bytes > int(log.task["max_bytes"]):
            is_over = True
            _kill(actor_pid, death)


def _read(log_fd: int) -> bytes:
    try:
        return os.read(log_fd, READ_BYTES)
    except BlockingIOError:
        return b""


def resident_bytes(pid: int) -> int:
    """Memory of a process in RAM; 0 if it is gone."""
    try:
        with open(f"/proc/{pid}/statm", "rb") as file:  # noqa: PTH123 - pathlib takes a process twice its size
            return int(file.read().split()[1]) * os.sysconf("SC_PAGE_SIZE")
    except OSError:
        return 0 if sys.platform == "linux" else _resident_bytes_elsewhere(pid)


def _resident_bytes_elsewhere(pid: int) -> int:
    import psutil

    try:
        return int(psutil.Process(pid).memory_info().rss)
    except psutil.Error:
        return 0


def _death_of(pid: int) -> int | None:
    """A descriptor that is ready when the process is dead; None where the system has no such thing."""
    try:
        return os.pidfd_open(pid)
    except (AttributeError, OSError):
        return None


def _is_alive(pid: int) -> bool:
    try:
        os.kill(pid, 0)
    except ProcessLookupError:
        return False
    return True


def _kill(pid: int, death: int | None) -> None:
    with contextlib.suppress(ProcessLookupError):
        if death is not None:
            signal.pidfd_send_signal(death, signal.SIGKILL)  # unlike the number, never another process's
        else:
            os.kill(pid, signal.SIGKILL)


def _tell(array_url: str, name: str, log: Log, is_over: bool) -> None:
    """Puts the last words into the array store; this takes a second, as the store's libraries are loaded first."""
    from partwise.store.open_arrays import open_array_store
    from partwise_workers.last_words import LastWords

    words = LastWords.of(log.tail, log.peak_bytes, is_over)
    open_array_store(array_url).stage(name, words.arrays())


if __name__ == "__main__":
    main()
