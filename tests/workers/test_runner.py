"""One run on Ray over good shapes and every kind of bad one. It is made once; each test looks at one side of it."""

from collections.abc import Callable, Iterator, Mapping
from contextlib import AbstractContextManager
from pathlib import Path

import numpy as np
import pytest

from partwise.store.array_store import BlockAddress
from partwise.workspace.progress import RunProgress

GOOD = [f"good{number}.off" for number in range(5)]
SOURCES = {
    **dict.fromkeys(GOOD, ""),
    "refused.off": "first: refuses",
    "crashes.off": "second: crashes",
    "dies-once.off": "second: dies once",
    "dies.off": "second: dies",
    "hangs.off": "first: hangs",
}
FINISH = {*GOOD, "dies-once.off"}
DEADLINE_S = 4.0
BLOCK_SHAPES = 2


@pytest.fixture(scope="module")
def ran(
    local_ray: None,
    tmp_path_factory: pytest.TempPathFactory,
    bench_in: Callable[[Path, Mapping[str, str]], AbstractContextManager],
) -> Iterator:
    with bench_in(tmp_path_factory.mktemp("runner"), SOURCES) as bench:
        bench = bench.with_workers(block_shapes=BLOCK_SHAPES, max_attempts=2).with_limits(deadline_s=DEADLINE_S)
        progress: list[RunProgress] = []
        bench.run(progress.append)
        yield bench, progress


def test_every_good_shape_goes_all_the_way(ran) -> None:
    assert set(ran[0].done("second")) == FINISH


def test_results_are_those_of_the_stages(ran) -> None:
    own = np.frombuffer(b"this is good0.off\n\n", dtype=np.uint8).astype(np.int64)
    np.testing.assert_array_equal(ran[0].values("second", "good0.off"), 2 * own)


def test_every_bad_shape_is_on_record(ran) -> None:
    failed = {**ran[0].failed("first"), **ran[0].failed("second")}
    assert set(failed) == set(SOURCES) - FINISH


def test_a_refusal_is_on_record_as_it_was_said(ran) -> None:
    assert ran[0].failed("first")["refused.off"].reason == "a mesh must have faces but has none; was it cut off?"


def test_an_unforeseen_error_is_on_record_in_one_line_with_its_traceback(ran) -> None:
    run = ran[0].failed("second")["crashes.off"]
    assert run.reason == "ZeroDivisionError: first line"
    assert "in _behave" in run.summary["traceback"]


def test_a_shape_that_kills_its_process_once_is_tried_again(ran) -> None:
    assert ran[0].done("second")["dies-once.off"].attempts == 2


def test_a_shape_that_always_kills_its_process_is_given_up(ran) -> None:
    run = ran[0].failed("second")["dies.off"]
    assert run.attempts == 2
    assert run.reason is not None
    assert "its process died" in run.reason
    assert "2 times" in run.reason


def test_what_a_shape_finished_before_it_was_given_up_is_kept(ran) -> None:
    assert {"dies.off", "crashes.off"} <= set(ran[0].done("first"))


def test_a_shape_that_outlasts_the_deadline_is_given_up(ran) -> None:
    run = ran[0].failed("first")["hangs.off"]
    assert run.reason is not None
    assert f"deadline_s = {DEADLINE_S:g}; raise deadline_s under [workers.limits.first]" in run.reason
    assert run.attempts == 1


def test_progress_counts_each_shape_once(ran) -> None:
    assert ran[1][-1] == RunProgress(len(FINISH), len(SOURCES) - len(FINISH), len(SOURCES))
    assert [p.n_done + p.n_failed for p in ran[1]] == list(range(1, len(SOURCES) + 1))


def test_no_stage_works_twice_on_a_shape_that_lives(ran) -> None:
    assert ran[0].n_noted("second") == len(FINISH)


def test_nothing_stays_staged(ran) -> None:
    assert list(ran[0].workspace.arrays.staged_keys()) == []


def test_blocks_are_whole_and_no_larger_than_asked(ran) -> None:
    catalog, arrays = ran[0].workspace.catalog, ran[0].workspace.arrays
    blocks = catalog.visible_blocks()
    for block in blocks:
        assert block.n_shapes <= BLOCK_SHAPES
        arrays.verify(BlockAddress(block.name, block.n_shapes, block.n_bytes, block.checksum))
    assert sorted(block.name for block in blocks) == list(arrays.block_names())


def test_actors_close_what_they_opened(ran) -> None:
    assert ran[0].n_noted("closed") >= 2


def test_a_second_run_has_nothing_to_do(ran) -> None:
    assert list(ran[0].plan()) == []
