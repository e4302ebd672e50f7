"""The cyclic cosine learning rate and the iterations whose weights are kept (snapshot ensembling)."""

import math

from partwise.errors import ParameterError


def cycle_length(n_iterations: int, n_snapshots: int) -> int:
    """⌈T/M⌉, the iterations from one restart of the learning rate to the next."""
    return math.ceil(n_iterations / n_snapshots)


def learning_rate_at(iteration: int, n_iterations: int, n_snapshots: int, initial: float) -> float:
    """α(t) = α0/2 · (cos(π · mod(t−1, ⌈T/M⌉) / ⌈T/M⌉) + 1) for t = 1 … T.

    Parameters
    ----------
    iteration : t, counted from 1.
    n_iterations, n_snapshots : T and M.
    initial : α0, the rate at the start of every cycle.

    Raises
    ------
    ParameterError : t is outside 1 … T.

    Source: Huang et al. 2017 (snapshot ensembles), as printed by George et al. 2018.
    """
    if not 1 <= iteration <= n_iterations:
        raise ParameterError(f"iteration must be in 1 … {n_iterations} but is {iteration}; iterations count from 1")
    length = cycle_length(n_iterations, n_snapshots)
    return initial / 2 * (math.cos(math.pi * ((iteration - 1) % length) / length) + 1)


def snapshot_iterations(n_iterations: int, n_snapshots: int) -> tuple[int, ...]:
    """The iterations after which weights are kept: the end of each cycle, where the rate is lowest.

    Raises
    ------
    ParameterError : M does not divide T, so that the last cycle would be cut before its rate has fallen.
    """
    if n_iterations < 1 or n_snapshots < 1 or n_iterations % n_snapshots:
        raise ParameterError(
            f"n_iterations must be a positive multiple of n_snapshots but they are {n_iterations} and {n_snapshots}; "
            "choose, for example, 5000 and 5"
        )
    length = cycle_length(n_iterations, n_snapshots)
    return tuple(length * (cycle + 1) for cycle in range(n_snapshots))
