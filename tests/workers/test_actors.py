"""What actors do with tasks, without Ray around them."""

import os
from collections.abc import Iterable
from dataclasses import replace

import numpy as np
import pytest

from partwise.errors import NotFoundError, StageRefusedError, StoreError
from partwise.store.blocks import BlockKind, Domain, Quantity
from partwise.store.records import FailureKind
from partwise_workers.actors import _failure, _Packer, _StageWorker
from partwise_workers.stage import MAX_REASON
from partwise_workers.tasks import BlockRow, ShapeTask, StageCall, StagedResult, StageFailure

ANY_CALL = StageCall(ShapeTask(1, "a.off", "sources/a", (("first", "k"),), {}), "first", "k", {})


def start(bench) -> _StageWorker:
    worker = _StageWorker(bench.workspace.array_url, bench.stages)
    worker.start()
    return worker


def seconds_of(results: Iterable[StagedResult]) -> dict[str, float]:
    return {result.staged_as: result.seconds for result in results}


def task_of(bench, key: str = "a.off") -> ShapeTask:
    return next(task for task in bench.plan() if task.source_key == key)


def call_of(task: ShapeTask, position: int, failed_steps: dict[str, str] | None = None) -> StageCall:
    return StageCall(task, *task.stage_keys[position], failed_steps or {})


def run(worker: _StageWorker, task: ShapeTask) -> list[StagedResult | StageFailure]:
    """Results of the task's stages, in order, up to the first failure."""
    results: list[StagedResult | StageFailure] = []
    for position in range(len(task.stage_keys)):
        results.append(worker.run(call_of(task, position)).result)
        if isinstance(results[-1], StageFailure):
            break
    return results


def failure_of(worker: _StageWorker, task: ShapeTask) -> StageFailure:
    failure = run(worker, task)[-1]
    assert isinstance(failure, StageFailure)
    return failure


def staged_as(bench, position: int) -> str:
    return str(call_of(task_of(bench), position).name)


def test_the_stages_of_a_task_run_in_order(make_bench) -> None:
    bench = make_bench({"a.off": ""})
    results = run(start(bench), task_of(bench))
    assert [result.stage for result in results] == ["first", "second"]


def test_results_wait_in_staging(make_bench) -> None:
    bench = make_bench({"a.off": ""})
    results = run(start(bench), task_of(bench))
    assert set(bench.workspace.arrays.staged_keys()) == {result.staged_as for result in results}


def test_a_staged_result_is_not_made_again(make_bench) -> None:
    bench = make_bench({"a.off": ""})
    run(start(bench), task_of(bench))
    run(start(bench), task_of(bench))
    assert (bench.n_noted("first"), bench.n_noted("second")) == (1, 1)


def replace_first(bench) -> None:
    """What another run with the same key may do: the first stage's result, with other values."""
    name = staged_as(bench, 0)
    staged = dict(bench.workspace.arrays.read_staged(name))
    staged["values"] = staged["values"] + 1
    bench.workspace.arrays.stage(name, staged)


def test_a_staged_result_is_made_again_where_what_it_was_made_from_was_replaced(make_bench) -> None:
    bench = make_bench({"a.off": ""})
    before = run(start(bench), task_of(bench))[1].summary["sum"]
    n_values = len(bench.workspace.arrays.read_staged(staged_as(bench, 0))["values"])
    replace_first(bench)
    _, again = run(start(bench), task_of(bench))
    assert (bench.n_noted("first"), bench.n_noted("second")) == (1, 2)
    assert again.summary["sum"] == before + n_values


def test_a_staged_result_is_kept_when_what_it_was_made_from_is_published_meanwhile(make_bench) -> None:
    bench = make_bench({"a.off": ""})
    first, _ = run(start(bench), task_of(bench))
    packed = _Packer(bench.workspace.array_url).pack(bench.stages[0].block_kind, seconds_of([first]))
    block = BlockRow(packed.address.name, 0)
    task = task_of(bench)
    rest = replace(task, stage_keys=task.stage_keys[1:], finished={"first": block})
    assert [result.stage for result in run(start(bench), rest)] == ["second"]
    assert bench.n_noted("second") == 1


def test_a_staged_result_that_does_not_say_what_it_was_made_from_is_made_again(make_bench) -> None:
    bench = make_bench({"a.off": ""})
    run(start(bench), task_of(bench))
    staged = dict(bench.workspace.arrays.read_staged(staged_as(bench, 1)))
    staged["_account"] = np.frombuffer(b'{"summary": {}, "seconds": 1.0}', dtype=np.uint8)
    bench.workspace.arrays.stage(staged_as(bench, 1), staged)
    run(start(bench), task_of(bench))
    assert bench.n_noted("second") == 2


def test_a_staged_result_keeps_its_summary(make_bench) -> None:
    bench = make_bench({"a.off": ""})
    first, again = (run(start(bench), task_of(bench)) for _ in range(2))
    assert first == again


def test_a_damaged_staged_result_is_made_again(make_bench, tmp_path) -> None:
    bench = make_bench({"a.off": ""})
    run(start(bench), task_of(bench))
    (tmp_path / "workspace" / "arrays" / "staging" / staged_as(bench, 0)).write_bytes(b"half")
    assert len(run(start(bench), task_of(bench))) == 2
    assert bench.n_noted("first") == 2


def test_a_stage_that_refuses_a_shape_fails_it(make_bench) -> None:
    bench = make_bench({"a.off": "second: refuses"})
    first, failure = run(start(bench), task_of(bench))
    assert (first.stage, failure.stage) == ("first", "second")
    assert isinstance(failure, StageFailure)
    assert (failure.kind, failure.detail) == (FailureKind.ERROR, {})


def test_a_stage_that_would_leave_the_process_fails_the_shape_only(make_bench) -> None:
    bench = make_bench({"a.off": "first: leaves"})
    assert failure_of(start(bench), task_of(bench)).reason == "SystemExit: 7"


def test_arrays_that_do_not_fit_the_block_fail_the_shape(make_bench) -> None:
    bench = make_bench({"a.off": ""}).with_stages(
        first={"block_kind": BlockKind("fake", (Quantity("values", Domain.FACE, "float32"),))}
    )
    failure = failure_of(start(bench), task_of(bench))
    assert "values must be float32" in failure.reason


def test_a_missing_source_fails_the_shape(make_bench) -> None:
    bench = make_bench({"a.off": ""})
    bench.workspace.arrays.delete(task_of(bench).source_object)
    failure = failure_of(start(bench), task_of(bench))
    assert "no object" in failure.reason


def test_a_damaged_input_fails_the_shape(make_bench, monkeypatch) -> None:
    bench = make_bench({"a.off": ""})
    worker = start(bench)
    monkeypatch.setattr(worker._arrays, "get_bytes", lambda key: (_ for _ in ()).throw(StoreError("damaged")))
    failure = failure_of(worker, task_of(bench))
    assert failure.reason == "damaged"


def test_a_store_that_is_down_fails_no_shape(make_bench, monkeypatch) -> None:
    bench = make_bench({"a.off": ""})
    worker = start(bench)

    def refuse(*_: object) -> None:
        raise StoreError("out of reach")

    monkeypatch.setattr(worker._arrays, "get_bytes", refuse)
    monkeypatch.setattr(worker._arrays, "stage", refuse)
    with pytest.raises(StoreError, match="out of reach"):
        run(worker, task_of(bench))


def test_a_store_that_is_full_fails_no_shape(make_bench, monkeypatch) -> None:
    bench = make_bench({"a.off": "first: fills the disk"})
    for name in ("replace", "fsync"):
        monkeypatch.setattr(os, name, getattr(os, name))  # put back what the stage replaces
    with pytest.raises(StoreError, match="no room"):
        run(start(bench), task_of(bench))


def test_closing_closes_the_stages(make_bench) -> None:
    bench = make_bench({"a.off": ""})
    start(bench).close()
    assert bench.n_noted("closed") == 2


def test_an_unforeseen_errors_reason_is_one_line_of_bounded_length() -> None:
    failure = _failure(ANY_CALL, ValueError("x" * 5000 + "\nmore"), 0.0)
    assert len(failure.reason) == MAX_REASON
    assert "more" in failure.detail["traceback"]


def test_an_allocation_that_is_refused_counts_as_memory() -> None:
    assert _failure(ANY_CALL, MemoryError("array of 1 TB"), 0.0).kind is FailureKind.MEMORY


def test_what_a_refusing_stage_has_tried_goes_on_record() -> None:
    failure = _failure(ANY_CALL, StageRefusedError("no attempt held", {"attempts": [1, 2]}), 0.0)
    assert failure.detail == {"attempts": [1, 2]}


def test_packing_leaves_out_what_another_run_took(make_bench) -> None:
    bench = make_bench({"a.off": "", "b.off": ""})
    worker = start(bench)
    seconds = seconds_of(run(worker, task)[0] for task in bench.plan())
    gone, there = seconds
    bench.workspace.arrays.delete_staged(gone)
    packed = _Packer(bench.workspace.array_url).pack(bench.stages[0].block_kind, seconds)
    assert packed.names == (there,)
    assert packed.address is not None
    assert packed.address.n_shapes == 1


def test_a_result_that_another_process_has_replaced_is_not_packed_under_this_ones_summary(make_bench) -> None:
    bench = make_bench({"a.off": ""})
    (first, _) = run(start(bench), task_of(bench))
    bench.workspace.arrays.delete_staged(first.staged_as)
    (again, _) = run(start(bench), task_of(bench))
    packer = _Packer(bench.workspace.array_url)
    assert packer.pack(bench.stages[0].block_kind, seconds_of([first])).names == ()
    assert packer.pack(bench.stages[0].block_kind, seconds_of([again])).names == (first.staged_as,)


def test_packing_nothing_writes_no_block(make_bench) -> None:
    bench = make_bench({"a.off": ""})
    packed = _Packer(bench.workspace.array_url).pack(bench.stages[0].block_kind, {"first/1-gone": 0.5})
    assert packed.address is None
    assert bench.workspace.arrays.block_names() == []


def test_a_packed_block_has_the_arrays_and_no_account(make_bench) -> None:
    bench = make_bench({"a.off": ""})
    (first, _) = run(start(bench), task_of(bench))
    packed = _Packer(bench.workspace.array_url).pack(bench.stages[0].block_kind, seconds_of([first]))
    assert packed.address is not None
    arrays = bench.workspace.arrays
    expected = np.frombuffer(b"this is a.off\n\n", dtype=np.uint8)
    np.testing.assert_array_equal(arrays.read(packed.address.name, 0, "values"), expected)
    with pytest.raises(NotFoundError):
        arrays.read(packed.address.name, 0, "_account")


def test_the_packer_lets_go_of_what_it_is_told_to(make_bench) -> None:
    bench = make_bench({"a.off": ""})
    first, second = run(start(bench), task_of(bench))
    _Packer(bench.workspace.array_url).clear([first.staged_as, "first/1-gone"])
    assert list(bench.workspace.arrays.staged_keys()) == [second.staged_as]
