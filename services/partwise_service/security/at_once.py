"""`AtOnce`: how much each caller has under way at once. In memory, for one event loop."""

from collections import Counter
from collections.abc import Hashable, Iterator
from contextlib import contextmanager

from partwise_service.problems import ProblemError, ProblemKind

RETRY_AFTER_S = 2


class AtOnce:
    """Lets each key have `most` of something under way. what : as it is called in refusals, in the plural."""

    def __init__(self, most: int, what: str) -> None:
        self._most = most
        self._what = what
        self._under_way: Counter[Hashable] = Counter()

    @contextmanager
    def one_more(self, key: Hashable) -> Iterator[None]:
        """One is under way until the block ends. Problems: 429 if the key has as many as it may."""
        if self._under_way[key] >= self._most:
            raise ProblemError(
                ProblemKind.TOO_MANY,
                f"You have {self._most} {self._what} at once, as many as you may; end one or try again in a moment.",
                headers={"Retry-After": str(RETRY_AFTER_S)},
            )
        self._under_way[key] += 1
        try:
            yield
        finally:
            self._under_way[key] -= 1
            if not self._under_way[key]:
                del self._under_way[key]
