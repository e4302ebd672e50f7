import numpy as np
from hypothesis import given, settings

from partwise.geometry.adjacency import edge_adjacency, edge_components, label_regions, vertex_neighbours
from partwise.mesh import TriMesh
from partwise.testing.meshes import closed_meshes, meshes

POINTS = np.array([[0.0, 0, 0], [2, 0, 0], [0, 2, 0], [2, 2, 0], [5, 5, 5], [6, 6, 5]])


def test_a_shared_edge_pairs_its_faces_once() -> None:
    adjacency = edge_adjacency(TriMesh(POINTS, np.array([[0, 1, 2], [2, 1, 3]])))
    assert adjacency.faces.tolist() == [[0, 1]]
    assert adjacency.edges.tolist() == [[1, 2]]
    np.testing.assert_allclose(adjacency.lengths, [np.sqrt(8)])


def test_an_edge_of_three_faces_makes_two_pairs() -> None:
    faces = np.array([[0, 1, 2], [0, 1, 3], [1, 0, 4]])
    assert edge_adjacency(TriMesh(POINTS, faces)).faces.tolist() == [[0, 1], [1, 2]]


def test_a_face_that_holds_an_edge_twice_is_no_neighbour_of_itself() -> None:
    faces = np.array([[0, 1, 0], [0, 1, 2]])
    assert edge_adjacency(TriMesh(POINTS, faces)).faces.tolist() == [[0, 1]]


def test_a_loop_at_a_vertex_joins_nothing() -> None:
    faces = np.array([[0, 0, 1], [0, 0, 2]])
    assert len(edge_adjacency(TriMesh(POINTS, faces)).faces) == 0


@settings(max_examples=30)
@given(closed_meshes())
def test_a_closed_mesh_has_three_pairs_for_two_faces(mesh: TriMesh) -> None:
    assert len(edge_adjacency(mesh).faces) == 3 * mesh.n_faces // 2


@settings(max_examples=50)
@given(meshes())
def test_pairs_are_ascending_distinct_faces_that_hold_the_edge(mesh: TriMesh) -> None:
    adjacency = edge_adjacency(mesh)
    assert (adjacency.faces[:, 0] < adjacency.faces[:, 1]).all()
    for pair, edge in zip(adjacency.faces, adjacency.edges, strict=True):
        for face in pair:
            assert set(edge) <= set(mesh.faces[face])


@settings(max_examples=50)
@given(meshes())
def test_vertex_neighbours_are_the_faces_with_a_common_vertex(mesh: TriMesh) -> None:
    corners = [set(face) for face in mesh.faces.tolist()]
    expected = [[bool(a & b) and i != j for j, b in enumerate(corners)] for i, a in enumerate(corners)]
    np.testing.assert_array_equal(vertex_neighbours(mesh).toarray(), expected)


def test_components_are_counted_across_edges_and_not_vertices() -> None:
    bow_tie = TriMesh(POINTS, np.array([[0, 1, 2], [2, 4, 5], [2, 1, 3]]))
    assert edge_components(bow_tie).tolist() == [0, 1, 0]


def test_regions_are_connected_and_of_one_label() -> None:
    pairs = np.array([[0, 1], [1, 2], [2, 3], [3, 4]])
    assert label_regions(np.array([7, 7, -1, 7, 7]), pairs).tolist() == [0, 0, 1, 2, 2]
    assert label_regions(np.array([3, 3, 3], dtype=np.uint16), pairs[:1]).tolist() == [0, 0, 1]
