"""Hypothesis strategies for small triangle meshes: closed ones, open ones, and soups with every defect."""

import numpy as np
from hypothesis import strategies as st

from partwise.mesh import TriMesh

_TETRAHEDRON = (
    np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]], dtype=np.float64),
    np.array([[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]], dtype=np.int64),
)
_OCTAHEDRON = (
    np.array([[1, 0, 0], [-1, 0, 0], [0, 1, 0], [0, -1, 0], [0, 0, 1], [0, 0, -1]], dtype=np.float64),
    np.array([[0, 2, 4], [2, 1, 4], [1, 3, 4], [3, 0, 4], [2, 0, 5], [1, 2, 5], [3, 1, 5], [0, 3, 5]], dtype=np.int64),
)


def subdivided(mesh: TriMesh) -> TriMesh:
    """Each face split in four at its edges' midpoints; faces 4 i to 4 i + 3 replace face i."""
    vertices = list(mesh.vertices)
    midpoints: dict[tuple[int, int], int] = {}

    def midpoint(a: int, b: int) -> int:
        key = (min(a, b), max(a, b))
        if key not in midpoints:
            midpoints[key] = len(vertices)
            vertices.append((mesh.vertices[a] + mesh.vertices[b]) / 2)
        return midpoints[key]

    faces = []
    for a, b, c in mesh.faces.tolist():
        ab, bc, ca = midpoint(a, b), midpoint(b, c), midpoint(c, a)
        faces += [[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]]
    return TriMesh(np.array(vertices), np.array(faces))


@st.composite
def closed_meshes(draw: st.DrawFn, max_subdivisions: int = 2) -> TriMesh:
    """Closed, oriented manifolds of genus 0: a tetrahedron or an octahedron, subdivided, stretched, moved, dented."""
    vertices, faces = draw(st.sampled_from((_TETRAHEDRON, _OCTAHEDRON)))
    mesh = TriMesh(vertices, faces)
    for _ in range(draw(st.integers(0, max_subdivisions))):
        mesh = subdivided(mesh)
    rng = np.random.default_rng(draw(st.integers(0, 2**32 - 1)))
    scale = 10.0 ** rng.uniform(-2, 2, size=3).clip(-2, 2) if draw(st.booleans()) else np.ones(3)
    dents = 1 + 0.05 * rng.standard_normal((mesh.n_vertices, 1))  # too small to turn a face over
    shift = rng.uniform(-10, 10, size=3) if draw(st.booleans()) else np.zeros(3)
    return TriMesh(mesh.vertices * dents * scale + shift, mesh.faces)


@st.composite
def open_meshes(draw: st.DrawFn, max_subdivisions: int = 2) -> TriMesh:
    """A closed mesh with some faces cut out, at least one left; vertices that no face uses stay."""
    mesh = draw(closed_meshes(max_subdivisions))
    kept = draw(st.lists(st.booleans(), min_size=mesh.n_faces, max_size=mesh.n_faces).filter(any))
    return TriMesh(mesh.vertices, mesh.faces[np.array(kept)])


@st.composite
def soups(draw: st.DrawFn, max_vertices: int = 12, max_faces: int = 24) -> TriMesh:
    """Any valid mesh: faces may be degenerate, repeated, non-manifold, unoriented, in several components."""
    n_vertices = draw(st.integers(1, max_vertices))
    n_faces = draw(st.integers(1, max_faces))
    coordinate = st.floats(-1e3, 1e3, width=32)
    row = st.tuples(coordinate, coordinate, coordinate)
    corner = st.integers(0, n_vertices - 1)
    vertices = draw(st.lists(row, min_size=n_vertices, max_size=n_vertices))
    faces = draw(st.lists(st.tuples(corner, corner, corner), min_size=n_faces, max_size=n_faces))
    return TriMesh(np.array(vertices), np.array(faces))


def meshes() -> st.SearchStrategy[TriMesh]:
    """Closed meshes, open meshes and soups."""
    return st.one_of(closed_meshes(), open_meshes(), soups())
