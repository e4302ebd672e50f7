"""`StageTally`: how far each stage of a run is, told to open pages now and then."""

import time
from collections.abc import Callable

from partwise.store.records import EventKind
from partwise_cli.jobs.work import Work
from partwise_workers.events import RunEvent, StageDone, StageFailed

EVERY_S = 5.0


class StageTally:
    """Counts what a run tells, and adds an event for each stage that has moved, every `EVERY_S` seconds at most."""

    def __init__(self, work: Work, clock: Callable[[], float] = time.monotonic) -> None:
        self._work = work
        self._clock = clock
        self._told_at = clock()
        self._counts: dict[str, list[int]] = {}
        self._has_moved: set[str] = set()

    def on_event(self, event: RunEvent, /) -> None:
        """Implements `OnEvent`."""
        self._work.on_event(event)
        match event:
            case StageDone(stage):
                self._counts.setdefault(stage, [0, 0])[0] += 1
            case StageFailed(stage):
                self._counts.setdefault(stage, [0, 0])[1] += 1
            case _:
                return
        self._has_moved.add(event.stage)
        if self._clock() - self._told_at >= EVERY_S:
            self.flush()

    def flush(self) -> None:
        """Tells what has not been told yet."""
        self._told_at = self._clock()
        for stage in sorted(self._has_moved):
            done, failed = self._counts[stage]
            payload = {"stage": stage, "job_kind": self._work.job.kind.value, "done": done, "failed": failed}
            self._work.add_event(EventKind.STAGE, payload)
        self._has_moved.clear()
