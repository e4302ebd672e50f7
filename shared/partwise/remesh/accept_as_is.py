"""Whether a mesh needs no remeshing: its labels then live on the file's own faces."""

import numpy as np

from partwise.geometry.manifold import ManifoldReport, manifold_report
from partwise.mesh import TriMesh


def why_not_as_is(mesh: TriMesh, max_faces: int) -> str | None:
    """What keeps the mesh from being used as it is, in words; None where nothing does.

    It must be closed, edge- and vertex-manifold, consistently oriented with its volume inside, in one component,
    without degenerate or duplicate faces, and have at most `max_faces` faces.
    """
    defects = defects_of(mesh)
    if defects is not None:
        return defects
    if mesh.n_faces > max_faces:
        return f"{mesh.n_faces} faces where at most {max_faces} are used as they are"
    return None


def defects_of(mesh: TriMesh) -> str | None:
    """What keeps a mesh of any size from being a closed oriented manifold in one piece, in words, or None."""
    report = manifold_report(mesh)
    if not report.is_clean:
        return _in_words(report)
    if signed_volume(mesh) <= 0:
        return "faces look inwards"
    return None


def signed_volume(mesh: TriMesh) -> float:
    """Volume enclosed by a closed mesh, cubic model units; negative where its faces look inwards."""
    centre = mesh.vertices.mean(axis=0)
    a, b, c = (mesh.vertices[mesh.faces[:, k]] - centre for k in range(3))
    return float(np.einsum("ij,ij->", a, np.cross(b, c)) / 6.0)


def _in_words(report: ManifoldReport) -> str:
    counts = (
        (report.n_components - 1, f"{report.n_components} components"),
        (report.n_boundary_edges, f"{report.n_boundary_edges} boundary edges"),
        (report.n_nonmanifold_edges, f"{report.n_nonmanifold_edges} non-manifold edges"),
        (report.n_nonmanifold_vertices, f"{report.n_nonmanifold_vertices} non-manifold vertices"),
        (report.n_misoriented_edges, f"{report.n_misoriented_edges} misoriented edges"),
        (report.n_degenerate_faces, f"{report.n_degenerate_faces} degenerate faces"),
        (report.n_duplicate_faces, f"{report.n_duplicate_faces} duplicate faces"),
    )
    return ", ".join(words for count, words in counts if count > 0)
