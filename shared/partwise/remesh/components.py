"""The one outer component of a closed surface: cavities and enclosed pieces go, loose crumbs only if they are small."""

from dataclasses import dataclass

import igl
import numpy as np

from partwise.geometry.adjacency import edge_components
from partwise.geometry.faces import face_areas
from partwise.geometry.submesh import keep_faces
from partwise.mesh import TriMesh
from partwise.remesh.accept_as_is import signed_volume


@dataclass(frozen=True, slots=True, eq=False)
class OuterComponent:
    """The largest outer component, and what was left out.

    dropped_area : share of the area of all outer components that the others held, in [0, 1).
    n_dropped : other outer components. n_hidden : cavities, and pieces enclosed by the largest component.
    """

    mesh: TriMesh
    dropped_area: float
    n_dropped: int
    n_hidden: int


def largest_outer_component(mesh: TriMesh) -> OuterComponent:
    """Splits a closed oriented mesh. A component that looks inwards is a cavity; one inside the largest is hidden.

    What is hidden cannot be seen, so it counts for nothing: `dropped_area` is of what stands outside.
    """
    component = edge_components(mesh)
    n_components = int(component.max()) + 1
    area = np.bincount(component, weights=face_areas(mesh))
    pieces = [keep_faces(mesh, component == k) for k in range(n_components)]
    outward = np.array([signed_volume(piece) > 0 for piece in pieces])
    candidates = np.flatnonzero(outward) if outward.any() else np.arange(n_components)
    largest = int(candidates[area[candidates].argmax()])
    body = pieces[largest]
    others = [k for k in candidates.tolist() if k != largest]
    loose = [k for k in others if not _encloses(body, pieces[k])]
    lost = float(area[loose].sum())
    return OuterComponent(body, lost / (lost + float(area[largest])), len(loose), n_components - 1 - len(loose))


def _encloses(body: TriMesh, piece: TriMesh) -> bool:
    """Whether a piece that does not cross the body lies inside it."""
    winding = igl.fast_winding_number(body.vertices, body.faces, np.ascontiguousarray(piece.vertices[:1]))
    return bool(abs(float(np.asarray(winding).ravel()[0])) > 0.5)
