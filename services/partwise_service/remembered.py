"""`Remembered`: answers that are costly to make, kept for a short while."""

from collections.abc import Callable, Hashable
from threading import Lock
from typing import Generic, TypeVar

Answer = TypeVar("Answer")


class Remembered(Generic[Answer]):
    """Makes an answer at most once in `ttl_s` for each key, however many ask. Threads may share it.

    clock : seconds, monotone. Who asks while an answer is made waits for it.
    """

    def __init__(self, ttl_s: float, clock: Callable[[], float], max_keys: int = 256) -> None:
        self._ttl_s = ttl_s
        self._clock = clock
        self._max_keys = max_keys
        self._answers: dict[Hashable, tuple[float, Answer]] = {}
        self._locks: dict[Hashable, Lock] = {}
        self._lock = Lock()

    def get(self, key: Hashable, make: Callable[[], Answer]) -> Answer:
        """The answer for the key, made anew if it is older than `ttl_s`."""
        with self._lock:
            own = self._locks.setdefault(key, Lock())
        with own:
            known = self._answers.get(key)
            if known is not None and self._clock() - known[0] < self._ttl_s:
                return known[1]
            made = make()
            with self._lock:
                self._answers[key] = (self._clock(), made)
                while len(self._answers) > self._max_keys:
                    oldest = next(iter(self._answers))
                    del self._answers[oldest]
                    self._locks.pop(oldest, None)
            return made
