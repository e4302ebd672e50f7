"""`TriMesh`: a triangle mesh, validated once and trusted afterwards.

Face order is identity: labels are arrays over faces, so nothing in Partwise ever reorders them.
"""

import hashlib
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float, Int

from partwise.errors import MeshError


@dataclass(frozen=True, slots=True, eq=False)
class TriMesh:
    """Vertices (n, 3) float64 in model units and faces (m, 3) int64, counter-clockwise from outside.

    The arrays are converted, checked and made read-only. Degenerate, duplicate and non-manifold faces are allowed: see
    `partwise.geometry.manifold` for what a mesh is like.

    Raises
    ------
    MeshError : wrong array shape, no vertices or faces, NaN or infinity, an index outside the vertices.
    """

    vertices: Float[np.ndarray, "n 3"]
    faces: Int[np.ndarray, "m 3"]

    def __post_init__(self) -> None:
        vertices = _frozen_copy(self.vertices, np.float64)
        faces = _frozen_copy(self.faces, np.int64)
        if vertices.ndim != 2 or vertices.shape[1] != 3 or len(vertices) == 0:
            raise MeshError(f"vertices must be a non-empty (n, 3) array but are {vertices.shape}; is the file empty?")
        if faces.ndim != 2 or faces.shape[1] != 3 or len(faces) == 0:
            raise MeshError(
                f"faces must be a non-empty (m, 3) array but have shape {faces.shape}; "
                "a point cloud must be meshed first and polygons must be triangulated"
            )
        finite = np.isfinite(vertices).all(axis=1)
        if not finite.all():
            row = int(np.argmin(finite))
            raise MeshError(f"vertices must be finite but row {row} is {vertices[row].tolist()}; repair or drop it")
        low, high = int(faces.min()), int(faces.max())
        if low < 0 or high >= len(vertices):
            bad = low if low < 0 else high
            raise MeshError(f"faces contain index {bad} but there are {len(vertices)} vertices; were vertices dropped?")
        object.__setattr__(self, "vertices", vertices)
        object.__setattr__(self, "faces", faces)

    @property
    def n_vertices(self) -> int:
        return len(self.vertices)

    @property
    def n_faces(self) -> int:
        return len(self.faces)

    def content_hash(self) -> str:
        """SHA-256 (hex) of the vertices as little-endian float32 and the faces as uint32: the mesh's identity.

        float32 because that is what is stored and served, so a mesh keeps its hash through the array store.
        """
        digest = hashlib.sha256(b"partwise.TriMesh.v1")
        digest.update(np.array([self.n_vertices, self.n_faces], dtype="<u8").tobytes())
        digest.update((self.vertices.astype("<f4") + np.float32(0)).tobytes())  # + 0 turns −0.0 into 0.0
        digest.update(self.faces.astype("<u4").tobytes())
        return digest.hexdigest()


def _frozen_copy(values: np.ndarray, dtype: type) -> np.ndarray:
    try:
        array: np.ndarray = np.array(values, dtype=dtype, order="C")
    except (TypeError, ValueError) as error:
        raise MeshError(f"mesh arrays must be numeric but numpy says: {error}; check the file's contents") from error
    array = array.view(dtype)  # numpy keeps a C long long as such, which is the same but prints as another type
    array.flags.writeable = False
    return array
