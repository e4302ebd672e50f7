"""Over-segmentation by random walks: a patch is where walks end in the same place, behind the same thickness."""

import numpy as np
from jaxtyping import Float, Int

from partwise.geometry.adjacency import edge_adjacency
from partwise.geometry.faces import bounding_box_diagonal, face_areas, face_centroids
from partwise.mesh import TriMesh
from partwise.segmentation.crease_walk import walk_means
from partwise.segmentation.given_diameters import checked_diameters
from partwise.segmentation.patch_parameters import RandomWalkParameters
from partwise.segmentation.patch_tree import PatchTree, patch_tree

_DEFAULTS = RandomWalkParameters()


class RandomWalkPatches:
    """Patches of one mesh for any number of them: all the work is done once, a number is then a cut of a tree.

    Each face is described by what a random walk from it expects to find where it ends: a position, as a share of the
    diagonal, and a shape diameter. Neighbours merge by Ward's criterion on these, weighted by area.

    Parameters
    ----------
    mesh : any mesh.
    shape_diameters : (m,) finite, as `partwise.features.shape_diameter` gives them; computed where left out, which
        needs the ray caster and takes longer than all the rest.

    Raises
    ------
    ParameterError : not one finite shape diameter a face.

    Source: Lai et al. 2008/2009 for the walks; Ward 1963. Differs: no seeds. Lai labels a face by the seed its walk
    meets first, so that everything hangs on where seeds are; here walks are compared by where they end, as Pons &
    Latapy 2005 do on networks.
    """

    __slots__ = ("_tree",)

    def __init__(
        self,
        mesh: TriMesh,
        shape_diameters: Float[np.ndarray, " m"] | None = None,
        parameters: RandomWalkParameters = _DEFAULTS,
    ) -> None:
        diameters = _computed(mesh) if shape_diameters is None else checked_diameters(mesh, shape_diameters)
        adjacency = edge_adjacency(mesh)
        centroids = face_centroids(mesh)
        position = (centroids - centroids.mean(axis=0)) / (bounding_box_diagonal(mesh) or 1.0)
        values = np.column_stack([position, parameters.thickness_weight * diameters])
        means = walk_means(mesh, adjacency, values, parameters)
        self._tree: PatchTree = patch_tree(adjacency.faces, face_areas(mesh), means)

    @property
    def n_faces(self) -> int:
        return self._tree.n_leaves

    @property
    def n_components(self) -> int:
        return self._tree.n_components

    def patches(self, n_patches: int) -> Int[np.ndarray, " m"]:
        """Patch of each face, (m,) int64 in 0 … max(n_patches, n_components) − 1.

        Every patch is connected across edges; a component has at least one. Patches for a greater number lie within
        those for a smaller one, and one more leaves all but one patch, with their numbers, as they were.

        Raises
        ------
        ParameterError : n_patches is not in 1 … n_faces.
        """
        return self._tree.cut(n_patches)


def _computed(mesh: TriMesh) -> np.ndarray:
    # Loaded here because whoever has stored shape diameters may run where there is no ray caster.
    from partwise.features.shape_diameter import shape_diameter

    return shape_diameter(mesh).astype(np.float64)
