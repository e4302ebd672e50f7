"""What happens to a shape whose process died: tried again, with another step, or given up. Plain rules, without Ray.

A stage has steps (`Stage.n_steps`), most have one. A step that takes too long or too much memory would do so again, and
has failed at once. A step whose process died by itself may have been unlucky: it is tried `max_attempts` times in all.
A process that went with its whole node counts as no try.
A shape goes on while its stage has steps left, so that a stage is tried `n_steps` x `max_attempts` times at most.
Each step has the deadline to itself. One that the stage got through and refused is not run again on later tries; what
it accepted is, as only the stage's end result is kept.
Failed and refused steps are known to the driver only: a run that is started anew begins with the first step again.
"""

from collections import Counter
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from typing import Any

from partwise.config import LimitsConfig, StageLimits
from partwise.store.records import FailureKind
from partwise_workers.tasks import ShapeOutcome, ShapeTask, StageCall, StagedResult, StageFailure

MAX_LOST_NODES = 5
"""Nodes that one shape may lose before it is suspected of taking them down."""

LOG_CHARACTERS = 4000
"""Of a dead process' log that go on record."""


@dataclass(frozen=True, slots=True)
class Rules:
    """limits, n_steps : of each stage. max_attempts : of a step whose process dies by itself.

    recycle_after : shapes after which an actor is replaced.
    """

    limits: Mapping[str, StageLimits]
    n_steps: Mapping[str, int]
    max_attempts: int
    recycle_after: int


@dataclass(frozen=True, slots=True)
class Death:
    """How a process ended. step : that its stage was in, None outside of steps. why : without the remedy.

    refused : steps that its stage had refused by then, each with the stage's record of it.
    is_node_lost : its whole node went, which is not put down to the shape.
    """

    kind: FailureKind
    why: str
    step: str | None
    log: str
    seconds: float
    refused: Mapping[str, Mapping[str, Any]] = field(default_factory=dict)
    is_node_lost: bool = False


@dataclass(slots=True)
class Job:
    """A shape on its way through its stages: what it has, and what befell it.

    was_moved : it changed actors because one held too much memory, which happens once at most.
    """

    task: ShapeTask
    was_moved: bool = False
    _results: list[StagedResult] = field(default_factory=list)
    _n_reached: int = 0
    _tries: Counter[str] = field(default_factory=Counter)
    _crashes: Counter[tuple[str, str | None]] = field(default_factory=Counter)
    _n_lost_nodes: int = 0
    _deaths: dict[str, Death] = field(default_factory=dict)
    _failed_steps: dict[str, dict[str, str]] = field(default_factory=dict)
    _refused_steps: dict[str, Mapping[str, Mapping[str, Any]]] = field(default_factory=dict)

    @property
    def is_done(self) -> bool:
        """Whether every stage has its result."""
        return len(self._results) == len(self.task.stage_keys)

    @property
    def call(self) -> StageCall:
        """The stage that is next, or at work."""
        stage, key = self.task.stage_keys[len(self._results)]
        return StageCall(
            self.task, stage, key, dict(self._failed_steps.get(stage, {})), self._refused_steps.get(stage, {})
        )

    @property
    def n_tries(self) -> int:
        """Of the stage that is at work."""
        return self._tries[self.call.stage]

    def begin(self) -> StageCall:
        """The next stage is sent to an actor; those that only find again what was finished count no try."""
        call = self.call
        if self._is_at_its_own:
            self._tries[call.stage] += 1
        return call

    @property
    def _is_at_its_own(self) -> bool:
        """Whether the stage at work is made, not found again."""
        return len(self._results) == self._n_reached

    def _uncount_try(self) -> None:
        if self._is_at_its_own:
            self._tries[self.call.stage] -= 1

    def add(self, result: StagedResult) -> None:
        """The stage at work is finished."""
        self._results.append(result)
        self._n_reached = max(self._n_reached, len(self._results))

    def restart(self) -> None:
        """Begins with the first stage again, on any actor: what is finished is found in staging."""
        self._results.clear()

    def outcome(self, failure: StageFailure | None = None) -> ShapeOutcome:
        """The end of it. A refusal after steps that died is put down to the last of them: other limits may help."""
        if failure is not None:
            call, death = self.call, self._deaths.get(failure.stage)
            kind = failure.kind if death is None else death.kind
            detail = dict(failure.detail)
            if call.failed_steps:
                detail["steps"] = dict(call.failed_steps)
            if death is not None and death.log:
                detail["log"] = death.log[-LOG_CHARACTERS:]
            failure = replace(failure, kind=kind, detail={"kind": kind.value, **detail})
        return ShapeOutcome(self.task.shape_id, tuple(self._results), failure, dict(self._tries))

    def bury(self, death: Death, rules: Rules) -> StageFailure | None:
        """Takes in that the process of the present call died; None if the shape is to be tried again."""
        call, why = self.call, death.why
        self._refused_steps[call.stage] = {**call.refused_steps, **death.refused}
        if death.is_node_lost and self._n_lost_nodes < MAX_LOST_NODES:
            self._n_lost_nodes += 1
            self._uncount_try()
            self.restart()
            return None
        self._deaths[call.stage] = death
        if death.kind is FailureKind.CRASH:
            place = (call.stage, death.step)
            self._crashes[place] += 1
            if self._crashes[place] < rules.max_attempts:
                self.restart()
                return None
            why += f", {self._crashes[place]} times" if self._crashes[place] > 1 else ""
        if death.step is not None and death.step not in call.failed_steps:
            steps = self._failed_steps.setdefault(call.stage, {})
            steps[death.step] = why
            if len(steps) < rules.n_steps[call.stage]:
                self.restart()
                return None
            why = f"each of its steps failed, the last one ({death.step}): {why}" if len(steps) > 1 else why
        reason = f"{why}; {_remedy(death.kind, call.stage)}"
        return StageFailure(call.stage, call.key, death.kind, reason, death.seconds)


def limits_of(config: LimitsConfig, stage: str, default: StageLimits) -> StageLimits:
    """A stage's limits, or the default if the configuration does not know the stage."""
    limits: StageLimits = getattr(config, stage, default)
    return limits


def why_late(limits: StageLimits) -> str:
    return f"it took longer than deadline_s = {limits.deadline_s:g}"


def why_large(limits: StageLimits, peak_bytes: int) -> str:
    return f"its memory grew past memory_gb = {limits.memory_gb:g}, to {peak_bytes / 1e9:.1f}"


def _remedy(kind: FailureKind, stage: str) -> str:
    if kind is FailureKind.DEADLINE:
        return f"raise deadline_s under [workers.limits.{stage}], or simplify its file"
    if kind is FailureKind.MEMORY:
        return f"raise memory_gb under [workers.limits.{stage}], or simplify its file"
    return "look at this shape's file, or let fewer actors share the memory ([workers] n_actors)"
