"""`ToolPool`: the tools in a few processes of their own, so that one big shape stalls neither requests nor the queue.

A call goes to a process that has its shape prepared if one is idle, else to the one idle longest. When all are busy it
waits in a bounded line, and so it does while another of the same person's runs: nobody has more than one process at a
time. A process that dies or takes too long costs the call it was at, and is started anew.
"""

import asyncio
import logging
import multiprocessing
import signal
import traceback
from collections import deque
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from multiprocessing.connection import Connection
from typing import Any

import numpy as np

from partwise.errors import PartwiseError
from partwise.store.open_arrays import open_array_store
from partwise_service.problems import ProblemError, ProblemKind
from partwise_service.security.at_once import RETRY_AFTER_S, AtOnce
from partwise_service.tool_calls import ToolCall, Workbench

_log = logging.getLogger(__name__)
Answering = Callable[[Connection, str, int], None]


@dataclass(frozen=True, slots=True)
class PoolLimits:
    """n_processes : tools that run at once. max_queued : calls that may wait. timeout_s : of a call that runs.

    max_own : calls of one person that run or wait.
    max_shapes : shapes that a process keeps prepared. abandoned_s : how much longer a call runs when its client has
    gone: mostly it was about to prepare a shape for the next call, which is worth having.
    """

    n_processes: int
    max_queued: int
    max_shapes: int
    timeout_s: float
    max_own: int = 3
    abandoned_s: float = 5.0


@dataclass(frozen=True, slots=True)
class Refused:
    """What a tool refused: an error of the domain's."""

    error: PartwiseError


@dataclass(frozen=True, slots=True)
class Failed:
    """What a tool did not foresee. missing : the package that it needs and this service lacks."""

    trace: str
    missing: str | None = None


def answer_calls(connection: Connection, array_url: str, max_prepared: int) -> None:
    """The life of a tool process: answers calls until the other end closes."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # the service ends its processes itself
    workbench = Workbench(open_array_store(array_url), max_prepared)
    while True:
        try:
            call = connection.recv()
        except EOFError:
            return
        try:
            connection.send(_outcome(workbench, call))
        except BrokenPipeError:
            return


def _outcome(workbench: Workbench, call: ToolCall) -> np.ndarray | Refused | Failed:
    try:
        return workbench.answer(call)
    except PartwiseError as error:
        return Refused(error)
    except ImportError as error:
        return Failed(traceback.format_exc(), error.name or "a package")
    except Exception:  # noqa: BLE001 # the call's edge: the process goes on with the next
        return Failed(traceback.format_exc())


class ToolProcess:
    """One process, started on its first call and again after it was lost. One thread at a time may use it."""

    def __init__(self, array_url: str, limits: PoolLimits, answering: Answering = answer_calls) -> None:
        self._context = multiprocessing.get_context("spawn")
        self._array_url = array_url
        self._limits = limits
        self._answering = answering
        self._process: Any = None
        self._connection: Connection | None = None
        self.mesh_hashes: deque[str] = deque(maxlen=limits.max_shapes)
        """Meshes of the last calls, which it probably has prepared."""

    @property
    def pid(self) -> int | None:
        """Of the process, None if none runs."""
        return None if self._process is None else self._process.pid

    def run(self, call: ToolCall) -> np.ndarray:
        """The tool's result. Waits for it.

        Raises what the tool refuses; problems: 503 if the process is lost, the tool takes too long, or lacks a package.
        """
        connection = self._started()
        self.mesh_hashes.append(call.mesh.mesh_hash)
        try:
            connection.send(call)
            if not connection.poll(self._limits.timeout_s):
                raise TimeoutError
            outcome = connection.recv()
        except (EOFError, OSError, TimeoutError) as error:
            self.stop()
            _log.exception("a tool's process was lost", extra={"call": type(call).__name__})
            raise _unavailable("The tool failed on this shape or took too long; try again, or use another.") from error
        if isinstance(outcome, Refused):
            raise outcome.error
        if isinstance(outcome, Failed):
            return _raise_failed(outcome)
        return outcome

    def stop(self) -> None:
        """Ends the process, whatever it is at."""
        process, connection = self._process, self._connection
        self._process = self._connection = None
        self.mesh_hashes.clear()
        if process is not None:
            process.kill()
            process.join()
        if connection is not None:
            connection.close()

    def give_up(self) -> None:
        """Ends the process under the thread that waits for it, which then raises as for any that is lost."""
        process = self._process
        if process is not None:
            process.kill()

    def _started(self) -> Connection:
        if self._connection is not None and self._process.is_alive():
            return self._connection
        self.stop()
        own, theirs = self._context.Pipe()
        # a mesh comes with what up to three tools prepare on it
        arguments = (theirs, self._array_url, 4 * self._limits.max_shapes)
        self._process = self._context.Process(target=self._answering, args=arguments, daemon=True, name="partwise-tool")
        self._process.start()
        theirs.close()  # so that the end of the process is the end of the pipe
        self._connection = own
        return own


@dataclass(frozen=True, slots=True, eq=False)
class _Waiting:
    """A place in the line, for a process that is given to this person's call."""

    person_id: int
    mesh_hash: str
    place: asyncio.Future[ToolProcess]


class ToolPool:
    """Runs calls for the event loop that it is used on.

    answering : what a process does; for tests.
    """

    def __init__(self, array_url: str, limits: PoolLimits, answering: Answering = answer_calls) -> None:
        self.limits = limits
        self._processes = [ToolProcess(array_url, limits, answering) for _ in range(limits.n_processes)]
        self._idle = deque(self._processes)
        self._line: deque[_Waiting] = deque()
        self._served: set[int] = set()
        """People who have a process at work."""
        self._own = AtOnce(limits.max_own, "calls of tools")
        self._threads = ThreadPoolExecutor(limits.n_processes, "partwise-tool")

    @property
    def n_waiting(self) -> int:
        """Calls in the line."""
        return len(self._line)

    @property
    def n_idle(self) -> int:
        """Processes without a call."""
        return len(self._idle)

    async def run(self, call: ToolCall, person_id: int) -> np.ndarray:
        """The tool's result. Cancelled, a call that waits is dropped, and one that runs ends soon, in vain.

        Raises what the tool refuses; problems with Retry-After: 503 if too many wait, 429 if too many of this person's
        do; 503 as `ToolProcess.run`.
        """
        with self._own.one_more(person_id):
            process = await self._next_free(person_id, call.mesh.mesh_hash)
            running = asyncio.get_running_loop().run_in_executor(self._threads, process.run, call)
            running.add_done_callback(lambda done: self._finished(process, person_id, done))
            try:
                return await asyncio.shield(running)
            except asyncio.CancelledError:
                asyncio.get_running_loop().call_later(self.limits.abandoned_s, _give_up_unless_done, process, running)
                raise

    def close(self) -> None:
        """Ends all processes; calls that run or wait fail."""
        for waiting in self._line:
            waiting.place.cancel()
        for process in self._processes:
            process.stop()
        self._threads.shutdown(wait=True, cancel_futures=True)

    async def _next_free(self, person_id: int, mesh_hash: str) -> ToolProcess:
        waiting = _Waiting(person_id, mesh_hash, asyncio.get_running_loop().create_future())
        self._line.append(waiting)
        self._hand_out()
        if not waiting.place.done() and len(self._line) > self.limits.max_queued:
            self._line.remove(waiting)
            raise _unavailable(f"All tools are busy and {len(self._line)} calls wait; try again in a moment.")
        try:
            return await waiting.place
        except asyncio.CancelledError:
            if waiting in self._line:
                self._line.remove(waiting)
            elif waiting.place.done() and not waiting.place.cancelled():  # it was given a process in this very moment
                self._give_back(waiting.place.result(), person_id)
            raise

    def _hand_out(self) -> None:
        """Gives idle processes to those who wait, in turn; whoever has one already waits on."""
        for waiting in list(self._line):
            if not self._idle:
                return
            if waiting.person_id not in self._served and not waiting.place.done():
                self._line.remove(waiting)
                self._served.add(waiting.person_id)
                waiting.place.set_result(self._taken(waiting.mesh_hash))

    def _taken(self, mesh_hash: str) -> ToolProcess:
        knowing = next((each for each in self._idle if mesh_hash in each.mesh_hashes), self._idle[0])
        self._idle.remove(knowing)
        return knowing

    def _finished(self, process: ToolProcess, person_id: int, done: "asyncio.Future[np.ndarray]") -> None:
        if not done.cancelled():
            done.exception()  # nobody may be left who asks for it
        self._give_back(process, person_id)

    def _give_back(self, process: ToolProcess, person_id: int) -> None:
        self._served.discard(person_id)
        self._idle.append(process)
        self._hand_out()


def _give_up_unless_done(process: ToolProcess, running: "asyncio.Future[np.ndarray]") -> None:
    if not running.done():
        process.give_up()


def _unavailable(detail: str) -> ProblemError:
    return ProblemError(ProblemKind.UNAVAILABLE, detail, headers={"Retry-After": str(RETRY_AFTER_S)})


def _raise_failed(failed: Failed) -> np.ndarray:
    if failed.missing is not None:
        _log.error("a tool lacks a package", extra={"package": failed.missing})
        raise ProblemError(
            ProblemKind.UNAVAILABLE, f"This tool needs {failed.missing}, which the service's machine lacks."
        )
    raise RuntimeError(f"a tool failed in its process:\n{failed.trace}")
