"""The connected region of equal label."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from partwise.errors import LabelError, ParameterError
from partwise.geometry.adjacency import edge_components
from partwise.mesh import TriMesh
from partwise.segmentation.face_graph import FaceGraph
from partwise.segmentation.region import region_of
from partwise.testing.meshes import meshes

_STRIP = TriMesh(
    np.array([[k // 2, k % 2, 0] for k in range(8)], dtype=np.float64), np.array([[k, k + 1, k + 2] for k in range(6)])
)


@settings(max_examples=40, deadline=None)
@given(meshes())
def test_of_one_label_it_is_the_connected_component(mesh: TriMesh) -> None:
    component = edge_components(mesh)
    region = region_of(FaceGraph.build(mesh), np.zeros(mesh.n_faces, np.uint16), 0)
    np.testing.assert_array_equal(region, np.flatnonzero(component == component[0]))


@settings(max_examples=40, deadline=None)
@given(meshes(), st.data())
def test_regions_are_the_same_from_each_of_their_faces(mesh: TriMesh, data: st.DataObject) -> None:
    graph = FaceGraph.build(mesh)
    labels = np.array(data.draw(st.lists(st.integers(0, 2), min_size=mesh.n_faces, max_size=mesh.n_faces)), np.uint16)
    region = region_of(graph, labels, data.draw(st.integers(0, mesh.n_faces - 1)))
    assert len(set(labels[region].tolist())) == 1
    np.testing.assert_array_equal(region_of(graph, labels, int(region[-1])), region)


def test_another_label_between_parts_the_regions() -> None:
    labels = np.array([1, 1, 2, 1, 1, 1], np.uint16)
    assert region_of(FaceGraph.build(_STRIP), labels, 0).tolist() == [0, 1]
    assert region_of(FaceGraph.build(_STRIP), labels, 4).tolist() == [3, 4, 5]


def test_unlabelled_faces_are_a_region_too() -> None:
    labels = np.array([1, 0, 0, 0, 1, 1], np.uint16)
    assert region_of(FaceGraph.build(_STRIP), labels, 2).tolist() == [1, 2, 3]


def test_labels_of_another_mesh_are_refused() -> None:
    with pytest.raises(LabelError, match=r"\(5,\) labels for 6 faces"):
        region_of(FaceGraph.build(_STRIP), np.zeros(5, np.uint16), 0)


@pytest.mark.parametrize("seed", [-1, 6])
def test_a_seed_outside_the_mesh_is_refused(seed: int) -> None:
    with pytest.raises(ParameterError, match="a face must be 0 to 5"):
        region_of(FaceGraph.build(_STRIP), np.zeros(6, np.uint16), seed)
