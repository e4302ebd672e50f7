"""The process beside an actor, without Ray: what it makes of output, of memory, and of its actor's death."""

import json
import os
import signal
import subprocess
import sys
from dataclasses import dataclass
from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from partwise.store.open_arrays import open_array_store
from partwise_workers import sentinel
from partwise_workers.last_words import (
    LastWords,
    Progress,
    note_progress,
    progress_name,
    read_progress,
    take_last_words,
    take_progress,
)
from partwise_workers.sentinel import LOG_BYTES, MARK, Log, resident_bytes
from partwise_workers.tasks import StagedName

NAME = "last_words/first/1-k.actor"
PREAMBLE = f"""
import ctypes, os, subprocess, sys
from partwise_workers.watch import Sentinel
watch = Sentinel({{url!r}})
at = lambda memory_gb=8: watch.at({NAME!r}, memory_gb)
"""


@dataclass(frozen=True)
class Ended:
    """What became of a process with a sentinel. printed : what went on to where its output went before."""

    returncode: int
    words: LastWords | None
    printed: str


@pytest.fixture
def ended(tmp_path: Path):
    """Runs a script in a process that has a sentinel, until both have ended."""
    url = str(tmp_path / "arrays")
    arrays = open_array_store(url)

    def run(script: str) -> Ended:
        command = [sys.executable, "-c", PREAMBLE.format(url=url) + script]
        # the sentinel has this stderr, too: the output ends when both are gone
        process = subprocess.run(command, stderr=subprocess.PIPE, check=False)
        return Ended(process.returncode, take_last_words(arrays, NAME), process.stderr.decode())

    return run


def test_a_native_crash_is_told_with_its_traceback(ended) -> None:
    end = ended("at(); ctypes.string_at(0)")
    assert end.returncode == -signal.SIGSEGV
    assert end.words.fatal_error == "Segmentation fault"
    assert "Current thread" in end.words.log
    assert not end.words.is_over_memory


def test_a_process_over_its_ceiling_is_killed(ended) -> None:
    end = ended("at(0.4)\nkept = []\nwhile True: kept.append(b'x' * 10**7)")
    assert end.returncode == -signal.SIGKILL
    assert end.words.is_over_memory
    assert end.words.peak_bytes > 0.4e9


def test_a_ceiling_holds_while_native_code_keeps_the_interpreter(ended) -> None:
    end = ended("kept = b'x' * 5 * 10**8; at(0.4); ctypes.PyDLL(None).sleep(10**6)")
    assert end.words.is_over_memory


def test_no_ceiling_holds_while_the_process_is_idle(ended) -> None:
    end = ended("at(0.1); watch.idle(); kept = b'x' * 3 * 10**8")
    assert end.returncode in (0, -signal.SIGKILL)  # it may be seen at the moment between the two
    assert ended("kept = b'x' * 3 * 10**8").returncode == 0


def test_an_idle_process_dies_without_a_word(ended) -> None:
    assert ended("at(); watch.idle(); os._exit(3)") == Ended(3, None, "")


def test_output_of_python_and_of_native_code_is_kept_and_passed_on(ended) -> None:
    end = ended("at(); print('from python', flush=True); os.write(2, b'from below'); os._exit(1)")
    assert end.words.log == "from python\nfrom below"
    assert end.printed == "from python\nfrom below"


def test_only_the_last_steps_output_is_kept(ended) -> None:
    end = ended("at(); print('before', flush=True); at(); print('after', flush=True); os._exit(1)")
    assert end.words.log == "after"
    assert end.printed == "before\nafter\n"


def test_more_output_than_is_kept_does_not_block_the_process(ended) -> None:
    end = ended("at(); os.write(1, b'y' * 10**6); os._exit(1)")
    assert end.words.log == "y" * LOG_BYTES


def test_children_that_keep_the_output_open_do_not_keep_the_sentinel(ended) -> None:
    end = ended("at(); print(subprocess.Popen(['sleep', '600']).pid, flush=True); os._exit(1)")
    os.kill(int(end.words.log), signal.SIGKILL)


def test_a_process_whose_sentinel_is_gone_ends(ended) -> None:
    end = ended("ours, watch._pipe = os.pipe(); os.close(ours); at()")
    assert end.returncode == 1


def test_it_loads_little() -> None:
    heavy = ["dataclasses", "subprocess", "numpy", "partwise"]
    code = f"import runpy, sys; runpy.run_path({sentinel.__file__!r}); print([m for m in {heavy} if m in sys.modules])"
    bare = subprocess.run([sys.executable, "-I", "-S", "-c", code], stdout=subprocess.PIPE, check=True)
    assert bare.stdout == b"[]\n"


def marked(**told: str | int) -> bytes:
    return MARK + b"token" + json.dumps(told).encode() + b"\n"


@given(st.lists(st.integers(0, 120), max_size=6))
@settings(max_examples=30)
def test_what_is_told_is_found_however_the_pipe_cuts_it(cuts: list[int]) -> None:
    stream = b"a\x1eb" + marked(name="n", max_bytes=5) + b"c\x1etok\n\x1e"
    log = Log(b"token", os.open(os.devnull, os.O_WRONLY))
    for start, end in zip([0, *sorted(cuts)], [*sorted(cuts), len(stream)], strict=True):
        log.feed(stream[start:end])
    log.finish()
    assert log.task == {"name": "n", "max_bytes": 5}
    assert log.tail == b"c\x1etok\n\x1e"


def test_memory_of_this_process_is_seen() -> None:
    assert resident_bytes(os.getpid()) > 10**6


def test_memory_of_a_process_that_is_gone_is_none() -> None:
    gone = subprocess.Popen([sys.executable, "-c", ""])
    gone.wait()
    assert resident_bytes(gone.pid) == 0


def test_last_words_hold_no_zero_characters_and_no_list_of_modules() -> None:
    words = LastWords.of(b"\x00bad \xff\nExtension modules: numpy, x\nend", 1, False)
    assert words.log == "\ufffdbad \ufffd\nend"


def test_last_words_are_taken_once(tmp_path: Path) -> None:
    arrays = open_array_store(str(tmp_path))
    arrays.stage(NAME, LastWords("log", 5, True).arrays())
    assert take_last_words(arrays, NAME) == LastWords("log", 5, True)
    assert take_last_words(arrays, NAME) is None


def test_the_step_last_begun_is_found(tmp_path: Path) -> None:
    arrays, name = open_array_store(str(tmp_path)), StagedName("remesh", 3, "ab")
    note_progress(arrays, name, "af", Progress("attempt 0", 0.5, {}))
    second = Progress("attempt 1", 20.5, {"attempt 0": {"refused": "too far"}})
    note_progress(arrays, name, "af", second)
    assert read_progress(arrays, name, "af") == second
    assert take_progress(arrays, name, "af") == second
    assert take_progress(arrays, name, "af") is None


def test_a_damaged_step_counts_as_none(tmp_path: Path) -> None:
    arrays, name = open_array_store(str(tmp_path)), StagedName("remesh", 3, "ab")
    note_progress(arrays, name, "af", Progress("attempt 0", 0.5, {}))
    (tmp_path / "staging" / progress_name(name, "af")).write_bytes(b"half")
    assert take_progress(arrays, name, "af") is None


def test_two_actors_do_not_share_a_step(tmp_path: Path) -> None:
    arrays, name = open_array_store(str(tmp_path)), StagedName("remesh", 3, "ab")
    for number, actor_id in enumerate(("af", "be")):
        note_progress(arrays, name, actor_id, Progress(f"attempt {number}", 0.5, {}))
    steps = [read_progress(arrays, name, actor_id) for actor_id in ("af", "be")]
    assert [progress.step for progress in steps if progress] == ["attempt 0", "attempt 1"]
