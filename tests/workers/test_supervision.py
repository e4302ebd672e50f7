"""What the rules make of processes that die, without any process."""

from dataclasses import replace

import pytest

from partwise.config import LimitsConfig, StageLimits
from partwise.store.records import FailureKind
from partwise_workers.supervision import LOG_CHARACTERS, MAX_LOST_NODES, Death, Job, Rules, limits_of
from partwise_workers.tasks import ShapeTask, StagedResult, StageFailure

TASK = ShapeTask(7, "a.off", "sources/a", (("first", "k1"), ("second", "k2")), {})
CRASH, DEADLINE, MEMORY, ERROR = FailureKind.CRASH, FailureKind.DEADLINE, FailureKind.MEMORY, FailureKind.ERROR


def rules(n_steps: int = 1, max_attempts: int = 2) -> Rules:
    limits = dict.fromkeys(("first", "second"), StageLimits())
    return Rules(limits, dict.fromkeys(limits, n_steps), max_attempts, recycle_after=200)


def death(kind: FailureKind, step: str | None = None, log: str = "") -> Death:
    return Death(kind, f"why {kind}", step, log, 1.5)


def lives(job: Job, kind: FailureKind, step: str | None = None, **kwargs: int) -> bool:
    """Whether the shape is tried again after one more try that dies."""
    job.begin()
    return job.bury(death(kind, step), rules(**kwargs)) is None


def done(stage: str) -> StagedResult:
    return StagedResult(stage, "k", f"{stage}/7-k", 1, 1.0, {})


@pytest.mark.parametrize("kind", [DEADLINE, MEMORY])
def test_a_breach_of_a_limit_is_not_tried_again(kind: FailureKind) -> None:
    assert not lives(Job(TASK), kind)


@pytest.mark.parametrize("max_attempts", [1, 2, 5])
def test_a_crash_is_tried_as_often_as_configured(max_attempts: int) -> None:
    job = Job(TASK)
    verdicts = [lives(job, CRASH, max_attempts=max_attempts) for _ in range(max_attempts)]
    assert verdicts == [True] * (max_attempts - 1) + [False]


def test_a_step_that_breaches_a_limit_is_passed_over_at_once() -> None:
    job = Job(TASK)
    assert lives(job, DEADLINE, "0", n_steps=2)
    assert job.call.failed_steps == {"0": "why deadline"}


def test_a_step_that_crashes_is_tried_again_before_it_is_passed_over() -> None:
    job = Job(TASK)
    assert lives(job, CRASH, "0", n_steps=2)
    assert job.call.failed_steps == {}
    assert lives(job, CRASH, "0", n_steps=2)
    assert job.call.failed_steps == {"0": "why crash, 2 times"}


def test_a_shape_is_given_up_when_its_last_step_fails() -> None:
    job = Job(TASK)
    assert [lives(job, MEMORY, step, n_steps=3) for step in "012"] == [True, True, False]


def test_a_stage_with_steps_that_dies_outside_of_them_is_given_up() -> None:
    assert not lives(Job(TASK), DEADLINE, None, n_steps=3)


def test_a_stage_that_enters_a_failed_step_again_is_given_up() -> None:
    job = Job(TASK)
    assert [lives(job, DEADLINE, "0", n_steps=3) for _ in range(2)] == [True, False]


@pytest.mark.parametrize(("n_steps", "max_attempts"), [(1, 2), (3, 2), (4, 3)])
def test_tries_are_bounded_by_steps_times_attempts(n_steps: int, max_attempts: int) -> None:
    job, n_tries = Job(TASK), 1
    while lives(job, CRASH, str(len(job.call.failed_steps)), n_steps=n_steps, max_attempts=max_attempts):
        n_tries += 1
    assert n_tries == job.n_tries == n_steps * max_attempts


def lost() -> Death:
    return replace(death(CRASH), is_node_lost=True)


def test_a_lost_node_counts_as_no_try() -> None:
    job = Job(TASK)
    for _ in range(2):
        job.begin()
        assert job.bury(lost(), rules(max_attempts=1)) is None
    job.begin()
    assert job.n_tries == 1


def test_a_lost_node_uncounts_no_try_where_a_finished_stage_was_found_again() -> None:
    job = Job(TASK)
    job.begin()
    job.add(done("first"))
    lives(job, CRASH)
    job.begin()
    assert job.bury(lost(), rules()) is None
    for stage in ("first", "second"):
        job.begin()
        job.add(done(stage))
    assert job.outcome().tries == {"first": 1, "second": 2}


def test_what_was_refused_before_the_node_was_lost_is_not_made_again() -> None:
    job = Job(TASK)
    job.begin()
    job.bury(replace(lost(), refused={"0": {}}), rules())
    assert job.call.refused_steps == {"0": {}}


def test_a_shape_that_loses_node_after_node_is_given_up() -> None:
    job = Job(TASK)
    verdicts = []
    for _ in range(MAX_LOST_NODES + 2):
        job.begin()
        verdicts.append(job.bury(lost(), rules(max_attempts=2)) is None)
    assert verdicts == [True] * (MAX_LOST_NODES + 1) + [False]


def test_a_refused_step_is_passed_over_after_every_death() -> None:
    job = Job(TASK)
    for refused in ({"0": {"why": "far"}}, {}):  # the second process dies before it says anything
        job.begin()
        assert job.bury(replace(death(CRASH, "1"), refused=refused), rules(n_steps=3)) is None
        assert job.call.refused_steps == {"0": {"why": "far"}}


def test_refused_steps_of_one_stage_are_not_those_of_another() -> None:
    job = Job(TASK)
    job.begin()
    job.bury(replace(death(CRASH, "1"), refused={"0": {}}), rules(n_steps=3))
    job.begin()
    job.add(done("first"))
    assert job.call.refused_steps == {}


def test_steps_of_one_stage_are_not_those_of_another() -> None:
    job = Job(TASK)
    lives(job, DEADLINE, "0", n_steps=2)
    job.begin()
    job.add(done("first"))
    assert job.call.failed_steps == {}


def test_finished_stages_that_are_found_again_count_no_try() -> None:
    job = Job(TASK)
    job.begin()
    job.add(done("first"))
    lives(job, CRASH)
    for stage in ("first", "second"):
        job.begin()
        job.add(done(stage))
    assert job.outcome().tries == {"first": 1, "second": 2}


def test_finished_stages_are_kept_when_a_later_one_is_given_up() -> None:
    job = Job(TASK)
    job.begin()
    job.add(done("first"))
    job.begin()
    outcome = job.outcome(job.bury(death(DEADLINE), rules()))
    assert outcome.results == (done("first"),)
    assert outcome.failure is not None
    assert outcome.failure.stage == "second"


def buried(*deaths: Death, n_steps: int = 1) -> StageFailure:
    """The failure on record after these deaths, the last of which is the end."""
    job = Job(TASK)
    for each in deaths:
        job.begin()
        failure = job.bury(each, rules(n_steps))
    failure = job.outcome(failure).failure
    assert failure is not None
    return failure


def test_the_record_has_kind_steps_and_the_end_of_the_log() -> None:
    log = "x" * LOG_CHARACTERS + "the end"
    failure = buried(death(DEADLINE, "0", "early"), death(MEMORY, "1", log), n_steps=2)
    assert failure.detail == {
        "kind": "memory",
        "steps": {"0": "why deadline", "1": "why memory"},
        "log": log[-LOG_CHARACTERS:],
    }


@pytest.mark.parametrize(
    ("kind", "remedy"),
    [(DEADLINE, "raise deadline_s under"), (MEMORY, "raise memory_gb under"), (CRASH, "look at this shape's file")],
)
def test_the_reason_is_one_line_with_a_remedy(kind: FailureKind, remedy: str) -> None:
    reason = buried(*[death(kind)] * (2 if kind is CRASH else 1)).reason
    assert reason.startswith(f"why {kind}")
    assert remedy in reason
    assert "\n" not in reason


def test_a_refusal_after_steps_that_died_is_put_down_to_the_last_of_them() -> None:
    job = Job(TASK)
    lives(job, DEADLINE, "0", n_steps=3)
    job.begin()
    failure = job.outcome(StageFailure("first", "k1", ERROR, "no way is left", 1.0, {"attempts": []})).failure
    assert failure is not None
    assert (failure.kind, failure.reason) == (DEADLINE, "no way is left")
    assert failure.detail == {"kind": "deadline", "attempts": [], "steps": {"0": "why deadline"}}


def test_limits_are_those_of_the_configuration_where_it_knows_the_stage() -> None:
    default = StageLimits(1.0, 1.0)
    assert limits_of(LimitsConfig(), "remesh", default).deadline_s == 300.0
    assert limits_of(LimitsConfig(), "unheard of", default) is default
