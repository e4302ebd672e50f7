"""How far a run over shapes is."""

from collections.abc import Callable
from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class RunProgress:
    """Shapes so far. `n_total` is what was planned when the run began."""

    n_done: int
    n_failed: int
    n_total: int


OnRunProgress = Callable[[RunProgress], None]
