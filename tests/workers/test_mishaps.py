"""What ends a run early or strikes from outside: nothing finished is lost, no good shape is blamed."""

import signal
from collections.abc import Callable
from typing import NoReturn

import psutil
import pytest

from partwise.errors import NotFoundError, StoreError, WorkerError
from partwise.workspace.progress import RunProgress
from partwise_workers import pool
from partwise_workers.actors import _StageWorker
from partwise_workers.publishing import Published, nothing_else
from partwise_workers.staging import sweep_staging
from partwise_workers.tasks import StageCall, StagedResult

pytestmark = pytest.mark.usefixtures("local_ray")

FOUR = {f"{number}.off": "" for number in range(4)}


def kill_actor(kind: str) -> None:
    """Kills the newest actor process of a kind among our own descendants."""
    ours = psutil.Process().children(recursive=True)
    actors = [process for process in ours if f"ray::{kind}" in " ".join(process.cmdline())]
    max(actors, key=lambda process: process.create_time()).send_signal(signal.SIGKILL)


def when(n_finished: int, act: Callable[[], object]) -> Callable[[RunProgress], None]:
    """A listener that acts once, when so many shapes have finished."""

    def listen(progress: RunProgress) -> None:
        if progress.n_done + progress.n_failed == n_finished:
            act()

    return listen


def once(act: Callable[[], object]) -> Callable[[], None]:
    """Acts when it is called for the first time."""
    left = [act]

    def call() -> None:
        if left:
            left.pop()()

    return call


def raise_(error: BaseException) -> NoReturn:
    raise error


def test_what_a_crashed_run_left_staged_is_published_without_making_it_again(make_bench) -> None:
    bench = make_bench(FOUR).with_workers(n_actors=1)
    worker = _StageWorker(bench.workspace.array_url, bench.stages)
    worker.start()
    for task in list(bench.plan())[:3]:
        for stage, key in task.stage_keys:
            worker.run(StageCall(task, stage, key, {}))
    assert bench.run().n_done == 4
    assert bench.n_noted("first") == 4
    assert len(bench.done("second")) == 4


def test_on_an_interrupt_what_is_finished_is_published(make_bench) -> None:
    bench = make_bench(FOUR).with_workers(n_actors=1)
    with pytest.raises(KeyboardInterrupt):
        bench.run(when(2, lambda: raise_(KeyboardInterrupt())))
    assert len(bench.done("second")) == 2


def test_an_interrupt_within_publishing_leaves_nothing_on_record_without_its_input(make_bench) -> None:
    bench = make_bench(FOUR).with_workers(n_actors=1)
    with pytest.raises(KeyboardInterrupt):
        bench.run(also_publish=lambda shape_id, result, row: raise_(KeyboardInterrupt()))
    assert bench.workspace.catalog.visible_blocks() == []
    assert len(bench.workspace.arrays.staged_keys()) == 8


def test_a_packer_that_dies_is_replaced(make_bench, caplog) -> None:
    bench = make_bench(FOUR).with_workers(n_actors=1, block_shapes=2)
    kill_packer = once(lambda: kill_actor("_Packer"))

    def publish_and_kill(shape_id: int, result: StagedResult, row: int) -> Published:
        kill_packer()
        return nothing_else(shape_id, result, row)

    bench.run(also_publish=publish_and_kill)
    assert "the packer died" in caplog.text
    assert len(bench.done("second")) == 4


def test_the_driver_leaves_the_clearing_of_staging_to_the_packer(make_bench, monkeypatch) -> None:
    bench = make_bench(FOUR).with_workers(n_actors=1, block_shapes=2)
    for name in ("delete_staged", "delete_staged_many"):
        monkeypatch.setattr(bench.workspace.arrays, name, lambda _: raise_(AssertionError("the driver cleared")))
    assert bench.run() == RunProgress(4, 0, 4)
    assert list(bench.workspace.arrays.staged_keys()) == []


def test_what_a_dead_packer_had_not_cleared_is_swept(make_bench, caplog) -> None:
    bench = make_bench({"a.off": ""}).with_workers(n_actors=1)

    def kill(shape_id: int, result: StagedResult, row: int) -> Published:
        if result.stage == "second":
            kill_actor("_Packer")
        return nothing_else(shape_id, result, row)

    assert bench.run(also_publish=kill) == RunProgress(1, 0, 1)
    assert "stay staged until the sweep" in caplog.text
    assert len(bench.workspace.arrays.staged_keys()) >= 1
    sweep_staging(bench.workspace, bench.collection, bench.stages)
    assert list(bench.workspace.arrays.staged_keys()) == []


def test_a_store_that_refuses_to_clear_ends_the_run_after_the_commit(make_bench, tmp_path) -> None:
    bench = make_bench({"a.off": ""}).with_workers(n_actors=1)
    staged = tmp_path / "workspace" / "arrays" / "staging" / "second"

    def replace_by_folders(shape_id: int, result: StagedResult, row: int) -> Published:
        if result.stage == "second":
            (path,) = staged.iterdir()
            path.unlink()
            path.mkdir()
        return nothing_else(shape_id, result, row)

    with pytest.raises((StoreError, NotFoundError), match="second"):
        bench.run(also_publish=replace_by_folders)
    assert set(bench.done("second")) == {"a.off"}


def test_an_idle_actor_that_dies_costs_its_next_shape_an_attempt_only(make_bench, monkeypatch) -> None:
    monkeypatch.setattr(pool, "LAST_WORDS_S", 0.5)  # an idle actor leaves none
    bench = make_bench(FOUR).with_workers(n_actors=1)
    assert bench.run(when(2, lambda: kill_actor("_StageWorker"))) == RunProgress(4, 0, 4)
    assert sorted(run.attempts for run in bench.done("first").values()) == [1, 1, 1, 2]


def test_a_shape_whose_node_is_lost_is_not_blamed(make_bench, monkeypatch) -> None:
    monkeypatch.setattr(pool, "is_node_lost", lambda node_id: True)
    bench = make_bench({"a.off": "first: dies once", "b.off": ""}).with_workers(n_actors=1, max_attempts=1)
    assert bench.run() == RunProgress(2, 0, 2)
    assert [run.attempts for run in bench.done("first").values()] == [1, 1]


def test_a_process_that_dies_by_itself_is_told_from_a_lost_node(make_bench) -> None:
    bench = make_bench({"a.off": "first: dies"}).with_workers(n_actors=1, max_attempts=1)
    assert bench.run() == RunProgress(0, 1, 1)


def test_two_runs_at_once_publish_each_shape_once(make_bench) -> None:
    bench = make_bench(FOUR).with_workers(n_actors=1)
    bench.run(when(2, lambda: bench.run()))
    blocks = {run.block_name for run in bench.done("second").values()}
    assert set(bench.done("second")) == set(FOUR)
    assert blocks <= {block.name for block in bench.workspace.catalog.visible_blocks()}
    assert list(bench.workspace.arrays.staged_keys()) == []


def test_a_full_store_ends_the_run_and_blames_no_shape(make_bench) -> None:
    bench = make_bench({"a.off": "", "b.off": "second: fills the disk"}).with_workers(n_actors=1)
    with pytest.raises(StoreError, match="has no room for"):
        bench.run()
    assert bench.failed("second") == {}
    assert bench.workspace.catalog.visible_blocks() == []


def test_blocks_that_cannot_be_written_end_the_run_and_stay_staged(make_bench, tmp_path) -> None:
    bench = make_bench({"a.off": ""})
    (tmp_path / "workspace" / "arrays" / "blocks").touch()  # where a folder has to be
    with pytest.raises(StoreError):
        bench.run()
    assert len(bench.workspace.arrays.staged_keys()) == 2


def test_a_stage_that_refuses_to_open_ends_the_run_with_its_own_words(make_bench) -> None:
    bench = make_bench({"a.off": ""}).with_stages(second={"opens": "refuses"})
    with pytest.raises(NotFoundError, match="the model must be there"):
        bench.run()


def test_actors_that_cannot_start_end_the_run(make_bench) -> None:
    bench = make_bench(FOUR).with_workers(n_actors=2).with_stages(first={"opens": "lacks a library"})
    with pytest.raises(WorkerError, match=r"6 in a row did not.+No module named 'embreex'"):  # three for each
        bench.run()
    assert bench.failed("first") == {}
