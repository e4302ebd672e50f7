"""`Reranking`: the queue in order of the latest scores, again and again while shapes are evaluated."""

import time
from collections.abc import Callable

from partwise.store.records import EventKind
from partwise.workspace.choices import ScoreName
from partwise.workspace.ranking import rank_queue
from partwise_cli.jobs.work import Work

MAX_SHARE = 0.05
"""Of the time that may go into ranking: of a large collection it takes seconds."""


class Reranking:
    """Ranks at most every `rank_every_s` seconds, and less often where a ranking takes long."""

    def __init__(self, work: Work, clock: Callable[[], float] = time.monotonic) -> None:
        self._work = work
        self._clock = clock
        self._next_at = clock() + work.workspace.config.jobs.rank_every_s

    def now_and_then(self) -> None:
        """Ranks if it is time."""
        if self._clock() >= self._next_at:
            self.rank()

    def rank(self) -> None:
        """Ranks; tells open pages if anything moved. What people hold stays as it is."""
        began = self._clock()
        n_moved = rank_queue(self._work.workspace, self._work.collection, ScoreName.ENTROPY)
        if n_moved:
            self._work.add_event(EventKind.QUEUE, {"re_ranked": n_moved})
        ended = self._clock()
        self._next_at = ended + max(self._work.workspace.config.jobs.rank_every_s, (ended - began) / MAX_SHARE)
