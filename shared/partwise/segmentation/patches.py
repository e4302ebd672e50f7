"""Over-segmentation: a shape cut into connected patches for people to pick from, by one of two methods.

patches = over_segment(mesh, "random_walks")
labels = patches.patches(40)
"""

from typing import Protocol, get_args

import numpy as np
from jaxtyping import Float, Int

from partwise.errors import ParameterError
from partwise.mesh import TriMesh
from partwise.segmentation.k_means_patches import KMeansPatches
from partwise.segmentation.patch_parameters import PatchMethod
from partwise.segmentation.random_walk_patches import RandomWalkPatches


class OverSegmentation(Protocol):
    """A mesh prepared once, to be cut into any number of patches."""

    @property
    def n_faces(self) -> int: ...

    @property
    def n_components(self) -> int: ...

    def patches(self, n_patches: int) -> Int[np.ndarray, " m"]:
        """Patch of each face, (m,) int64 in 0 … max(n_patches, n_components) − 1, each of them connected across edges.

        A component has at least one patch, so there are more than asked for where components are more.

        Raises
        ------
        ParameterError : n_patches is not a whole number in 1 … n_faces.
        """
        ...


def over_segment(
    mesh: TriMesh, method: PatchMethod, shape_diameters: Float[np.ndarray, " m"] | None = None
) -> OverSegmentation:
    """Prepares a mesh. Deterministic.

    Parameters
    ----------
    mesh : any mesh.
    method : "random_walks" (boundaries on creases and where thickness changes) or "k_means" (compact patches).
    shape_diameters : (m,), for random walks where they are at hand; computed where left out. k-means ignores them.

    Raises
    ------
    ParameterError : an unknown method, or shape diameters that do not fit the mesh.
    """
    if method == "random_walks":
        return RandomWalkPatches(mesh, shape_diameters)
    if method == "k_means":
        return KMeansPatches(mesh)
    raise ParameterError(f"method must be one of {', '.join(get_args(PatchMethod))} but is {method!r}; correct it")
