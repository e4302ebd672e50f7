"""What tests of several packages share."""

import os
import shutil
import signal
from collections.abc import Iterator
from pathlib import Path

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
FILES_IN_MEMORY = Path("/dev/shm")  # noqa: S108 - pytest makes folders of its own there
ROOM_BYTES = 4 * 1024**3
LONG = (
    "web/test_operator.py", "workers/test_mishaps.py", "shared/store/test_catalog_on_postgres.py",
    "workers/test_steps.py", "workers/test_runner.py", "integration/test_pipeline.py", "web/test_lead.py",
    "web/test_accessibility.py", "web/annotator/test_annotator.py", "web/annotator/test_never_loses.py",
    "workers/test_training.py", "web/test_page_bench.py", "integration/test_remeshing.py", "integration/test_jobs.py",
    "web/test_login.py",
)  # fmt: skip
"""Files that take longest, in the order in which they run: first, so that no process is left with one of them when the
others have ended. Of those that need kernels compiled, or the chairs of the page's tests, one comes well before the
others, which find them made.
"""


def pytest_configure() -> None:
    """What tests start can be interrupted, even where a shell began the tests in its background. What they write is in
    memory where there is room: as catalogs wait for the disk with every commit, so would most tests.
    """
    if signal.getsignal(signal.SIGINT) == signal.SIG_IGN:
        signal.signal(signal.SIGINT, signal.default_int_handler)
    if FILES_IN_MEMORY.is_dir() and shutil.disk_usage(FILES_IN_MEMORY).free >= ROOM_BYTES:
        os.environ.setdefault("PYTEST_DEBUG_TEMPROOT", str(FILES_IN_MEMORY))


def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """Puts the files of `LONG` first."""
    turns = {Path(__file__).parent / name: turn for turn, name in enumerate(LONG)}
    items.sort(key=lambda item: turns.get(item.path, len(LONG)))


@pytest.fixture(scope="session")
def postgres() -> Iterator[str]:
    """URL of a PostgreSQL server of our own for all tests that need one."""
    from partwise.testing.postgres import postgres_server

    with postgres_server() as url:
        yield url


@pytest.fixture(scope="session")
def local_ray() -> Iterator[None]:
    """One Ray of our own for all tests that need one: starting it costs several core-seconds."""
    from partwise_workers.cluster import connected

    with connected(n_cpus=N_CPUS):
        yield
