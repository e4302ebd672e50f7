"""`ActorPool`: one shape per actor at a time, with a deadline; actors that die are replaced, their shapes tried again.

Tasks go only to actors that have started, so that a deadline never counts the wait for a free core.
"""

import logging
import time
from collections import deque
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any, TypeAlias

import ray
from ray.exceptions import RayError, RayTaskError

from partwise.errors import PartwiseError
from partwise_workers.errors import WorkerError
from partwise_workers.tasks import ShapeOutcome, ShapeTask, StageFailure

logger = logging.getLogger(__name__)

Actor = Any  # Ray gives the methods of actors no types
Reference: TypeAlias = "ray.ObjectRef[Any]"  # starts, runs and packs are waited for together

MAX_FAILED_STARTS = 3
"""Actors that may fail to start, one after the other, before the run ends: then it is not the shapes."""

CLOSING_S = 5.0
"""Seconds that an idle actor has to close its renderer before it is killed."""


@dataclass(slots=True)
class _Attempt:
    """A task's `number`-th try. With `last_words`, it is given up, and only what was finished is asked for."""

    task: ShapeTask
    number: int = 1
    last_words: str = ""
    seconds: float = 0.0


@dataclass(slots=True)
class _Running:
    attempt: _Attempt
    actor: Actor
    started: float


@dataclass(frozen=True, slots=True)
class Finished:
    """A task's outcome and how many attempts it took."""

    outcome: ShapeOutcome
    attempts: int


class ActorPool:
    """Needs a connected Ray. `new_actor` makes an actor whose `start`, `run`, `give_up` and `close` are a worker's."""

    def __init__(self, new_actor: Callable[[], Actor], n_actors: int, deadline_s: float, max_attempts: int) -> None:
        self._new_actor = new_actor
        self._deadline_s = deadline_s
        self._max_attempts = max_attempts
        self._starting: dict[Reference, Actor] = {}
        self._idle: list[Actor] = []
        self._running: dict[Reference, _Running] = {}
        self._again: deque[_Attempt] = deque()
        self._n_failed_starts = 0
        for _ in range(n_actors):
            self._start_actor()

    @property
    def has_room(self) -> bool:
        """Whether an actor is free for a new task."""
        return len(self._idle) > len(self._again)

    @property
    def is_done(self) -> bool:
        """Whether every task submitted has finished."""
        return not self._running and not self._again

    def submit(self, task: ShapeTask) -> None:
        """Starts a task; only while `has_room`."""
        self._begin(_Attempt(task))

    def references(self) -> list[Reference]:
        """What to wait for: actors that are starting, tasks that are running."""
        return [*self._starting, *self._running]

    def collect(self, ready: Sequence[Reference]) -> list[Finished]:
        """Takes in what is ready among `references`, looks at deadlines, and starts again what is to be tried again.

        Raises
        ------
        PartwiseError : the store or a stage's own needs (renderer, model) fail an actor, whatever the shape.
        WorkerError : actors cannot be started.
        """
        finished = []
        for reference in ready:
            if reference in self._starting:
                self._welcome(reference)
            elif reference in self._running:
                finished += self._take(reference)
        finished += self._stop_late_ones()
        while self._idle and self._again:
            self._begin(self._again.popleft())
        return finished

    def close(self) -> None:
        """Lets idle actors close what they opened, then ends all."""
        closing = [actor.close.remote() for actor in self._idle]
        actors = [*self._idle, *self._starting.values(), *(running.actor for running in self._running.values())]
        self._idle, self._starting, self._running = [], {}, {}
        if closing:
            ray.wait(closing, num_returns=len(closing), timeout=CLOSING_S)
        for actor in actors:
            ray.kill(actor)

    def _start_actor(self) -> None:
        actor = self._new_actor()
        self._starting[actor.start.remote()] = actor

    def _welcome(self, reference: Reference) -> None:
        actor = self._starting.pop(reference)
        try:
            ray.get(reference)
        except RayError as error:
            ray.kill(actor)
            raise_own(error)
            self._n_failed_starts += 1
            logger.warning("a worker process did not start", extra={"why": first_line(error)})
            if self._n_failed_starts >= MAX_FAILED_STARTS:
                raise WorkerError(
                    f"worker processes must start but {self._n_failed_starts} in a row did not: {first_line(error)}; "
                    "is Partwise with its [workers] extra installed on every node? See `partwise doctor`"
                ) from error
            self._start_actor()
        else:
            self._n_failed_starts = 0
            self._idle.append(actor)

    def _begin(self, attempt: _Attempt) -> None:
        actor = self._idle.pop()
        if attempt.last_words:
            reference = actor.give_up.remote(attempt.task, attempt.last_words)
        else:
            reference = actor.run.remote(attempt.task)
        self._running[reference] = _Running(attempt, actor, time.monotonic())

    def _take(self, reference: Reference) -> list[Finished]:
        running = self._running.pop(reference)
        try:
            outcome: ShapeOutcome = ray.get(reference)
        except RayError as error:
            raise_own(error)
            remedy = "look at this shape's file, or let fewer actors share the memory ([workers] n_actors)"
            return self._after_death(running, f"its process died ({first_line(error)})", remedy)
        self._idle.append(running.actor)
        return [Finished(outcome, running.attempt.number)]

    def _stop_late_ones(self) -> list[Finished]:
        now = time.monotonic()
        late = [reference for reference, r in self._running.items() if now - r.started > self._deadline_s]
        finished = []
        for reference in late:
            why = f"it took longer than deadline_s = {self._deadline_s:g}"
            remedy = "raise deadline_s under [workers], or simplify its file"
            finished += self._after_death(self._running.pop(reference), why, remedy)
        return finished

    def _after_death(self, running: _Running, why: str, remedy: str) -> list[Finished]:
        """Replaces the actor and tries the shape again, or gives it up."""
        ray.kill(running.actor)
        self._start_actor()
        attempt = running.attempt
        logger.warning("attempt failed", extra={"shape": attempt.task.source_key, "n": attempt.number, "why": why})
        if attempt.last_words:  # not even what was finished can be told
            stage, key = attempt.task.stage_keys[0]
            failure = StageFailure(stage, key, attempt.last_words, attempt.seconds)
            return [Finished(ShapeOutcome(attempt.task.shape_id, (), failure), attempt.number)]
        seconds = time.monotonic() - running.started
        if attempt.number < self._max_attempts:
            self._again.append(_Attempt(attempt.task, attempt.number + 1))
        else:
            times = "" if attempt.number == 1 else f", {attempt.number} times"
            self._again.append(_Attempt(attempt.task, attempt.number, f"{why}{times}; {remedy}", seconds))
        return []


def raise_own(error: RayError) -> None:
    """Raises what an actor raised if it is one of our errors: that is no accident of one process."""
    if isinstance(error, RayTaskError) and isinstance(error.cause, PartwiseError):
        raise error.cause from error


def first_line(error: Exception) -> str:
    """What an error says, in one line: of an error in an actor, what the actor raised."""
    cause = error.cause if isinstance(error, RayTaskError) and isinstance(error.cause, Exception) else error
    lines = [line.strip() for line in str(cause).splitlines() if line.strip()]
    text = lines[0] if lines else ""
    return f"{type(cause).__name__}: {text}" if cause is not error else text or type(error).__name__
