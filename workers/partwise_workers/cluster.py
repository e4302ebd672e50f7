"""Connecting to Ray: a local instance of our own by default, the cluster that `RAY_ADDRESS` names otherwise."""

import logging
import os
import socket
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass

import ray

from partwise.errors import WorkerError

logger = logging.getLogger(__name__)

THREAD_VARIABLES = (
    "OMP_NUM_THREADS",
    "OPENBLAS_NUM_THREADS",
    "MKL_NUM_THREADS",
    "NUMBA_NUM_THREADS",
    "OPENCV_FOR_THREADS_NUM",
)

LOCAL_OBJECT_STORE_BYTES = 128 * 1024 * 1024  # ids and small summaries travel, never arrays

CONNECT_S = 10.0

LOCAL_SYSTEM = {
    # Actors have an environment of their own, so that Ray would start general workers for nothing.
    "enable_worker_prestart": False,
    "prestart_worker_first_driver": False,
    # On a machine that is busy with other things, a process that is slow to answer is not dead.
    "worker_register_timeout_seconds": 300,
    "agent_register_timeout_ms": 300_000,
    "health_check_timeout_ms": 60_000,
}


@contextmanager
def connected(n_cpus: int | None = None) -> Iterator[None]:
    """Ray for the time of the block. An instance that is already connected is used and left running.

    Parameters
    ----------
    n_cpus : cores of a local instance; None takes all.

    Raises
    ------
    WorkerError : the cluster at `RAY_ADDRESS` cannot be reached, or no local instance can be started.
    """
    if ray.is_initialized():
        yield
        return
    os.environ.setdefault("RAY_USAGE_STATS_ENABLED", "0")
    address = os.environ.get("RAY_ADDRESS")
    try:
        if address:
            require_listener(address)
            ray.init(address=address, log_to_driver=False, logging_level=logging.ERROR)
        else:
            _start_local(n_cpus or os.cpu_count() or 1)
    except Exception as error:  # Ray raises bare ones too, as for a node that is slow to start
        raise WorkerError(_why_not(address, error)) from error
    try:
        yield
    finally:
        ray.shutdown()


def _why_not(address: str | None, error: Exception) -> str:
    reason = next(iter(str(error).strip().splitlines()), type(error).__name__)
    if address:
        return (
            f"the Ray cluster at RAY_ADDRESS={address} must be reachable but: {reason}; start it, or unset RAY_ADDRESS "
            "to work locally"
        )
    return f"a local Ray must start but: {reason}; is there room in /tmp and /dev/shm, or is the machine too busy?"


def require_listener(address: str) -> None:
    """Raises OSError at once where nobody listens at `host:port` or `ray://host:port`: Ray itself tries for minutes."""
    host, colon, port = address.rpartition("//")[2].rpartition(":")
    if colon and port.isdecimal():
        socket.create_connection((host.strip("[]"), int(port)), timeout=CONNECT_S).close()


def _start_local(n_cpus: int) -> None:
    ray.init(
        address="local",  # without it Ray joins any instance that somebody has started on this machine
        num_cpus=n_cpus,
        include_dashboard=False,
        log_to_driver=False,
        logging_level=logging.ERROR,
        object_store_memory=LOCAL_OBJECT_STORE_BYTES,
        _system_config=LOCAL_SYSTEM,
    )


@dataclass(frozen=True, slots=True)
class Cores:
    """Cores of the connected Ray: in all, and of its largest and smallest node that has any. At least one each."""

    total: int
    largest_node: int
    smallest_node: int


def cores() -> Cores:
    """Counted anew: nodes come and go."""
    counts = [int(node["Resources"].get("CPU", 0)) for node in ray.nodes() if node["Alive"]]  # type: ignore[no-untyped-call]
    with_any = [count for count in counts if count > 0] or [1]
    return Cores(sum(with_any), max(with_any), min(with_any))


def require_living_node() -> None:
    """Raises WorkerError where Ray has no node left: processes that are asked for would be waited for without end."""
    if not any(node["Alive"] for node in ray.nodes()):  # type: ignore[no-untyped-call]
        raise WorkerError(
            "Ray must have a node to work on but its last one died (its raylet was killed, or the machine ran out of "
            "memory); run again: what is finished is kept"
        )


def is_node_lost(node_id: str) -> bool:
    """Whether Ray has given a node up: preempted, switched off, out of reach. Ray takes seconds to."""
    return not any(node["Alive"] for node in ray.nodes() if node["NodeID"] == node_id)  # type: ignore[no-untyped-call]


def n_cores() -> int:
    """Cores of the connected Ray, at least one."""
    return cores().total


@dataclass(frozen=True, slots=True)
class Crew:
    """How many actors work at a time, and with how many threads each."""

    n_actors: int
    n_threads: int

    @classmethod
    def of(cls, cores: Cores, n_shapes: int, n_wanted: int) -> "Crew":
        """One core a shape; where there are fewer shapes than cores, what is left over goes to each as threads.

        Parameters
        ----------
        n_wanted : actors that the user asks for, one thread each; 0 leaves it to the cores.
        """
        if n_wanted:
            return cls(min(n_wanted, max(1, n_shapes)), 1)
        n_actors = min(cores.total, max(1, n_shapes))
        return cls(n_actors, max(1, min(cores.total // n_actors, cores.smallest_node)))


def thread_environment(n_threads: int) -> dict[str, str]:
    """Environment that has the numerical libraries of an actor use so many threads."""
    return dict.fromkeys(THREAD_VARIABLES, str(n_threads))
