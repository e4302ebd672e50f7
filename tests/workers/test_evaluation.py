"""Plans of evaluation in the background: in the order asked for, looked up as they are taken."""

import pytest

from partwise_workers import evaluation
from partwise_workers.evaluation import _Plan
from partwise_workers.passes import always

KEYS = ("a.off", "b.off", "c.off", "d.off")


@pytest.fixture
def bench(make_bench):
    return make_bench(dict.fromkeys(KEYS, ""))


def _ids(bench, *keys: str) -> list[int]:
    return [bench.shapes[key] for key in keys]


def test_shapes_come_in_the_order_asked_for(bench) -> None:
    wanted = _ids(bench, "c.off", "a.off", "d.off", "b.off")
    plan = _Plan(bench.workspace, wanted, bench.stages, (), always)
    assert [task.shape_id for task in plan] == wanted


def test_pages_follow_on_each_other(bench, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(evaluation, "PAGE", 3)
    wanted = _ids(bench, "d.off", "c.off", "b.off", "a.off")
    plan = _Plan(bench.workspace, wanted, bench.stages, (), always)
    assert [task.shape_id for task in plan] == wanted


def test_it_says_how_much_there_is_to_do(bench, monkeypatch: pytest.MonkeyPatch) -> None:
    """Unknown shapes, as those that need nothing, are taken off as soon as they are looked at."""
    monkeypatch.setattr(evaluation, "PAGE", 2)
    plan = _Plan(bench.workspace, [*_ids(bench, "a.off"), 997, 998, *_ids(bench, "b.off")], bench.stages, (), always)
    tasks = iter(plan)
    assert plan.n_left == 4
    next(tasks)
    assert plan.n_left == 3
    next(tasks)
    assert plan.n_left == 2


def test_shapes_that_lack_what_is_read_are_passed_over(bench) -> None:
    plan = _Plan(bench.workspace, _ids(bench, *KEYS), bench.stages[1:], bench.stages[:1], always)
    assert list(plan) == []
    assert plan.n_left == 0


def test_it_ends_when_it_is_told(bench) -> None:
    answers = iter([True, True, False])
    plan = _Plan(bench.workspace, _ids(bench, *KEYS), bench.stages, (), lambda: next(answers))
    assert len(list(plan)) == 2
