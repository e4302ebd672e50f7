"""The pool by itself: what it makes of actors that nobody has looked at for a while."""

import time
from types import SimpleNamespace

import pytest
import ray
from ray.exceptions import RayError

from partwise.config import StageLimits
from partwise.store.records import FailureKind
from partwise_workers import pool
from partwise_workers.actors import StageWorker
from partwise_workers.events import ActorMemory, OnEvent, ignore_events
from partwise_workers.last_words import LastWords, Progress, note_progress, read_progress
from partwise_workers.pool import ActorPool, _Dead, first_line
from partwise_workers.supervision import Rules
from partwise_workers.tasks import StagedName

pytestmark = pytest.mark.usefixtures("local_ray")


FATAL = LastWords("Fatal Python error: Aborted")
LARGE = LastWords(is_over_memory=True)
UNEXPLAINED = LastWords("it was at work")


@pytest.mark.parametrize(
    ("words", "is_unreachable", "is_own_fault", "is_explained"),
    [
        (None, False, False, False),
        (UNEXPLAINED, False, False, True),
        (UNEXPLAINED, True, False, False),  # its node may be lost, as Ray has yet to find out
        (FATAL, True, True, True),
        (LARGE, True, True, True),
    ],
)
def test_what_last_words_explain(
    words: LastWords | None, is_unreachable: bool, is_own_fault: bool, is_explained: bool
) -> None:
    dead = _Dead(
        job=None, worker=None, kind=FailureKind.CRASH, why="", is_unreachable=is_unreachable, seconds=0, until=0
    )
    dead.words = words
    assert (dead.is_own_fault, dead.is_explained) == (is_own_fault, is_explained)


def pool_of(bench, on_event: OnEvent = ignore_events) -> ActorPool:
    """A pool of one actor, which has started and got the one task."""
    limits = {stage.name: StageLimits() for stage in bench.stages}
    n_steps = {stage.name: stage.n_steps for stage in bench.stages}
    url = bench.workspace.array_url
    workers = ActorPool(
        lambda actor_id: StageWorker.remote(url, bench.stages, actor_id, limits),
        1,
        Rules(limits, n_steps, max_attempts=1, recycle_after=200),
        bench.workspace.arrays,
        on_event,
    )
    workers.collect(ray.wait(workers.references())[0])
    workers.submit(next(bench.plan()))
    return workers


def test_what_finished_while_the_driver_was_busy_is_taken_though_its_deadline_has_passed(
    make_bench, monkeypatch: pytest.MonkeyPatch
) -> None:
    bench = make_bench({"a.off": ""})
    workers = pool_of(bench)
    ray.wait(workers.references())
    monkeypatch.setattr(pool, "time", SimpleNamespace(monotonic=lambda: float("inf")))
    assert workers.collect([]) == []  # its first stage is done, and the second one is begun
    assert not workers.is_mourning
    assert workers.n_in_flight == 1
    workers.close()


def test_what_the_actors_hold_is_told_until_they_end(make_bench) -> None:
    told: list[ActorMemory] = []
    workers = pool_of(make_bench({"a.off": ""}), told.append)
    workers.collect(ray.wait(workers.references())[0])
    workers.close()
    assert [each.n_actors for each in (told[0], told[-1])] == [1, 0]
    assert told[0].resident_bytes > 10**6
    assert told[-1].resident_bytes == 0


def test_each_step_has_the_deadline_to_itself(make_bench, monkeypatch: pytest.MonkeyPatch) -> None:
    bench = make_bench({"a.off": "first 0: hangs"}).with_stages(first={"n_steps": 2})
    arrays, deadline_s = bench.workspace.arrays, StageLimits().deadline_s
    task = next(bench.plan())
    name = StagedName("first", task.shape_id, dict(task.stage_keys)["first"])
    workers = pool_of(bench)
    ((_, running),) = workers._running.items()
    actor_id = running.worker.id
    while read_progress(arrays, name, actor_id) is None:
        ray.wait(workers.references(), timeout=0.1)
    note_progress(arrays, name, actor_id, Progress("1", 0.9 * deadline_s, {}))
    now = time.monotonic()
    looks = []
    for later in (1.5, 2.0):
        monkeypatch.setattr(pool, "time", SimpleNamespace(monotonic=lambda later=later: now + later * deadline_s))
        workers.collect([])
        looks.append(workers.is_mourning)
    workers.close()
    assert looks == [False, True]


def test_of_an_actor_that_could_not_be_made_the_line_that_says_why_is_told() -> None:
    text = (
        "The actor died because of an error raised in its creation task, ray::_Packer.__init__() (pid=4543, repr=<x>)\n"
        "RuntimeError: The actor with name _Packer failed to import on the worker. Traceback:\n"
        '  File "actors.py", line 28\n'
        "ModuleNotFoundError: No module named 'zarr'\n"
    )
    assert first_line(RayError(text)) == "ModuleNotFoundError: No module named 'zarr'"
    assert first_line(RayError("The actor is gone.\nIts node was lost.")) == "The actor is gone."
