"""What tests of several packages share."""

import signal
from collections.abc import Iterator

import pytest
from jaxtyping import install_import_hook

ARRAY_FUNCTIONS = (
    "geometry.adjacency", "geometry.dihedral", "geometry.faces", "geometry.sampling", "geometry.vertices",
    "features.shape_context", "features.shape_diameter", "features.spin_image",
    "segmentation.alpha_expansion", "segmentation.boundary_costs", "segmentation.boundary_distances",
    "segmentation.crease_walk", "segmentation.creases", "segmentation.k_means_patches",
    "labels.face_runs", "simulate.annotator.motor", "simulate.annotator.moves",
)  # fmt: skip
"""Modules whose annotations are checked on every call while tests run: array shapes, dtypes, and that they agree.

Modules that check what they are given themselves are not among them: their own errors are what is tested.
"""

install_import_hook([f"partwise.{module}" for module in ARRAY_FUNCTIONS], "beartype.beartype")

N_CPUS = 2


def pytest_configure() -> None:
    """What tests start can be interrupted, even where a shell began the tests in its background."""
    if signal.getsignal(signal.SIGINT) == signal.SIG_IGN:
        signal.signal(signal.SIGINT, signal.default_int_handler)


@pytest.fixture(scope="session")
def local_ray() -> Iterator[None]:
    """One Ray of our own for all tests that need one: starting it costs several core-seconds."""
    from partwise_workers.cluster import connected

    with connected(n_cpus=N_CPUS):
        yield
