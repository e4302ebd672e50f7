"""What tests of several packages share."""

from collections.abc import Iterator

import pytest

N_CPUS = 2


@pytest.fixture(scope="session")
def local_ray() -> Iterator[None]:
    """One Ray of our own for all tests that need one: starting it costs several core-seconds."""
    from partwise_workers.cluster import connected

    with connected(n_cpus=N_CPUS):
        yield
