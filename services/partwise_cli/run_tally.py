"""`RunTally`: what a run over shapes has told so far, and how fast it goes; nothing about how that is shown."""

import time
from collections import Counter, deque
from collections.abc import Callable

from partwise.store.records import FailureKind
from partwise.workspace.progress import RunProgress
from partwise_workers.events import ActorRestarted, InFlight, RunEvent, StageDone, StageFailed

WINDOW_S = 180.0
"""The rate is that of so many last seconds: shapes take very different times."""

SAMPLE_S = 1.0


class RunTally:
    """Takes in progress and events. `stages` : name → [done, failed], in the order in which they appeared."""

    def __init__(self, clock: Callable[[], float] = time.monotonic) -> None:
        self._clock = clock
        self._samples: deque[tuple[float, int]] = deque()
        self._started = clock()
        self.progress = RunProgress(0, 0, 0)
        self.stages: dict[str, list[int]] = {}
        self.failures: Counter[FailureKind] = Counter()
        self.n_in_flight = 0
        self.n_recycled = 0
        self.n_restarted = 0

    def on_progress(self, progress: RunProgress) -> None:
        """A new round, which is one that knows another total or has less done, has a rate of its own."""
        before, self.progress = self.progress, progress
        now, n_seen = self._clock(), self.n_seen
        if progress.n_total != before.n_total or n_seen < before.n_done + before.n_failed:
            self._samples.clear()
        if not self._samples or now - self._samples[-1][0] >= SAMPLE_S:
            self._samples.append((now, n_seen))
        while len(self._samples) > 2 and now - self._samples[1][0] >= WINDOW_S:
            self._samples.popleft()

    def on_event(self, event: RunEvent, /) -> None:
        """Implements `OnEvent`."""
        match event:
            case StageDone(stage):
                self.stages.setdefault(stage, [0, 0])[0] += 1
            case StageFailed(stage, kind):
                self.stages.setdefault(stage, [0, 0])[1] += 1
                self.failures[kind] += 1
            case InFlight(n):
                self.n_in_flight = n
            case ActorRestarted(None):
                self.n_recycled += 1
            case ActorRestarted():
                self.n_restarted += 1

    @property
    def n_seen(self) -> int:
        """Shapes done or failed."""
        return self.progress.n_done + self.progress.n_failed

    @property
    def elapsed_s(self) -> float:
        return self._clock() - self._started

    @property
    def per_min(self) -> float | None:
        """Shapes a minute of late; None before there is anything to go by. It falls while nothing finishes."""
        if not self._samples:
            return None
        since, n_then = self._samples[0]
        seconds = self._clock() - since
        return 60 * (self.n_seen - n_then) / seconds if seconds > 0 and self.n_seen > n_then else None

    @property
    def left_s(self) -> float | None:
        """Seconds until all are done at that rate; None where it is unknown."""
        rate = self.per_min
        return None if rate is None else 60 * (self.progress.n_total - self.n_seen) / rate
