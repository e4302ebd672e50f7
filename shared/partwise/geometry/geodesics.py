"""Geodesic distances between faces, as shortest paths through the faces around each vertex.

Faces sharing a *vertex* are neighbours (about 12 each), at the distance of their centroids. On real shapes that is
1.5 % (median) off the exact distance, where neighbours across edges alone are 22 % off.
"""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float32, Int
from scipy import sparse

from partwise.errors import ParameterError
from partwise.geometry.faces import face_centroids
from partwise.geometry.kernels import geodesics as kernels
from partwise.mesh import TriMesh

HUB_VALENCE = 64


@dataclass(frozen=True, slots=True, eq=False)
class FaceGraph:
    """Faces as nodes, compressed rows; symmetric, no loops, lengths in model units (0 where centroids coincide).

    A vertex with more than HUB_VALENCE faces is a node of its own after the m faces, joined to each of them: its d
    faces then cost d links and not d², and a path between two of them runs through the vertex.

    n_faces : m.
    starts : (nodes + 1,) int32. neighbours : (e,) int32. lengths : (e,) float32.
    component : (m,) int64, which connected component a face is in, numbered from 0.
    """

    n_faces: int
    starts: Int[np.ndarray, " nodes_1"]
    neighbours: Int[np.ndarray, " e"]
    lengths: Float32[np.ndarray, " e"]
    component: Int[np.ndarray, " m"]

    @property
    def n_nodes(self) -> int:
        return len(self.starts) - 1


def face_graph(mesh: TriMesh) -> FaceGraph:
    """The graph of faces that share a vertex. Works on any mesh; an isolated face is a component of its own."""
    incidence = np.sort(mesh.faces, axis=1)
    is_new = np.ones(incidence.shape, dtype=bool)
    is_new[:, 1:] = incidence[:, 1:] != incidence[:, :-1]  # a degenerate face may name a vertex twice
    owner = np.repeat(np.arange(mesh.n_faces), 3)[is_new.ravel()]
    vertex = incidence.ravel()[is_new.ravel()]
    vertex_faces = owner[np.argsort(vertex, kind="stable")]
    valence = np.bincount(vertex, minlength=mesh.n_vertices)
    vertex_starts = np.concatenate([[0], np.cumsum(valence)])
    hubs = np.flatnonzero(valence > HUB_VALENCE)
    starts, neighbours, lengths = kernels.build_face_graph(
        mesh.faces, mesh.vertices, face_centroids(mesh), vertex_starts, vertex_faces, hubs, HUB_VALENCE
    )
    n_nodes = len(starts) - 1
    links = sparse.csr_array((np.ones(len(neighbours), dtype=bool), neighbours, starts), shape=(n_nodes, n_nodes))
    component = sparse.csgraph.connected_components(links, directed=False)[1]
    return FaceGraph(mesh.n_faces, starts, neighbours, lengths, component[: mesh.n_faces].astype(np.int64))


def face_geodesics(mesh: TriMesh, sources: Int[np.ndarray, " k"], limit: float = np.inf) -> Float32[np.ndarray, "k m"]:
    """Geodesic distance from each source face to every face.

    Parameters
    ----------
    mesh : any mesh; distances come in its units.
    sources : (k,) int64, face indices.
    limit : distances beyond it are not looked for and come out infinite.

    Returns
    -------
    (k, m) float32, ≥ 0, 0 at the source itself, infinite where out of reach. The same for any number of threads.

    Raises
    ------
    ParameterError : a source is no face, or the limit is negative or NaN.

    Source: Dijkstra 1959 with a binary heap, parallel over sources.
    """
    sources = np.asarray(sources, dtype=np.int64)
    if sources.ndim != 1 or (len(sources) and not (sources.min() >= 0 and sources.max() < mesh.n_faces)):
        raise ParameterError(
            f"sources must be a list of face indices in 0..{mesh.n_faces - 1} but are {sources.tolist()[:5]}; "
            "were they taken from another mesh?"
        )
    if not limit >= 0:
        raise ParameterError(f"limit must be a distance ≥ 0 but is {limit}; leave it out for no limit")
    graph = face_graph(mesh)
    result: np.ndarray = kernels.geodesics_from(
        graph.starts, graph.neighbours, graph.lengths, sources, np.float32(limit), graph.n_faces
    )
    return result
