"""An array store that hangs holds up what shows shapes, and nothing else."""

import asyncio
import threading
from concurrent.futures import ThreadPoolExecutor

import pytest
from anyio import fail_after
from anyio.to_thread import current_default_thread_limiter, run_sync

from partwise_service.array_places import in_array_place, in_array_places
from partwise_service.settings import ServiceSettings

N_THREADS = 3
WITHIN_S = 60.0


class HungStore:
    """Stands before a service's array store until it is let go. begun : counts who waits there."""

    def __init__(self, arrays, monkeypatch: pytest.MonkeyPatch) -> None:
        self.begun = threading.Semaphore(0)
        self._goes_on = threading.Event()
        for name in ("read", "read_many", "get_bytes", "exists", "list"):
            monkeypatch.setattr(arrays, name, self._behind(getattr(arrays, name)))

    def _behind(self, method):
        def hung(*arguments):
            self.begun.release()
            assert self._goes_on.wait(WITHIN_S)
            return method(*arguments)

        return hung

    def let_go(self) -> None:
        self._goes_on.set()


@pytest.fixture
def settings(mugs) -> ServiceSettings:
    return ServiceSettings(workspace=mugs.path, threads=N_THREADS)


def _path(mugs, workspace, kind: str) -> str:
    shape = workspace.catalog.shape(mugs.ids["a.off"])
    return {
        "mesh": f"/meshes/{shape.mesh_hash}?shape_id={shape.id}",
        "labels": f"/shapes/{shape.id}/labels?segmentation=predicted",
        "uncertainty": f"/shapes/{shape.id}/uncertainty",
        "uploads": f"/collections/{mugs.collection_id}/uploads",
    }[kind]


@pytest.mark.parametrize("kind", ["mesh", "labels", "uncertainty", "uploads"])
def test_people_go_on_while_the_array_store_hangs(operator, annotator, workspace, mugs, monkeypatch, kind) -> None:
    path = _path(mugs, workspace, kind)
    annotator.get("/leases")
    store = HungStore(workspace.arrays, monkeypatch)
    with ThreadPoolExecutor(2 * N_THREADS + 1) as callers:
        waiting = [callers.submit(operator.get, path) for _ in range(2 * N_THREADS)]
        try:
            assert store.begun.acquire(timeout=WITHIN_S)
            claimed = callers.submit(annotator.post, "/queue/claim", json={"collection_id": mugs.collection_id})
            assert claimed.result(WITHIN_S).status_code == 200
            assert not any(each.done() for each in waiting)
        finally:
            store.let_go()
        assert {each.result(WITHIN_S).status_code for each in waiting} == {200}


def test_a_third_of_the_threads_is_left() -> None:
    async def calls() -> int:
        current_default_thread_limiter().total_tokens = N_THREADS
        n_begun, goes_on = threading.Semaphore(0), threading.Event()

        def hang() -> None:
            n_begun.release()
            assert goes_on.wait(WITHIN_S)

        waiting = [asyncio.ensure_future(in_array_place(hang)) for _ in range(N_THREADS)]
        for _ in range(2):
            await run_sync(n_begun.acquire)
        is_third_begun = n_begun.acquire(blocking=False)
        goes_on.set()
        await asyncio.gather(*waiting)
        return is_third_begun

    assert asyncio.run(calls()) is False


def test_a_place_is_held_no_longer_than_a_piece_takes() -> None:
    async def calls() -> list[bytes]:
        current_default_thread_limiter().total_tokens = 1
        got = []
        with fail_after(WITHIN_S):
            async for piece in in_array_places(iter([b"a", b"", b"c"])):
                got += [piece, await in_array_place(lambda: b"between")]
        return got

    assert asyncio.run(calls()) == [b"a", b"between", b"", b"between", b"c", b"between"]
