"""What actors do with tasks, without Ray around them."""

import os

import numpy as np
import pytest

from partwise.errors import NotFoundError, StoreError
from partwise.store.blocks import BlockKind, Domain, Quantity
from partwise_workers.actors import MAX_REASON, _failure, _Packer, _StageWorker
from partwise_workers.tasks import ShapeTask, StagedName


def start(bench) -> _StageWorker:
    worker = _StageWorker(bench.workspace.array_url, bench.stages)
    worker.start()
    return worker


def task_of(bench, key: str = "a.off") -> ShapeTask:
    return next(task for task in bench.plan() if task.source_key == key)


def staged_as(bench, position: int) -> str:
    task = task_of(bench)
    stage, key = task.stage_keys[position]
    return str(StagedName(stage, task.shape_id, key))


def test_the_stages_of_a_task_run_in_order(make_bench) -> None:
    bench = make_bench({"a.off": ""})
    outcome = start(bench).run(task_of(bench))
    assert [result.stage for result in outcome.results] == ["first", "second"]


def test_results_wait_in_staging(make_bench) -> None:
    bench = make_bench({"a.off": ""})
    outcome = start(bench).run(task_of(bench))
    assert set(bench.workspace.arrays.staged_keys()) == {result.staged_as for result in outcome.results}


def test_a_staged_result_is_not_made_again(make_bench) -> None:
    bench = make_bench({"a.off": ""})
    start(bench).run(task_of(bench))
    start(bench).run(task_of(bench))
    assert (bench.n_noted("first"), bench.n_noted("second")) == (1, 1)


def test_a_staged_result_keeps_its_summary(make_bench) -> None:
    bench = make_bench({"a.off": ""})
    outcomes = [start(bench).run(task_of(bench)) for _ in range(2)]
    assert outcomes[0] == outcomes[1]


def test_a_damaged_staged_result_is_made_again(make_bench, tmp_path) -> None:
    bench = make_bench({"a.off": ""})
    start(bench).run(task_of(bench))
    (tmp_path / "workspace" / "arrays" / "staging" / staged_as(bench, 0)).write_bytes(b"half")
    outcome = start(bench).run(task_of(bench))
    assert outcome.failure is None
    assert bench.n_noted("first") == 2


def test_a_stage_that_refuses_a_shape_fails_it(make_bench) -> None:
    bench = make_bench({"a.off": "second: refuses"})
    outcome = start(bench).run(task_of(bench))
    assert outcome.failure is not None
    assert (outcome.failure.stage, outcome.failure.detail) == ("second", "")
    assert [result.stage for result in outcome.results] == ["first"]


def test_arrays_that_do_not_fit_the_block_fail_the_shape(make_bench) -> None:
    bench = make_bench({"a.off": ""}).with_stages(
        first={"block_kind": BlockKind("fake", (Quantity("values", Domain.FACE, "float32"),))}
    )
    failure = start(bench).run(task_of(bench)).failure
    assert failure is not None
    assert "values must be float32" in failure.reason


def test_a_missing_source_fails_the_shape(make_bench) -> None:
    bench = make_bench({"a.off": ""})
    bench.workspace.arrays.delete(task_of(bench).source_object)
    failure = start(bench).run(task_of(bench)).failure
    assert failure is not None
    assert "no object" in failure.reason


def test_a_damaged_input_fails_the_shape(make_bench, monkeypatch) -> None:
    bench = make_bench({"a.off": ""})
    worker = start(bench)
    monkeypatch.setattr(worker._arrays, "get_bytes", lambda key: (_ for _ in ()).throw(StoreError("damaged")))
    failure = worker.run(task_of(bench)).failure
    assert failure is not None
    assert failure.reason == "damaged"


def test_a_store_that_is_down_fails_no_shape(make_bench, monkeypatch) -> None:
    bench = make_bench({"a.off": ""})
    worker = start(bench)

    def refuse(*_: object) -> None:
        raise StoreError("out of reach")

    monkeypatch.setattr(worker._arrays, "get_bytes", refuse)
    monkeypatch.setattr(worker._arrays, "stage", refuse)
    with pytest.raises(StoreError, match="out of reach"):
        worker.run(task_of(bench))


def test_a_store_that_is_full_fails_no_shape(make_bench, monkeypatch) -> None:
    bench = make_bench({"a.off": "first: fills the disk"})
    monkeypatch.setattr(os, "fsync", os.fsync)  # put back what the stage replaces
    with pytest.raises(StoreError, match="no room"):
        start(bench).run(task_of(bench))


def test_giving_up_blames_the_stage_that_did_not_end(make_bench) -> None:
    bench = make_bench({"a.off": "second: refuses"})
    worker = start(bench)
    worker.run(task_of(bench))
    outcome = worker.give_up(task_of(bench), "it died")
    assert outcome.failure is not None
    assert (outcome.failure.stage, outcome.failure.reason) == ("second", "it died")


def test_giving_up_keeps_what_was_finished(make_bench) -> None:
    bench = make_bench({"a.off": "second: refuses"})
    worker = start(bench)
    done = worker.run(task_of(bench)).results
    assert worker.give_up(task_of(bench), "it died").results == done


def test_a_shape_that_had_finished_is_not_given_up(make_bench) -> None:
    bench = make_bench({"a.off": ""})
    worker = start(bench)
    worker.run(task_of(bench))
    assert worker.give_up(task_of(bench), "it died").failure is None


def test_closing_closes_the_stages(make_bench) -> None:
    bench = make_bench({"a.off": ""})
    start(bench).close()
    assert bench.n_noted("closed") == 2


def test_an_unforeseen_errors_reason_is_one_line_of_bounded_length() -> None:
    failure = _failure("first", "k", ValueError("x" * 5000 + "\nmore"), 0.0)
    assert len(failure.reason) == MAX_REASON
    assert "more" in failure.detail


def test_packing_leaves_out_what_another_run_took(make_bench) -> None:
    bench = make_bench({"a.off": "", "b.off": ""})
    worker = start(bench)
    names = [worker.run(task).results[0].staged_as for task in bench.plan()]
    bench.workspace.arrays.delete_staged(names[0])
    packed = _Packer(bench.workspace.array_url).pack(bench.stages[0].block_kind, names)
    assert packed.names == (names[1],)
    assert packed.address is not None
    assert packed.address.n_shapes == 1


def test_packing_nothing_writes_no_block(make_bench) -> None:
    bench = make_bench({"a.off": ""})
    packed = _Packer(bench.workspace.array_url).pack(bench.stages[0].block_kind, ["first/1-gone"])
    assert packed.address is None
    assert bench.workspace.arrays.block_names() == []


def test_a_packed_block_has_the_arrays_and_no_account(make_bench) -> None:
    bench = make_bench({"a.off": ""})
    (first, _) = start(bench).run(task_of(bench)).results
    packed = _Packer(bench.workspace.array_url).pack(bench.stages[0].block_kind, [first.staged_as])
    assert packed.address is not None
    arrays = bench.workspace.arrays
    expected = np.frombuffer(b"this is a.off\n\n", dtype=np.uint8)
    np.testing.assert_array_equal(arrays.read(packed.address.name, 0, "values"), expected)
    with pytest.raises(NotFoundError):
        arrays.read(packed.address.name, 0, "_account")
