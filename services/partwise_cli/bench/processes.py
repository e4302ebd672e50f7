"""Processor time and memory of this process and of those it has started, from Linux's /proc; nothing elsewhere."""

import os
from collections import defaultdict
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

DRIVER, ACTORS, SENTINELS = "driver", "actors", "sentinels"
PROC = Path("/proc")

ROLES = (
    ("StageWorker", ACTORS), ("Packer", "packer"), ("raylet", "Ray"), ("gcs_server", "Ray"), ("ray", "Ray"),
)  # fmt: skip
"""What a process is, by the first of these words that its command line has."""


@dataclass(frozen=True, slots=True)
class Process:
    """core_s : processor seconds so far, of all its threads."""

    pid: int
    role: str
    core_s: float


def processes() -> list[Process]:
    """This process, the driver, all that descend from it, and the actors' sentinels; empty where there is no /proc."""
    ticks_per_s = os.sysconf("SC_CLK_TCK")
    found = {pid: (parent, ticks) for pid, parent, ticks in _all()}
    children = defaultdict(list)
    for pid, (parent, _) in found.items():
        children[parent].append(pid)
    ours, mine = [], [os.getpid()] if os.getpid() in found else []
    while mine:
        pid = mine.pop()
        mine += children[pid]
        role = DRIVER if pid == os.getpid() else _role(pid)
        ours.append(Process(pid, role, found[pid][1] / ticks_per_s))
    # sentinels have left their actors: what they share is the pipe of what the actor prints
    pipes = {pipe for process in ours if process.role == ACTORS for pipe in _pipes(process.pid)}
    others = found.keys() - {process.pid for process in ours}
    watching = (pid for pid in others if "sentinel" in _command(pid) and pipes & _pipes(pid))
    return ours + [Process(pid, SENTINELS, found[pid][1] / ticks_per_s) for pid in watching]


def core_s_of(root: int) -> float:
    """Processor seconds so far of a process and all that descend from it; 0 where there is no /proc."""
    found = {pid: (parent, ticks) for pid, parent, ticks in _all()}
    ticks, open_ids = 0, {root} & found.keys()
    while open_ids:
        ticks += sum(found[pid][1] for pid in open_ids)
        open_ids = {pid for pid, (parent, _) in found.items() if parent in open_ids}
    return ticks / os.sysconf("SC_CLK_TCK")


def core_s_by_role(before: list[Process], after: list[Process]) -> dict[str, float]:
    """Processor seconds between two looks; those of processes that ended between them are lost."""
    earlier = {process.pid: process.core_s for process in before}
    spent: dict[str, float] = defaultdict(float)
    for process in after:
        spent[process.role] += process.core_s - earlier.get(process.pid, 0.0)
    return dict(spent)


def _all() -> Iterator[tuple[int, int, int]]:
    """(process, parent, ticks of processor time) of every process."""
    for path in PROC.glob("[0-9]*/stat"):
        try:
            fields = path.read_text(encoding="utf-8", errors="replace").rpartition(")")[2].split()
        except OSError:
            continue  # it has just ended
        yield int(path.parent.name), int(fields[1]), int(fields[11]) + int(fields[12])


def _role(pid: int) -> str:
    command = _command(pid)
    return next((role for word, role in ROLES if word in command), "others")


def _command(pid: int) -> str:
    try:
        return (PROC / str(pid) / "cmdline").read_bytes().decode(errors="replace")
    except OSError:
        return ""


def _pipes(pid: int) -> set[str]:
    try:
        names = [str(path.readlink()) for path in (PROC / str(pid) / "fd").iterdir()]
    except OSError:
        return set()
    return {name for name in names if name.startswith("pipe:")}
