"""Connecting to Ray: a local instance by default, the cluster that `RAY_ADDRESS` names otherwise."""

import logging
import os
from collections.abc import Iterator
from contextlib import contextmanager

import ray

from partwise.errors import StoreError

logger = logging.getLogger(__name__)

_THREAD_COUNTS = ("OMP", "OPENBLAS", "MKL", "NUMBA")
ONE_THREAD = {f"{library}_NUM_THREADS": "1" for library in _THREAD_COUNTS}
"""Environment of an actor that works on one shape on one core."""

LOCAL_OBJECT_STORE_BYTES = 128 * 1024 * 1024  # ids and small summaries travel, never arrays


@contextmanager
def connected(n_cpus: int | None = None) -> Iterator[None]:
    """Ray for the time of the block. An instance that is already connected is used and left running.

    Raises
    ------
    StoreError : the cluster at `RAY_ADDRESS` cannot be reached.
    """
    if ray.is_initialized():
        yield
        return
    os.environ.setdefault("RAY_USAGE_STATS_ENABLED", "0")
    address = os.environ.get("RAY_ADDRESS")
    try:
        if address:
            ray.init(address=address, log_to_driver=False, logging_level=logging.ERROR)
        else:
            ray.init(
                num_cpus=n_cpus or os.cpu_count(),
                include_dashboard=False,
                log_to_driver=False,
                logging_level=logging.ERROR,
                object_store_memory=LOCAL_OBJECT_STORE_BYTES,
            )
    except (ConnectionError, RuntimeError, ValueError) as error:
        place = f"the Ray cluster at RAY_ADDRESS={address}" if address else "a local Ray"
        raise StoreError(
            f"{place} must be reachable but: {error}; start it, or unset RAY_ADDRESS to work locally"
        ) from error
    try:
        yield
    finally:
        ray.shutdown()


def n_cores() -> int:
    """Cores of the connected Ray, at least one."""
    resources: dict[str, float] = ray.cluster_resources()  # type: ignore[no-untyped-call]
    return max(1, int(resources.get("CPU", 1)))
