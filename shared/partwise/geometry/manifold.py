"""What a mesh is like: closed, manifold, oriented, in one piece."""

from dataclasses import dataclass

import numpy as np
from scipy import sparse

from partwise.geometry.adjacency import edge_components
from partwise.geometry.faces import face_areas
from partwise.mesh import TriMesh


@dataclass(frozen=True, slots=True)
class ManifoldReport:
    """Counts of what keeps a mesh from being a closed oriented manifold in one piece (all 0, components 1)."""

    n_components: int
    n_boundary_edges: int
    n_nonmanifold_edges: int
    n_nonmanifold_vertices: int
    n_misoriented_edges: int
    n_degenerate_faces: int
    n_duplicate_faces: int

    @property
    def is_closed(self) -> bool:
        return self.n_boundary_edges == 0

    @property
    def is_manifold(self) -> bool:
        return self.n_nonmanifold_edges == 0 and self.n_nonmanifold_vertices == 0

    @property
    def is_clean(self) -> bool:
        """Closed, edge- and vertex-manifold, oriented, one component, no degenerate or duplicate face."""
        return (
            self.is_closed
            and self.is_manifold
            and self.n_misoriented_edges == 0
            and self.n_components == 1
            and self.n_degenerate_faces == 0
            and self.n_duplicate_faces == 0
        )


def manifold_report(mesh: TriMesh) -> ManifoldReport:
    """Examines connectivity by shared vertex indices (not positions). Components are counted across edges."""
    half_edges = mesh.faces[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2)
    half_edges = half_edges[half_edges[:, 0] != half_edges[:, 1]]  # a degenerate face's loop at a vertex is no edge
    edges, edge_of, uses = np.unique(np.sort(half_edges, axis=1), axis=0, return_inverse=True, return_counts=True)
    forward = np.zeros(len(edges), dtype=np.int64)
    np.add.at(forward, edge_of.ravel(), half_edges[:, 0] < half_edges[:, 1])
    duplicates = mesh.n_faces - len(np.unique(np.sort(mesh.faces, axis=1), axis=0))
    return ManifoldReport(
        n_components=int(edge_components(mesh).max()) + 1,
        n_boundary_edges=int((uses == 1).sum()),
        n_nonmanifold_edges=int((uses > 2).sum()),
        n_nonmanifold_vertices=_n_nonmanifold_vertices(mesh),
        n_misoriented_edges=int(((uses == 2) & (forward != 1)).sum()),
        n_degenerate_faces=int((face_areas(mesh) <= 0).sum()),
        n_duplicate_faces=duplicates,
    )


def _n_nonmanifold_vertices(mesh: TriMesh) -> int:
    """Vertices whose faces form more than one fan: their corners, joined across edges, fall into several groups."""
    m = mesh.n_faces
    corner = np.arange(3 * m).reshape(m, 3)
    # Per face edge (k, k+1): its two corners, keyed by the edge, so that the corners of faces across it can be joined.
    start, end = mesh.faces.ravel(), np.roll(mesh.faces, -1, axis=1).ravel()
    start_corner, end_corner = corner.ravel(), np.roll(corner, -1, axis=1).ravel()
    swap = start > end
    low = np.where(swap, end, start)
    high = np.where(swap, start, end)
    low_corner = np.where(swap, end_corner, start_corner)
    high_corner = np.where(swap, start_corner, end_corner)
    order = np.lexsort((high, low))
    same = (low[order][1:] == low[order][:-1]) & (high[order][1:] == high[order][:-1])
    joined = [(c[order][:-1][same], c[order][1:][same]) for c in (low_corner, high_corner)]
    rows = np.concatenate([a for a, _ in joined])
    columns = np.concatenate([b for _, b in joined])
    graph = sparse.coo_array((np.ones(len(rows), dtype=bool), (rows, columns)), shape=(3 * m, 3 * m))
    fan = sparse.csgraph.connected_components(graph, directed=False)[1]
    fans_of_vertex = np.unique(np.stack([mesh.faces.ravel(), fan], axis=1), axis=0)[:, 0]
    return int((np.bincount(fans_of_vertex, minlength=mesh.n_vertices) > 1).sum())
