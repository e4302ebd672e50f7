"""What a sweep of the staging area takes, and what it leaves."""

import numpy as np

from partwise.store.records import NewBlock, NewFailure, NewStageRun
from partwise_workers.last_words import LastWords, Progress, last_words_name, note_progress, progress_name
from partwise_workers.plan import chain_keys
from partwise_workers.staging import sweep_staging
from partwise_workers.tasks import StagedName


def stage(bench, stage: str, shape_id: int, key: str) -> str:
    name = str(StagedName(stage, shape_id, key))
    bench.workspace.arrays.stage(name, {"values": np.ones(3)})
    return name


def present_key(bench, position: int) -> tuple[int, str]:
    shape = bench.workspace.catalog.shape_by_key(bench.collection.id, "a.off")
    return shape.id, chain_keys(shape, bench.stages)[position]


def sweep(bench, *, earlier: int = 0) -> list[str]:
    """Sweeps and returns what is left."""
    sweep_staging(bench.workspace, bench.collection, bench.stages[earlier:], bench.stages[:earlier])
    return list(bench.workspace.arrays.staged_keys())


def test_a_result_that_waits_to_be_published_stays(make_bench) -> None:
    bench = make_bench({"a.off": ""})
    name = stage(bench, "second", *present_key(bench, 1))
    assert sweep(bench) == [name]


def test_a_result_that_waits_to_be_published_stays_where_its_stage_is_run_alone(make_bench) -> None:
    bench = make_bench({"a.off": ""})
    name = stage(bench, "second", *present_key(bench, 1))
    assert sweep(bench, earlier=1) == [name]


def test_a_result_that_is_published_goes(make_bench) -> None:
    bench = make_bench({"a.off": ""})
    shape_id, key = present_key(bench, 0)
    stage(bench, "first", shape_id, key)
    block = NewBlock("blocks/fake/1", "fake", 1, 1, "0" * 64)
    bench.workspace.catalog.publish_block(block, [NewStageRun(shape_id, "first", key, 0)])
    assert sweep(bench) == []


def test_a_result_of_other_parameters_goes(make_bench) -> None:
    bench = make_bench({"a.off": ""})
    stage(bench, "first", *present_key(bench.with_stages(first={"parameter": 1}), 0))
    assert sweep(bench) == []


def test_another_collections_results_stay(make_bench) -> None:
    bench = make_bench({"a.off": ""})
    shape_id, _ = present_key(bench, 0)
    name = stage(bench, "first", shape_id, "ofnochain")
    other = bench.workspace.catalog.create_collection("others", ["part"])
    sweep_staging(bench.workspace, other, bench.stages)
    assert list(bench.workspace.arrays.staged_keys()) == [name]


def test_names_of_another_make_stay(make_bench) -> None:
    bench = make_bench({"a.off": ""})
    bench.workspace.arrays.stage("first/odd", {"values": np.ones(3)})
    assert sweep(bench) == ["first/odd"]


def test_the_number_swept_is_told(make_bench) -> None:
    bench = make_bench({"a.off": ""})
    shape_id, _ = present_key(bench, 0)
    for number in range(3):
        stage(bench, "first", shape_id, f"old{number}")
    assert sweep_staging(bench.workspace, bench.collection, bench.stages) == 3


def leave_behind(bench, stage: str, shape_id: int, key: str) -> list[str]:
    """The step and the last words of a process that died."""
    arrays, name = bench.workspace.arrays, StagedName(stage, shape_id, key)
    note_progress(arrays, name, "af", Progress("attempt 0", 0.0, {}))
    arrays.stage(last_words_name(name, "af"), LastWords("log", 1, False).arrays())
    return sorted([progress_name(name, "af"), last_words_name(name, "af")])


def test_what_a_dead_process_left_stays_while_its_shape_may_be_in_hand(make_bench) -> None:
    bench = make_bench({"a.off": ""})
    assert leave_behind(bench, "second", *present_key(bench, 1)) == sorted(sweep(bench))


def test_what_a_dead_process_left_goes_when_the_stage_is_done(make_bench) -> None:
    bench = make_bench({"a.off": ""})
    shape_id, key = present_key(bench, 0)
    leave_behind(bench, "first", shape_id, key)
    block = NewBlock("blocks/fake/1", "fake", 1, 1, "0" * 64)
    bench.workspace.catalog.publish_block(block, [NewStageRun(shape_id, "first", key, 0)])
    assert sweep(bench) == []


def test_what_a_dead_process_left_goes_when_the_stage_has_failed(make_bench) -> None:
    bench = make_bench({"a.off": ""})
    shape_id, key = present_key(bench, 0)
    leave_behind(bench, "first", shape_id, key)
    bench.workspace.catalog.record_failure(NewFailure(shape_id, "first", key, "it died"))
    assert sweep(bench) == []


def test_what_a_dead_process_left_of_other_parameters_goes(make_bench) -> None:
    bench = make_bench({"a.off": ""})
    leave_behind(bench, "first", *present_key(bench.with_stages(first={"parameter": 1}), 0))
    assert sweep(bench) == []
