"""`Turn`: how long background work goes on before others have theirs."""

import time
from collections.abc import Callable

from partwise_cli.jobs.stopping import JobStoppedError, StopReason
from partwise_cli.jobs.work import Work

CHECK_S = 2.0
"""Seconds between two looks at what waits, which is a query."""

SLICE_S = 300.0
"""Seconds after which background work gives way to other background work: starting its processes takes some."""


class Turn:
    """Asked before each shape: stops when the job should, and when another job that its owner could do waits.

    Trainings, exports and the like are given way to at once, background work of the same owner after `SLICE_S`.

    is_moot : asked now and then; once it says so the run stops, too, and its job goes on with something else.
    """

    def __init__(
        self, work: Work, is_moot: Callable[[], bool] = lambda: False, clock: Callable[[], float] = time.monotonic
    ) -> None:
        self._work = work
        self._is_moot = is_moot
        self._has_ended = False
        self._clock = clock
        self._began = self._checked = clock()
        self._for: str | None = None

    def may_go_on(self) -> bool:
        now = self._clock()
        if not self._has_ended and now - self._checked >= CHECK_S:
            self._checked = now
            other = self._work.waiting_job(also_background=now - self._began >= SLICE_S)
            self._for = None if other is None else f"gives way to job {other.id}, {other.kind}; goes on after it"
            self._has_ended = other is not None or self._is_moot()
        return not self._has_ended and not self._work.pulse.is_stopped

    def raise_if_over(self) -> None:
        """Raises JobStoppedError if the run was stopped."""
        self._work.pulse.raise_if_stopped()
        if self._for is not None:
            raise JobStoppedError(StopReason.GIVES_WAY, self._for)
