"""Shrink-wraps any polygon soup: watertight and manifold whatever comes in (CGAL's alpha wrap, through pymeshlab)."""

import logging

import numpy as np
import pymeshlab
from jaxtyping import Float

from partwise.errors import DegenerateMeshError
from partwise.geometry.faces import bounding_box_diagonal, face_areas
from partwise.mesh import TriMesh
from partwise.remesh.parameters import AlphaWrap

_log = logging.getLogger(__name__)

_PROBE = AlphaWrap(2.0, 0.3)  # a tenth of a second to one: coarse, yet its area is that of a fine wrap within a third
# Faces of a wrap are close to n = 1.5 · area / alpha² (measured on a dozen soups: 1.35 to 1.8).
_FACES_PER_ALPHA_SQUARE = 1.5


def alpha_wrap(mesh: TriMesh, parameters: AlphaWrap) -> TriMesh:
    """The wrap: closed, manifold, oriented outwards; perhaps several components. Natively heavy: it may hang or crash.

    Raises
    ------
    DegenerateMeshError : the mesh has no area or extent, or nothing is left of it.

    Source: Portaneri, Rouxel-Labbé, Hemmer, Cohen-Steiner, Alliez 2022.
    """
    corners = _distinct_triangles(mesh).reshape(-1, 3)
    # Each triangle on corners of its own: pymeshlab hands CGAL a half-edge mesh and leaves out, without a word, faces
    # that would make it non-manifold or misoriented. The wrap would then run in through the holes.
    loose = np.arange(len(corners)).reshape(-1, 3)
    meshes = pymeshlab.MeshSet(verbose=False)
    meshes.add_mesh(pymeshlab.Mesh(corners, loose))
    meshes.generate_alpha_wrap(
        alpha=pymeshlab.PercentageValue(parameters.alpha_percent),
        offset=pymeshlab.PercentageValue(parameters.offset_percent),
    )
    wrapped = meshes.current_mesh()
    if wrapped.face_number() == 0:
        raise DegenerateMeshError(f"wrapping with {parameters} left no faces; try a coarser alpha")
    return TriMesh(wrapped.vertex_matrix(), wrapped.face_matrix().astype(np.int64))


def _distinct_triangles(mesh: TriMesh) -> Float[np.ndarray, "t 3 3"]:
    """Corners of the faces that have area, those of several faces in one place once: doubles cost time only."""
    has_area = face_areas(mesh) > 0
    if not has_area.any():
        raise DegenerateMeshError("a mesh must have area to be wrapped but has none; check the export's scale")
    place = np.unique(mesh.vertices, axis=0, return_inverse=True)[1].ravel()
    faces = mesh.faces[has_area]
    first = np.unique(np.sort(place[faces], axis=1), axis=0, return_index=True)[1]
    return mesh.vertices[faces[np.sort(first)]]


def fitted_wrap(mesh: TriMesh, parameters: AlphaWrap, n_faces: int) -> AlphaWrap:
    """The wrap's parameters, with alpha raised where the wrap would otherwise have more than about `n_faces` faces.

    Time grows with the faces, so a wrap that is finer than the levels need is time lost. Makes a coarse wrap to see.

    Raises
    ------
    DegenerateMeshError : as for `alpha_wrap`.
    """
    if parameters.alpha_percent >= _PROBE.alpha_percent:
        return parameters
    probe = alpha_wrap(mesh, _PROBE)
    area = float(face_areas(probe).sum()) / bounding_box_diagonal(mesh) ** 2
    alpha_percent = 100.0 * float(np.sqrt(_FACES_PER_ALPHA_SQUARE * area / n_faces))
    _log.debug("alpha for %d faces is %.3g %%", n_faces, alpha_percent, extra={"relative_area": area})
    fitted = min(max(parameters.alpha_percent, alpha_percent), _PROBE.alpha_percent)
    return AlphaWrap(round(fitted, 4), parameters.offset_percent)
