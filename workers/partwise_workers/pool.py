"""`ActorPool`: one shape per actor at a time, stage by stage, within deadlines; actors that die are replaced.

Calls go only to actors that have started, so that a deadline never counts the wait for a free core.
"""

import logging
import time
import uuid
from collections import deque
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any, TypeAlias

import ray
from ray.exceptions import ActorUnavailableError, RayError, RayTaskError

from partwise.errors import PartwiseError, WorkerError
from partwise.store.array_store import ArrayStore
from partwise.store.records import FailureKind
from partwise_workers.cluster import is_node_lost, require_living_node
from partwise_workers.events import ActorMemory, ActorRestarted, OnEvent, ignore_events
from partwise_workers.last_words import LastWords, last_words_name, read_progress, take_last_words, take_progress
from partwise_workers.supervision import Death, Job, Rules, why_large, why_late
from partwise_workers.tasks import ShapeOutcome, ShapeTask, StageFailure, StageReport, Started
from partwise_workers.watch import BYTES_PER_GB

logger = logging.getLogger(__name__)

Actor = Any  # Ray gives the methods of actors no types
Reference: TypeAlias = "ray.ObjectRef[Any]"  # starts, runs and packs are waited for together

MAX_FAILED_STARTS = 3
"""For each actor of the pool, so many may fail to start, none starting in between, before the run ends.

A node that goes takes all actors that are starting on it along; an installation that is broken fails them all.
"""

CLOSING_S = 5.0
"""Seconds that an idle actor has to close its renderer before it is killed."""

LAST_WORDS_S = 10.0
"""Seconds that a dead actor's sentinel has to tell why. It takes about one, on a busy machine several."""

_NOT_CREATED = "error raised in its creation task"
"""In what Ray says first of an actor that could not be made; what was raised there ends its text."""

UNREACHABLE_S = 45.0
"""Seconds that Ray has to find out that a node is lost, of an actor that nobody reports as dead. It takes about 15."""

RETAINED_SHARE = 0.5
"""Of the memory between a new actor's and the lowest ceiling: one that holds more between two stages is replaced."""


@dataclass(slots=True)
class _Worker:
    """An actor, how many shapes it has had, its process's memory when it was ready and as told last, and its node."""

    actor: Actor
    id: str
    n_shapes: int = 0
    base_bytes: int = 0
    resident_bytes: int = 0
    node_id: str = ""


@dataclass(slots=True)
class _Running:
    """A call on its way. step_began : of the step that it was last seen in; at first, of the call."""

    job: Job
    worker: _Worker
    started: float
    step_began: float


@dataclass(slots=True)
class _Dead:
    """A job whose process died; `kind` and `why` are what the driver knows, the last words may know better.

    is_unreachable : its node did not say that it died, so that the node may be lost. words : once they are there.
    """

    job: Job
    worker: _Worker
    kind: FailureKind
    why: str
    is_unreachable: bool
    seconds: float
    until: float
    words: LastWords | None = None

    @property
    def is_own_fault(self) -> bool:
        """Whether the last words say so: those of an actor that goes with its node's Ray are none or say nothing."""
        return self.words is not None and (self.words.is_over_memory or self.words.fatal_error is not None)

    @property
    def is_explained(self) -> bool:
        """Whether there is nothing to wait for any more."""
        return self.is_own_fault or (self.words is not None and not self.is_unreachable)


class ActorPool:
    """Needs a connected Ray.

    Parameters
    ----------
    new_actor : makes an actor whose `start`, `run` and `close` are a stage worker's, of its id.
    arrays : where dead actors' last words are.
    """

    def __init__(
        self,
        new_actor: Callable[[str], Actor],
        n_actors: int,
        rules: Rules,
        arrays: ArrayStore,
        on_event: OnEvent = ignore_events,
    ) -> None:
        self._new_actor = new_actor
        self._rules = rules
        self._arrays = arrays
        self._on_event = on_event
        self._lowest_ceiling = BYTES_PER_GB * min(limits.memory_gb for limits in rules.limits.values())
        self._starting: dict[Reference, _Worker] = {}
        self._idle: list[_Worker] = []
        self._running: dict[Reference, _Running] = {}
        self._dead: list[_Dead] = []
        self._closing: dict[Reference, tuple[_Worker, float]] = {}
        self._again: deque[Job] = deque()
        self._memory = ActorMemory(0, 0)
        self._n_failed_starts = 0
        self._max_failed_starts = MAX_FAILED_STARTS * n_actors
        for _ in range(n_actors):
            self._start_actor()

    @property
    def has_room(self) -> bool:
        """Whether an actor is free for a new task."""
        return len(self._idle) > len(self._again)

    @property
    def n_in_flight(self) -> int:
        """Tasks submitted that have not finished."""
        return len(self._running) + len(self._dead) + len(self._again)

    @property
    def is_done(self) -> bool:
        """Whether every task submitted has finished."""
        return self.n_in_flight == 0

    @property
    def is_mourning(self) -> bool:
        """Whether last words are waited for, which `references` do not announce."""
        return bool(self._dead)

    def submit(self, task: ShapeTask) -> None:
        """Starts a task; only while `has_room`."""
        self._begin(Job(task))

    def references(self) -> list[Reference]:
        """What to wait for: actors that are starting or closing, stages that are running."""
        return [*self._starting, *self._closing, *self._running]

    def collect(self, ready: Sequence[Reference]) -> list[ShapeOutcome]:
        """Takes in what is ready among `references`, looks at deadlines, and starts again what is to be tried again.

        Raises
        ------
        PartwiseError : the store or a stage's own needs (renderer, model) fail an actor, whatever the shape.
        WorkerError : actors cannot be started, or Ray has no node left.
        """
        finished = []
        for reference in ready:
            if reference in self._starting:
                self._welcome(reference)
            elif reference in self._running:
                finished += self._take(reference)
        finished += self._judge_late_ones()
        finished += self._bury_the_dead()
        self._dismiss(ready)
        while self._idle and self._again:
            self._begin(self._again.popleft())
        self._note_memory()
        return finished

    def close(self) -> None:
        """Lets idle actors close what they opened, then ends all."""
        closing = [worker.actor.close.remote() for worker in self._idle]
        leaving = [worker for worker, _ in self._closing.values()]
        working = [running.worker for running in self._running.values()]
        workers = [*self._idle, *self._starting.values(), *leaving, *working]
        self._idle, self._starting, self._running, self._closing = [], {}, {}, {}
        if closing:
            ray.wait(closing, num_returns=len(closing), timeout=CLOSING_S)
        for worker in workers:
            ray.kill(worker.actor)
        self._note_memory()

    def _note_memory(self) -> None:
        """Tells what the actors that have started hold."""
        leaving = (worker for worker, _ in self._closing.values())
        working = (running.worker for running in self._running.values())
        held = [worker.resident_bytes for worker in (*self._idle, *working, *leaving)]
        memory = ActorMemory(len(held), sum(held))
        if memory != self._memory:
            self._memory = memory
            self._on_event(memory)

    def _start_actor(self) -> None:
        require_living_node()
        worker_id = uuid.uuid4().hex
        worker = _Worker(self._new_actor(worker_id), worker_id)
        self._starting[worker.actor.start.remote()] = worker

    def _welcome(self, reference: Reference) -> None:
        worker = self._starting.pop(reference)
        try:
            started: Started = ray.get(reference)
        except RayError as error:
            ray.kill(worker.actor)
            raise_own(error)
            self._n_failed_starts += 1
            logger.warning("a worker process did not start", extra={"why": first_line(error)})
            if self._n_failed_starts >= self._max_failed_starts:
                raise WorkerError(
                    f"worker processes must start but {self._n_failed_starts} in a row did not: {first_line(error)}; "
                    "is Partwise with its [workers] extra installed on every node? See `partwise doctor`"
                ) from error
            self._start_actor()
        else:
            self._n_failed_starts = 0
            worker.base_bytes, worker.node_id = started.resident_bytes, started.node_id
            worker.resident_bytes = started.resident_bytes
            self._idle.append(worker)

    def _begin(self, job: Job) -> None:
        worker = self._idle.pop()
        worker.n_shapes += 1
        self._call(job, worker)

    def _call(self, job: Job, worker: _Worker) -> None:
        """Sends the job's next stage."""
        now = time.monotonic()
        self._running[worker.actor.run.remote(job.begin())] = _Running(job, worker, now, now)

    def _take(self, reference: Reference) -> list[ShapeOutcome]:
        running = self._running.pop(reference)
        job, worker = running.job, running.worker
        try:
            report: StageReport = ray.get(reference)
        except RayError as error:
            raise_own(error)
            is_unreachable = isinstance(error, ActorUnavailableError)
            self._lose(running, FailureKind.CRASH, f"its process died ({first_line(error)})", is_unreachable)
            return []
        worker.resident_bytes = report.resident_bytes
        is_bloated = self._is_bloated(worker)
        failure: StageFailure | None = None
        if isinstance(report.result, StageFailure):
            failure = report.result
        else:
            job.add(report.result)
        goes_on = failure is None and not job.is_done
        if goes_on and (job.was_moved or not is_bloated):
            self._call(job, worker)
            return []
        if is_bloated or worker.n_shapes >= self._rules.recycle_after:
            self._recycle(worker)
        else:
            self._idle.append(worker)
        if goes_on:
            job.was_moved = True
            job.restart()
            self._again.append(job)
            return []
        return [job.outcome(failure)]

    def _is_bloated(self, worker: _Worker) -> bool:
        """Whether the next stage would be blamed for memory that this process did not give back."""
        return worker.resident_bytes - worker.base_bytes > RETAINED_SHARE * (self._lowest_ceiling - worker.base_bytes)

    def _judge_late_ones(self) -> list[ShapeOutcome]:
        """Stops what is past its deadline, unless it has gone on while the driver was busy with other things."""
        late = [reference for reference, running in self._running.items() if self._is_late(running)]
        if not late:
            return []
        done, hung = ray.wait(late, num_returns=len(late), timeout=0)
        for reference in hung:
            if self._is_in_another_step(self._running[reference]):
                continue
            running = self._running.pop(reference)
            self._lose(running, FailureKind.DEADLINE, why_late(self._rules.limits[running.job.call.stage]))
        return [outcome for reference in done for outcome in self._take(reference)]

    def _is_late(self, running: _Running) -> bool:
        return time.monotonic() - running.step_began > self._rules.limits[running.job.call.stage].deadline_s

    def _is_in_another_step(self, running: _Running) -> bool:
        """Looks up which step a late call is in by now; whether that one is within its own deadline."""
        call = running.job.call
        progress = (
            read_progress(self._arrays, call.name, running.worker.id) if self._rules.n_steps[call.stage] > 1 else None
        )
        if progress is None:
            return False
        running.step_began = running.started + progress.began_s
        return not self._is_late(running)

    def _lose(self, running: _Running, kind: FailureKind, why: str, is_unreachable: bool = False) -> None:
        """Replaces the actor, and waits for its last words, or for its node to be known as lost."""
        ray.kill(running.worker.actor)
        self._start_actor()
        now = time.monotonic()
        seconds, until = now - running.started, now + (UNREACHABLE_S if is_unreachable else LAST_WORDS_S)
        self._dead.append(_Dead(running.job, running.worker, kind, why, is_unreachable, seconds, until))

    def _bury_the_dead(self) -> list[ShapeOutcome]:
        finished = []
        for dead in list(self._dead):
            if dead.words is None:
                dead.words = take_last_words(self._arrays, last_words_name(dead.job.call.name, dead.worker.id))
            is_lost = not dead.is_own_fault and is_node_lost(dead.worker.node_id)
            if not (dead.is_explained or is_lost or time.monotonic() >= dead.until):
                continue
            self._dead.remove(dead)
            death = self._death(dead, dead.words or LastWords(), is_lost)
            about = {"shape": dead.job.task.source_key, "n": dead.job.n_tries, "why": death.why}
            logger.warning("attempt failed", extra=about)
            self._on_event(ActorRestarted(death.kind))
            failure = dead.job.bury(death, self._rules)
            if failure is None:
                self._again.append(dead.job)
            else:
                finished.append(dead.job.outcome(failure))
        return finished

    def _death(self, dead: _Dead, words: LastWords, is_lost: bool) -> Death:
        call = dead.job.call
        has_steps = self._rules.n_steps[call.stage] > 1
        progress = take_progress(self._arrays, call.name, dead.worker.id) if has_steps else None
        step, refused = (None, {}) if progress is None else (progress.step, progress.refused)
        kind, why = dead.kind, dead.why
        if is_lost:
            kind, why = FailureKind.CRASH, "its process went with its node"
        elif words.is_over_memory:
            kind, why = FailureKind.MEMORY, why_large(self._rules.limits[call.stage], words.peak_bytes)
        elif kind is FailureKind.CRASH and words.fatal_error is not None:
            why = f"its process died ({words.fatal_error})"
        return Death(kind, why, step, words.log, dead.seconds, refused, is_lost)

    def _recycle(self, worker: _Worker) -> None:
        """Replaces an actor that has done its share, or holds too much."""
        self._closing[worker.actor.close.remote()] = (worker, time.monotonic() + CLOSING_S)
        self._start_actor()
        self._on_event(ActorRestarted(None))

    def _dismiss(self, ready: Sequence[Reference]) -> None:
        """Ends actors that have closed what they opened, or take too long to."""
        now = time.monotonic()
        for reference, (worker, until) in list(self._closing.items()):
            if reference in ready or now > until:
                del self._closing[reference]
                ray.kill(worker.actor)


def raise_own(error: RayError) -> None:
    """Raises what an actor raised if it is one of our errors: that is no accident of one process."""
    if isinstance(error, RayTaskError) and isinstance(error.cause, PartwiseError):
        raise error.cause from error


def first_line(error: Exception) -> str:
    """What an error says, in one line: of an error in an actor, what the actor raised."""
    cause = error.cause if isinstance(error, RayTaskError) and isinstance(error.cause, Exception) else error
    lines = [line.strip() for line in str(cause).splitlines() if line.strip()]
    text = "" if not lines else lines[-1] if _NOT_CREATED in lines[0] else lines[0]
    return f"{type(cause).__name__}: {text}" if cause is not error else text or type(error).__name__
