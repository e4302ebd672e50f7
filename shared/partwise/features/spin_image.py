"""Spin image of every face: the vertices around its normal, by distance from the axis and height along it."""

import numpy as np
from jaxtyping import Float32

from partwise.features.kernels.spin_image import spin_images
from partwise.features.parameters import SpinImageParameters
from partwise.geometry.faces import face_centroids, face_normals
from partwise.geometry.vertices import vertex_areas, vertex_normals
from partwise.mesh import TriMesh


def spin_image(mesh: TriMesh, parameters: SpinImageParameters | None = None) -> Float32[np.ndarray, "m d"]:
    """Spin image of every face.

    Origin and axis are the face's centroid and normal. Every vertex whose normal does not oppose the face's
    (n_v·n_i ≥ 0) and whose distance α from the axis is below the support adds its share of the area, spread over the
    bins around it by exp(−d²/0.2), d in bins to their centres; weights below 0.02 are cut and the rest add up to 1.
    Heights β beyond ± support / 2 count as lying there.

    Parameters
    ----------
    mesh : in normalised units, see `partwise.geometry.normalise`.

    Returns
    -------
    (m, n_bins²) float32, row-major: reshape to (m, β, α) with β from −support / 2 to support / 2 and α from 0 to
    support. A face's values add up to the share of the area that it sees. Invariant to rotation, the same for any
    number of threads. A degenerate face has no axis: all vertices lie at height 0 by their plain distance.

    Source: Johnson & Hebert 1999, with the soft bins of George et al. 2018.
    """
    parameters = parameters or SpinImageParameters()
    areas = vertex_areas(mesh)
    used = areas > 0
    result: np.ndarray = spin_images(
        face_centroids(mesh).astype(np.float32),
        face_normals(mesh).astype(np.float32),
        np.ascontiguousarray(mesh.vertices[used].T, dtype=np.float32),
        np.ascontiguousarray(vertex_normals(mesh)[used].T, dtype=np.float32),
        (areas[used] / max(areas.sum(), np.finfo(np.float64).tiny)).astype(np.float32),
        parameters.support,
        parameters.n_bins,
    )
    return result
