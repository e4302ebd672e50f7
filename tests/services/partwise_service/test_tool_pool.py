"""The pool: bounded, drops what nobody waits for, and outlives its processes."""

import asyncio
import os
import signal
from contextlib import closing
from multiprocessing.connection import Connection

import numpy as np
import pytest
from starlette.requests import Request

from partwise.errors import ParameterError
from partwise.store.records import Mesh
from partwise_service.problems import ProblemError
from partwise_service.tool_calls import PatchesCall
from partwise_service.tool_pool import Failed, PoolLimits, Refused, ToolPool
from partwise_service.waiting import unless_gone

ANN, BEN = 1, 2
KILL, REFUSE, FAIL, MISS, HANG = 1001, 1002, 1003, 1004, 1005
LIMITS = PoolLimits(n_processes=1, max_queued=1, max_shapes=2, timeout_s=60.0)


def answer_as_told(connection: Connection, array_url: str, max_prepared: int) -> None:
    """In place of the tools: answers with its process id, or as the number of patches says."""
    while True:
        try:
            call = connection.recv()
        except EOFError:
            return
        match call.n_patches:
            case 1001:
                os.kill(os.getpid(), signal.SIGKILL)
            case 1002:
                connection.send(Refused(ParameterError("as told")))
            case 1003:
                connection.send(Failed("as told"))
            case 1004:
                connection.send(Failed("as told", "numba"))
            case 1005:
                signal.pause()
            case _:
                connection.send(np.array([os.getpid(), call.n_patches]))


def call(n_patches: int, mesh_hash: str = "a" * 64) -> PatchesCall:
    return PatchesCall(_mesh(mesh_hash), None, "k_means", n_patches)


def _mesh(mesh_hash: str) -> Mesh:
    return Mesh(**{**dict.fromkeys(Mesh.__dataclass_fields__), "mesh_hash": mesh_hash})


@pytest.fixture(scope="module")
def tools():
    """Shared, as a process takes its time to start."""
    made = ToolPool("memory", LIMITS, answer_as_told)
    yield made
    made.close()


def test_calls_are_answered_one_after_the_other(tools) -> None:
    async def calls() -> list[int]:
        return [int((await tools.run(call(n), ANN))[1]) for n in (3, 1, 2)]

    assert asyncio.run(calls()) == [3, 1, 2]


def test_more_than_may_wait_are_told_to_come_back(tools) -> None:
    async def calls() -> ProblemError:
        waiting = [asyncio.ensure_future(tools.run(call(n), ANN)) for n in (1, 2)]
        await asyncio.sleep(0)
        with pytest.raises(ProblemError) as refused:
            await tools.run(call(3), ANN)
        assert [int(each[1]) for each in await asyncio.gather(*waiting)] == [1, 2]
        return refused.value

    problem = asyncio.run(calls())
    assert problem.kind.status == 503
    assert int(problem.headers["Retry-After"]) > 0


def test_nobody_has_more_than_one_process_at_a_time() -> None:
    async def calls(tools: ToolPool) -> None:
        own = [asyncio.ensure_future(tools.run(call(n), ANN)) for n in (1, 2)]
        await asyncio.sleep(0)
        assert (tools.n_idle, tools.n_waiting) == (1, 1)
        assert (await tools.run(call(3), BEN))[1] == 3
        assert [int((await each)[1]) for each in own] == [1, 2]
        assert (tools.n_idle, tools.n_waiting) == (2, 0)

    with closing(ToolPool("memory", PoolLimits(2, 8, 2, 60.0), answer_as_told)) as two:
        asyncio.run(calls(two))


def test_whoever_has_as_many_calls_as_they_may_is_told_and_nobody_else() -> None:
    async def calls(tools: ToolPool) -> ProblemError:
        own = [asyncio.ensure_future(tools.run(call(n), ANN)) for n in (1, 2)]
        await asyncio.sleep(0)
        with pytest.raises(ProblemError) as refused:
            await tools.run(call(3), ANN)
        assert (await tools.run(call(4), BEN))[1] == 4
        await asyncio.gather(*own)
        assert (await tools.run(call(5), ANN))[1] == 5
        return refused.value

    with closing(ToolPool("memory", PoolLimits(1, 8, 2, 60.0, max_own=2), answer_as_told)) as one:
        problem = asyncio.run(calls(one))
    assert (problem.kind.status, "Retry-After" in problem.headers) == (429, True)


def test_a_call_that_nobody_waits_for_any_more_is_dropped(tools) -> None:
    async def calls() -> None:
        running = asyncio.ensure_future(tools.run(call(1), ANN))
        await asyncio.sleep(0)
        waiting = asyncio.ensure_future(tools.run(call(KILL), ANN))  # if it ran, the process would be another
        await asyncio.sleep(0)
        assert tools.n_waiting == 1
        waiting.cancel()
        await asyncio.sleep(0)
        assert tools.n_waiting == 0
        pid = (await running)[0]
        assert (await tools.run(call(2), ANN))[0] == pid

    asyncio.run(calls())


def test_a_running_calls_result_is_thrown_away_and_its_process_used_again(tools) -> None:
    async def calls() -> None:
        pid = (await tools.run(call(1), ANN))[0]
        running = asyncio.ensure_future(tools.run(call(2), ANN))
        await asyncio.sleep(0)
        running.cancel()
        assert (await tools.run(call(3), ANN)).tolist() == [pid, 3]
        assert tools.n_idle == 1

    asyncio.run(calls())


def test_a_running_call_that_nobody_waits_for_is_ended_when_it_goes_on() -> None:
    async def calls(tools: ToolPool) -> None:
        pid = (await tools.run(call(1), ANN))[0]
        running = asyncio.ensure_future(tools.run(call(HANG), ANN))
        await asyncio.sleep(0)
        running.cancel()
        told = await tools.run(call(2), ANN)  # waits for the only process
        assert (told[0] != pid, told[1]) == (True, 2)

    with closing(ToolPool("memory", PoolLimits(1, 1, 2, 60.0, abandoned_s=0.01), answer_as_told)) as tools:
        asyncio.run(calls(tools))


def test_a_call_that_is_cancelled_as_its_turn_comes_gives_the_process_back(tools) -> None:
    async def calls() -> None:
        running = asyncio.ensure_future(tools.run(call(1), ANN))
        await asyncio.sleep(0)
        waiting = asyncio.ensure_future(tools.run(call(2), ANN))
        await asyncio.sleep(0)
        tools._line[0].place.add_done_callback(lambda _: waiting.cancel())
        await running
        with pytest.raises(asyncio.CancelledError):
            await waiting
        assert (await tools.run(call(3), ANN))[1] == 3

    asyncio.run(calls())


def test_a_process_that_dies_costs_its_call_only(tools) -> None:
    async def calls() -> None:
        pid = (await tools.run(call(1), ANN))[0]
        with pytest.raises(ProblemError) as lost:
            await tools.run(call(KILL), ANN)
        assert (lost.value.kind.status, "Retry-After" in lost.value.headers) == (503, True)
        assert (await tools.run(call(2), ANN))[0] != pid

    asyncio.run(calls())


def test_a_process_that_died_while_idle_costs_nothing(tools) -> None:
    async def calls() -> None:
        pid = int((await tools.run(call(1), ANN))[0])
        os.kill(pid, signal.SIGKILL)
        tools._processes[0]._process.join()
        assert (await tools.run(call(2), ANN))[1] == 2

    asyncio.run(calls())


def test_a_call_that_takes_too_long_is_given_up() -> None:
    async def calls(tools: ToolPool) -> None:
        with pytest.raises(ProblemError) as lost:
            await tools.run(call(HANG), ANN)
        assert lost.value.kind.status == 503

    with closing(ToolPool("memory", PoolLimits(1, 1, 2, timeout_s=0.01), answer_as_told)) as impatient:
        asyncio.run(calls(impatient))


@pytest.mark.parametrize(("told", "error"), [(REFUSE, ParameterError), (FAIL, RuntimeError), (MISS, ProblemError)])
def test_what_a_tool_raises_comes_back(tools, told, error) -> None:
    async def calls() -> None:
        with pytest.raises(error):
            await tools.run(call(told), ANN)

    asyncio.run(calls())


def test_a_shape_goes_to_the_process_that_knows_it() -> None:
    async def calls(tools: ToolPool) -> None:
        first = (await tools.run(call(1, "a" * 64), ANN))[0]
        second = (await tools.run(call(1, "b" * 64), ANN))[0]
        assert first != second
        assert [(await tools.run(call(1, name * 64), ANN))[0] for name in "bab"] == [second, first, second]

    with closing(ToolPool("memory", PoolLimits(2, 1, 2, 60.0), answer_as_told)) as two:
        asyncio.run(calls(two))


def test_a_client_that_goes_away_takes_its_call_out_of_the_line(tools) -> None:
    async def gone() -> dict:
        return {"type": "http.disconnect"}

    async def calls() -> None:
        running = asyncio.ensure_future(tools.run(call(1), ANN))
        await asyncio.sleep(0)
        with pytest.raises(ProblemError, match="went away"):
            await unless_gone(Request({"type": "http"}, gone), tools, call(KILL), ANN)
        await asyncio.sleep(0)
        assert tools.n_waiting == 0
        pid = (await running)[0]
        assert (await tools.run(call(2), ANN))[0] == pid

    asyncio.run(calls())


def test_a_client_that_stays_gets_the_result(tools) -> None:
    async def calls() -> int:
        stays = asyncio.Event()

        async def receive() -> dict:
            await stays.wait()
            return {"type": "http.disconnect"}

        return int((await unless_gone(Request({"type": "http"}, receive), tools, call(7), ANN))[1])

    assert asyncio.run(calls()) == 7
