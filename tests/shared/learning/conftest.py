"""Small pools of faces that can be learned in a few iterations."""

import numpy as np
import pytest

from partwise.learning.dataset import GRID_BINS, CodedGrids, FacePool
from partwise.learning.network import NetworkSpec
from partwise.learning.recipe import Recipe

PART_IDS = (3, 1, 7)
BRANCHES = ("shape_context", "spin_image")


def separable_pool(n_faces: int = 300, seed: int = 0) -> FacePool:
    """Three classes whose histograms are noise with one bright third of the rows."""
    rng = np.random.default_rng(seed)
    classes = rng.integers(0, len(PART_IDS), n_faces)
    grids = {}
    for branch in BRANCHES:
        codes = rng.integers(0, 60, (n_faces, GRID_BINS), dtype=np.uint8)
        for k in range(len(PART_IDS)):
            codes[np.flatnonzero(classes == k), 80 * k : 80 * k + 80] += 120
        grids[branch] = CodedGrids(codes, np.float32(0.002))
    return FacePool(grids, classes, PART_IDS)


@pytest.fixture
def pool() -> FacePool:
    return separable_pool()


@pytest.fixture
def spec() -> NetworkSpec:
    return NetworkSpec(n_parts=3, widths=(4, 8), hidden=16)


@pytest.fixture
def recipe() -> Recipe:
    return Recipe(n_iterations=12, n_snapshots=3, batch_size=32, learning_rate=0.003)
