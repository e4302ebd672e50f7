"""What both methods of over-segmentation promise, on any mesh."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from partwise.errors import ParameterError
from partwise.geometry.adjacency import edge_adjacency, edge_components
from partwise.mesh import TriMesh
from partwise.segmentation.patches import over_segment
from partwise.testing.meshes import meshes, subdivided

METHODS = ("random_walks", "k_means")
TETRAHEDRON = TriMesh(np.vstack([np.zeros(3), np.eye(3)]), np.array([[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]]))


def n_connected_pieces(mesh, labels):
    """Pieces of equal label, counted by spreading from face to face."""
    neighbours = [[] for _ in range(mesh.n_faces)]
    for a, b in edge_adjacency(mesh).faces.tolist():
        if labels[a] == labels[b]:
            neighbours[a].append(b)
            neighbours[b].append(a)
    seen, n = np.zeros(mesh.n_faces, dtype=bool), 0
    for start in range(mesh.n_faces):
        if seen[start]:
            continue
        n += 1
        seen[start], frontier = True, [start]
        while frontier:
            for other in neighbours[frontier.pop()]:
                if not seen[other]:
                    seen[other] = True
                    frontier.append(other)
    return n


@pytest.fixture(scope="module")
def potato():
    """1024 faces, without any symmetry that would leave ties to rounding."""
    mesh = TETRAHEDRON
    for _ in range(4):
        mesh = subdivided(mesh)
    points = mesh.vertices - TETRAHEDRON.vertices.mean(axis=0)
    bumps = 1 + 0.1 * np.random.default_rng(0).standard_normal((mesh.n_vertices, 1))
    return TriMesh(bumps * points / np.linalg.norm(points, axis=1, keepdims=True) * [1, 1.7, 2.9], mesh.faces)


@pytest.mark.parametrize("method", METHODS)
@given(mesh=meshes(), data=st.data())
@settings(max_examples=25, deadline=None)
def test_patches_cover_and_are_connected_and_as_many_as_asked(method, mesh, data):
    n = data.draw(st.integers(1, mesh.n_faces))
    n_components = int(edge_components(mesh).max()) + 1
    labels = over_segment(mesh, method, np.zeros(mesh.n_faces)).patches(n)
    assert labels.dtype == np.int64
    expected = max(n, n_components)
    np.testing.assert_array_equal(np.unique(labels), np.arange(expected))
    assert n_connected_pieces(mesh, labels) == expected


@pytest.mark.parametrize("method", METHODS)
def test_the_same_mesh_gives_the_same_patches(method, potato):
    first, second = (over_segment(potato, method).patches(17) for _ in range(2))
    np.testing.assert_array_equal(first, second)


@pytest.mark.parametrize("method", METHODS)
def test_asking_for_others_in_between_changes_nothing(method, potato):
    prepared = over_segment(potato, method)
    first = prepared.patches(12)
    prepared.patches(40)
    np.testing.assert_array_equal(prepared.patches(12), first)


@pytest.mark.parametrize("method", METHODS)
def test_a_patch_a_face(method, potato):
    assert len(np.unique(over_segment(potato, method).patches(potato.n_faces))) == potato.n_faces


@pytest.mark.parametrize("method", METHODS)
def test_scale_and_place_do_not_matter(method, potato):
    moved = TriMesh(potato.vertices * 1024 + np.array([4096.0, 0, -512.0]), potato.faces)
    diameters = np.zeros(potato.n_faces)
    first, second = (over_segment(mesh, method, diameters).patches(9) for mesh in (potato, moved))
    # Faces on a boundary may tip over by rounding; a handful at most.
    best = np.array([np.bincount(second[first == k]).max() for k in range(9)]).sum()
    assert best >= 0.98 * potato.n_faces


@pytest.mark.parametrize("method", METHODS)
def test_each_component_has_its_patches(method):
    pair = TriMesh(
        np.vstack([TETRAHEDRON.vertices, TETRAHEDRON.vertices + 5]),
        np.vstack([TETRAHEDRON.faces, TETRAHEDRON.faces + 4]),
    )
    prepared = over_segment(pair, method, np.zeros(8))
    assert prepared.n_components == 2
    assert prepared.n_faces == 8
    assert len(np.unique(prepared.patches(1))) == 2
    labels = prepared.patches(4)
    assert not set(labels[:4].tolist()) & set(labels[4:].tolist())


@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize("n", [0, 5])
def test_refuses_a_number_out_of_range(method, n):
    with pytest.raises(ParameterError, match=r"must be in 1 … 4, the number of faces, but is"):
        over_segment(TETRAHEDRON, method, np.zeros(4)).patches(n)


@pytest.mark.parametrize("method", METHODS)
def test_a_mesh_without_area_or_extent_still_has_patches(method):
    point = TriMesh(np.zeros((3, 3)), np.array([[0, 1, 2], [0, 2, 1]]))
    assert over_segment(point, method, np.zeros(2)).patches(2).tolist() == [0, 1]


def test_refuses_an_unknown_method():
    with pytest.raises(ParameterError, match="random_walks, k_means but is 'walks'"):
        over_segment(TETRAHEDRON, "walks")  # type: ignore[arg-type]
