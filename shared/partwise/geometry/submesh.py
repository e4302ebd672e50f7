"""Part of a mesh as a mesh of its own."""

import numpy as np
from jaxtyping import Bool

from partwise.mesh import TriMesh


def keep_faces(mesh: TriMesh, keep: Bool[np.ndarray, " m"]) -> TriMesh:
    """The faces where `keep` is true, in their order, and the vertices they use.

    Raises
    ------
    MeshError : no face is kept.
    """
    used, faces = np.unique(mesh.faces[keep], return_inverse=True)
    return TriMesh(mesh.vertices[used], faces.reshape(-1, 3))
