"""Which faces touch: across edges (pairs), or through any shared vertex (sparse graph)."""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float, Int, Integer
from scipy import sparse

from partwise.mesh import TriMesh


@dataclass(frozen=True, slots=True, eq=False)
class EdgeAdjacency:
    """Pairs of faces that share an edge; each unordered pair and edge once, in a fixed order.

    faces : (k, 2) int64, faces[:, 0] < faces[:, 1].
    edges : (k, 2) int64, the shared edge's vertices, ascending.
    lengths : (k,) float64, the edge's length in model units.
    """

    faces: Int[np.ndarray, "k 2"]
    edges: Int[np.ndarray, "k 2"]
    lengths: Float[np.ndarray, " k"]


def edge_adjacency(mesh: TriMesh) -> EdgeAdjacency:
    """Face pairs across each edge. An edge of q > 2 faces pairs those consecutive by index, q−1 in all."""
    corners = mesh.faces[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2)
    edges = np.sort(corners, axis=1)
    owner = np.repeat(np.arange(mesh.n_faces), 3)
    order = np.lexsort((owner, edges[:, 1], edges[:, 0]))
    edges, owner = edges[order], owner[order]
    # A degenerate face can hold one edge twice: a face is no neighbour of itself.
    same = (edges[1:] == edges[:-1]).all(axis=1) & (owner[1:] != owner[:-1]) & (edges[1:, 0] != edges[1:, 1])
    pairs = np.stack([owner[:-1][same], owner[1:][same]], axis=1)
    shared = edges[1:][same]
    lengths = np.linalg.norm(mesh.vertices[shared[:, 0]] - mesh.vertices[shared[:, 1]], axis=1)
    return EdgeAdjacency(pairs, shared, lengths)


def vertex_neighbours(mesh: TriMesh) -> sparse.csr_array:
    """Faces that share at least one vertex: (m, m) csr of bool, symmetric, empty diagonal (about 12 a row)."""
    m = mesh.n_faces
    incidence = sparse.csr_array(
        (np.ones(3 * m, dtype=np.int32), (np.repeat(np.arange(m), 3), mesh.faces.ravel())), shape=(m, mesh.n_vertices)
    )
    graph = sparse.csr_array(incidence @ incidence.T)
    coo = graph.tocoo()
    keep = coo.row != coo.col
    result = sparse.csr_array((np.ones(int(keep.sum()), dtype=bool), (coo.row[keep], coo.col[keep])), shape=(m, m))
    result.sort_indices()
    return result


def edge_components(mesh: TriMesh) -> Int[np.ndarray, " m"]:
    """Connected component of each face across edges, (m,) int64, numbered from 0 in order of first face."""
    return label_regions(np.zeros(mesh.n_faces, dtype=np.int64), edge_adjacency(mesh).faces)


def label_regions(labels: Integer[np.ndarray, " m"], pairs: Int[np.ndarray, "k 2"]) -> Int[np.ndarray, " m"]:
    """Connected region of equal label of each face, (m,) int64, numbered from 0 in order of first face.

    pairs : (k, 2), the faces that touch.
    """
    joined = pairs[labels[pairs[:, 0]] == labels[pairs[:, 1]]]
    graph = sparse.coo_array((np.ones(len(joined), dtype=bool), (joined[:, 0], joined[:, 1])), shape=(len(labels),) * 2)
    return np.asarray(sparse.csgraph.connected_components(graph, directed=False)[1], dtype=np.int64)
