"""What each shape still needs: only what is missing, and what depends on it."""

from collections.abc import Iterable

from partwise.store.records import NewBlock, NewFailure, NewStageRun
from partwise.workspace.ingest import ingest_folder
from partwise_workers.plan import chain_keys
from partwise_workers.tasks import ShapeTask

SOURCES = {"a.off": "", "b.off": ""}


def finish(bench, tasks: Iterable[ShapeTask]) -> None:
    """Puts every stage of the tasks on record, as a run of them would."""
    for task in tasks:
        for stage, key in task.stage_keys:
            block = NewBlock(f"blocks/fake/{task.shape_id}-{key[:8]}", "fake", 1, 1, "0" * 64)
            bench.workspace.catalog.publish_block(block, [NewStageRun(task.shape_id, stage, key, 0)])


def needs(tasks: Iterable[ShapeTask]) -> dict[str, list[str]]:
    return {task.source_key: [stage for stage, _ in task.stage_keys] for task in tasks}


def test_a_new_shape_needs_every_stage(make_bench) -> None:
    assert needs(make_bench(SOURCES).plan()) == {"a.off": ["first", "second"], "b.off": ["first", "second"]}


def test_a_second_run_has_nothing_to_do(make_bench) -> None:
    bench = make_bench(SOURCES)
    finish(bench, list(bench.plan()))
    assert list(bench.plan()) == []


def test_changing_the_last_stage_redoes_it_alone(make_bench) -> None:
    bench = make_bench(SOURCES)
    finish(bench, list(bench.plan()))
    changed = bench.with_stages(second={"parameter": 1})
    assert needs(changed.plan()) == {"a.off": ["second"], "b.off": ["second"]}


def test_a_redone_stage_reads_the_block_of_the_one_before(make_bench) -> None:
    bench = make_bench({"a.off": ""})
    finish(bench, list(bench.plan()))
    (task,) = bench.with_stages(second={"parameter": 1}).plan()
    assert task.finished["first"].block_name == bench.done("first")["a.off"].block_name


def test_changing_the_first_stage_redoes_those_after_it(make_bench) -> None:
    bench = make_bench(SOURCES)
    finish(bench, list(bench.plan()))
    changed = bench.with_stages(first={"parameter": 1})
    assert needs(changed.plan()) == {"a.off": ["first", "second"], "b.off": ["first", "second"]}


def test_a_changed_source_is_done_again_and_no_other(make_bench, tmp_path) -> None:
    bench = make_bench(SOURCES)
    finish(bench, list(bench.plan()))
    (tmp_path / "sources" / "a.off").write_text("something else", encoding="utf-8")
    ingest_folder(bench.workspace, bench.collection, tmp_path / "sources")
    assert needs(bench.plan()) == {"a.off": ["first", "second"]}


def fail(bench, stage: str) -> None:
    """Puts a failure of a.off at a stage on record, under its present key."""
    shape = bench.workspace.catalog.shape_by_key(bench.collection.id, "a.off")
    names = [each.name for each in bench.stages]
    key = chain_keys(shape, bench.stages)[names.index(stage)]
    bench.workspace.catalog.record_failure(NewFailure(shape.id, stage, key, "bad"))


def test_a_failed_shape_is_passed_over(make_bench) -> None:
    bench = make_bench(SOURCES)
    fail(bench, "first")
    assert set(needs(bench.plan())) == {"b.off"}


def test_a_shape_that_failed_late_still_gets_the_stages_before(make_bench) -> None:
    bench = make_bench(SOURCES)
    fail(bench, "second")
    assert needs(bench.plan())["a.off"] == ["first"]


def test_a_cleared_failure_is_tried_again(make_bench) -> None:
    bench = make_bench(SOURCES)
    fail(bench, "first")
    bench.workspace.catalog.clear_failures(bench.collection.id)
    assert set(needs(bench.plan())) == {"a.off", "b.off"}


def test_a_failure_under_other_parameters_does_not_count(make_bench) -> None:
    bench = make_bench(SOURCES)
    fail(bench, "first")
    assert set(needs(bench.with_stages(first={"parameter": 1}).plan())) == {"a.off", "b.off"}


def test_a_shape_without_the_earlier_stages_is_passed_over(make_bench) -> None:
    bench = make_bench(SOURCES)
    first, second = bench.stages
    finish(bench, [task for task in bench.plan([first]) if task.source_key == "a.off"])
    assert needs(bench.plan([second], earlier=[first])) == {"a.off": ["second"]}


def test_a_shape_with_outdated_earlier_stages_is_passed_over(make_bench) -> None:
    bench = make_bench(SOURCES)
    finish(bench, list(bench.plan()))
    first, second = bench.with_stages(first={"parameter": 1}).stages
    assert list(bench.plan([second], earlier=[first])) == []
