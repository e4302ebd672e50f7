"""A hierarchy of connected patches: which neighbours merge, in what order. Any number of patches is a cut of it.

Cuts are nested: one patch more splits one patch in two and leaves the others, and their numbers, as they were.
"""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float, Int

from partwise.errors import ParameterError
from partwise.segmentation.kernels.agglomeration import merge_sequence, undo_merges


@dataclass(frozen=True, slots=True, eq=False)
class PatchTree:
    """Merges of m leaves (faces, or patches of them) up to one node a connected component.

    n_leaves : m.
    merges : (m − c, 2) int64, merge i makes node m + i of two nodes, the one of greater area first.
    roots : (c,) int64, the nodes that nothing merged, ascending: one a component.
    """

    n_leaves: int
    merges: Int[np.ndarray, "q 2"]
    roots: Int[np.ndarray, " c"]

    @property
    def n_components(self) -> int:
        return len(self.roots)

    def cut(self, n_patches: int) -> Int[np.ndarray, " m"]:
        """Patch of each leaf, (m,) int64 from 0: exactly max(n_patches, n_components) patches.

        Raises
        ------
        ParameterError : n_patches is not in 1 … m.
        """
        check_n_patches(n_patches, self.n_leaves)
        n_undone = max(n_patches - self.n_components, 0)
        labels: np.ndarray = undo_merges(self.merges, self.n_leaves, self.roots, n_undone)
        return labels


def patch_tree(
    pairs: Int[np.ndarray, "k 2"], areas: Float[np.ndarray, " m"], features: Float[np.ndarray, "m d"]
) -> PatchTree:
    """Merges neighbours so that each step adds least to Σ area·|feature − mean of its patch|².

    Parameters
    ----------
    pairs : which leaves touch; a pair may come up more than once.
    areas : (m,) ≥ 0. Leaves without area merge at no cost, so first.
    features : (m, d), what should be alike within a patch.

    Source: Ward 1963, limited to neighbours. Ties go to the lower indices, so the result is always the same.
    """
    merges = merge_sequence(pairs, areas.astype(np.float64), np.ascontiguousarray(features, dtype=np.float64))
    is_root = np.ones(len(areas) + len(merges), dtype=bool)
    is_root[merges.ravel()] = False
    return PatchTree(len(areas), merges, np.flatnonzero(is_root))


def check_n_patches(n_patches: int, n_faces: int) -> None:
    """Raises ParameterError unless n_patches is a whole number in 1 … n_faces."""
    if isinstance(n_patches, bool) or not isinstance(n_patches, int | np.integer):
        raise ParameterError(f"n_patches must be a whole number but is {n_patches!r}; round it")
    if not 1 <= n_patches <= n_faces:
        raise ParameterError(
            f"n_patches must be in 1 … {n_faces}, the number of faces, but is {n_patches}; choose one in between"
        )
