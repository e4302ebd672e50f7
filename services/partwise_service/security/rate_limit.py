"""`FailureLimiter`: how often a caller may fail to prove who they are. In memory, bounded."""

from collections import OrderedDict, deque
from collections.abc import Callable, Hashable
from threading import Lock


class FailureLimiter:
    """Counts failures by key in a sliding window. Threads may share it.

    Parameters
    ----------
    max_failures : that a key may have in the window; the next is too many. window_s : seconds.
    max_keys : remembered at most; the key that failed longest ago is forgotten first.
    clock : seconds, monotone.
    """

    def __init__(self, max_failures: int, window_s: float, clock: Callable[[], float], max_keys: int = 10_000) -> None:
        self._max_failures = max_failures
        self._window_s = window_s
        self._clock = clock
        self._max_keys = max_keys
        self._failures: OrderedDict[Hashable, deque[float]] = OrderedDict()
        self._lock = Lock()

    def wait_s(self, key: Hashable) -> float:
        """Seconds until the key may try again; 0 if it may now."""
        with self._lock:
            times = self._recent(key)
            if len(times) < self._max_failures:
                return 0.0
            return max(0.0, times[0] + self._window_s - self._clock())

    def record(self, key: Hashable) -> None:
        """Counts a failure of the key."""
        with self._lock:
            times = self._recent(key)
            times.append(self._clock())
            while len(times) > self._max_failures:
                times.popleft()
            self._failures[key] = times
            self._failures.move_to_end(key)
            while len(self._failures) > self._max_keys:
                self._failures.popitem(last=False)

    def _recent(self, key: Hashable) -> deque[float]:
        times = self._failures.get(key, deque())
        limit = self._clock() - self._window_s
        while times and times[0] <= limit:
            times.popleft()
        return times
