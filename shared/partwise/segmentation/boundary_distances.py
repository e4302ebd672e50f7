"""How far every face lies from the boundary of each label, along the surface.

Shortest paths through faces that share a vertex, from the midpoints of boundary edges. scipy's Dijkstra suffices: it
visits only what lies within the limit, and nothing needs to be compiled where annotators are served.
"""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Bool, Float, Int
from scipy import sparse

from partwise.geometry.adjacency import EdgeAdjacency, vertex_neighbours
from partwise.geometry.faces import face_centroids
from partwise.mesh import TriMesh


@dataclass(frozen=True, slots=True, eq=False)
class SurfaceGraph:
    """What of a mesh distances need, made once.

    links : (m, m) csr, distance of the centroids of faces that share a vertex, model units.
    pairs : (k, 2) int64, faces across each edge.
    to_edge : (k, 2) float64, distance of each of the two centroids from the edge's midpoint.
    """

    links: sparse.csr_array
    pairs: Int[np.ndarray, "k 2"]
    to_edge: Float[np.ndarray, "k 2"]

    @classmethod
    def build(cls, mesh: TriMesh, adjacency: EdgeAdjacency) -> "SurfaceGraph":
        """Works on any mesh; faces that touch nothing are out of reach of all others."""
        neighbours, C = vertex_neighbours(mesh), face_centroids(mesh)
        rows = np.repeat(np.arange(mesh.n_faces), np.diff(neighbours.indptr))
        lengths = np.linalg.norm(C[rows] - C[neighbours.indices], axis=1)
        # Zero would read as "no link" in some of scipy's conversions.
        lengths = np.maximum(lengths, np.finfo(np.float64).tiny)
        links = sparse.csr_array((lengths, neighbours.indices, neighbours.indptr), shape=neighbours.shape)
        midpoints = mesh.vertices[adjacency.edges].mean(axis=1)
        to_edge = np.linalg.norm(C[adjacency.faces] - midpoints[:, None], axis=2)
        return cls(links, adjacency.faces, to_edge)

    def from_edges(self, chosen: Bool[np.ndarray, " k"], limit: float = np.inf) -> Float[np.ndarray, " m"]:
        """Distance of each face's centroid from the nearest chosen edge's midpoint, infinite beyond the limit."""
        return self._from_faces(self.pairs[chosen].ravel(), self.to_edge[chosen].ravel(), limit)

    def from_faces(self, chosen: Bool[np.ndarray, " m"], limit: float = np.inf) -> Float[np.ndarray, " m"]:
        """Distance of each face from the nearest chosen face, centroid to centroid."""
        faces = np.flatnonzero(chosen)
        return self._from_faces(faces, np.zeros(len(faces)), limit)

    def _from_faces(self, faces: np.ndarray, offsets: np.ndarray, limit: float) -> Float[np.ndarray, " m"]:
        """Least offset + path. A node of its own leads to the faces, so that all sources are one."""
        m = self.links.shape[0]
        if not len(faces):
            return np.full(m, np.inf)
        data = np.concatenate([self.links.data, np.maximum(offsets, np.finfo(np.float64).tiny)])
        indices = np.concatenate([self.links.indices, faces.astype(self.links.indices.dtype)])
        starts = np.append(self.links.indptr, len(indices)).astype(self.links.indptr.dtype)
        graph = sparse.csr_array((data, indices, starts), shape=(m + 1, m + 1))
        distance = sparse.csgraph.dijkstra(graph, indices=m, limit=limit)  # type: ignore[call-overload] # stubs know no index
        return np.asarray(distance[:m], dtype=np.float64)


def boundary_distances(
    graph: SurfaceGraph, classes: Int[np.ndarray, " m"], n_classes: int, limit: float = np.inf
) -> Float[np.ndarray, "m L"]:
    """Distance of each face from the boundary of each class, (m, L) float64, model units, infinite beyond `limit`.

    A class's boundary are the edges that have it on exactly one side; −1 is no class but bounds others.
    """
    first, second = classes[graph.pairs[:, 0]], classes[graph.pairs[:, 1]]
    columns = [graph.from_edges((first == l) != (second == l), limit) for l in range(n_classes)]
    return np.stack(columns, axis=1)
