"""Shrink-wraps any polygon soup: watertight and manifold whatever comes in (CGAL's alpha wrap, through pymeshlab)."""

import logging

import numpy as np
import pymeshlab

from partwise.errors import DegenerateMeshError
from partwise.geometry.faces import bounding_box_diagonal, face_areas
from partwise.geometry.submesh import keep_faces
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
    has_area = face_areas(mesh) > 0
    if not has_area.any():
        raise DegenerateMeshError("a mesh must have area to be wrapped but has none; check the export's scale")
    solid = keep_faces(mesh, has_area)
    meshes = pymeshlab.MeshSet(verbose=False)
    meshes.add_mesh(pymeshlab.Mesh(solid.vertices, solid.faces))
    meshes.generate_alpha_wrap(
        alpha=pymeshlab.PercentageValue(parameters.alpha_percent),
        offset=pymeshlab.PercentageValue(parameters.offset_percent),
    )
    wrapped = meshes.current_mesh()
    if wrapped.face_number() == 0:
        raise DegenerateMeshError(f"wrapping with {parameters} left no faces; try a coarser alpha")
    return TriMesh(wrapped.vertex_matrix(), wrapped.face_matrix().astype(np.int64))


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
