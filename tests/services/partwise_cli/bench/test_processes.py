"""Processor time by what a process is."""

import os
import subprocess
import sys

import pytest

from partwise_cli.bench.processes import ACTORS, DRIVER, SENTINELS, Process, core_s_by_role, core_s_of, processes

pytestmark = pytest.mark.skipif(sys.platform != "linux", reason="needs /proc")

WAIT = "import os, sys; sys.stdin.read()"


def test_this_process_is_the_driver() -> None:
    (driver,) = [process for process in processes() if process.role == DRIVER]
    assert driver.core_s > 0


def test_what_it_started_is_told_by_its_command_line() -> None:
    with subprocess.Popen([sys.executable, "-c", WAIT, "ray::_Packer.pack"], stdin=subprocess.PIPE) as child:
        roles = {process.pid: process.role for process in processes()}
        child.communicate(b"")
    assert roles[child.pid] == "packer"


def test_a_sentinel_is_found_by_the_pipe_that_it_reads() -> None:
    # the actor writes into a pipe that a process which has left the family reads from
    leave = "import os, sys; os.fork() and os._exit(0); os.setsid(); sys.stdin.read()"
    reader = subprocess.Popen([sys.executable, "-c", leave, "sentinel.py"], stdin=subprocess.PIPE)
    reader.wait()
    with subprocess.Popen(
        [sys.executable, "-c", WAIT, "ray::_StageWorker.run"], stdin=subprocess.PIPE, stdout=reader.stdin
    ) as actor:
        roles = {process.pid: process.role for process in processes()}
        actor.communicate(b"")
    reader.stdin.close()
    assert roles[actor.pid] == ACTORS
    assert SENTINELS in roles.values()


def test_time_is_that_between_two_looks() -> None:
    before = [Process(1, DRIVER, 2.0), Process(2, ACTORS, 1.0), Process(3, ACTORS, 9.0)]
    after = [Process(1, DRIVER, 2.5), Process(2, ACTORS, 4.0), Process(4, ACTORS, 0.25)]
    assert core_s_by_role(before, after) == {DRIVER: 0.5, ACTORS: 3.25}


def test_time_of_a_process_counts_those_that_it_started() -> None:
    before = core_s_of(os.getpid())
    burn = "import time\nwhile time.process_time() < 0.3: pass\nprint(flush=True)\ninput()"
    with subprocess.Popen([sys.executable, "-c", burn], stdin=subprocess.PIPE, stdout=subprocess.PIPE) as child:
        child.stdout.readline()
        spent_s, ours_s = core_s_of(child.pid), core_s_of(os.getpid())
        child.communicate(b"\n")
    assert spent_s >= 0.25  # in ticks of the clock
    assert ours_s - before >= 0.25
    assert core_s_of(child.pid) == 0.0
