"""Trees of patches: cuts are partitions, nested, connected, and merge what is alike."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from partwise.errors import ParameterError
from partwise.geometry.adjacency import edge_adjacency, edge_components
from partwise.geometry.faces import face_areas, face_centroids
from partwise.segmentation.patch_tree import patch_tree
from partwise.testing.meshes import meshes

CHAIN = np.array([[0, 1], [1, 2], [2, 3]])
ONES = np.ones(4)


def tree_of(mesh):
    return patch_tree(edge_adjacency(mesh).faces, face_areas(mesh), face_centroids(mesh))


def line(*values):
    return np.array(values, dtype=np.float64)[:, None]


@given(meshes(), st.data())
@settings(max_examples=30, deadline=None)
def test_a_cut_has_the_number_asked_for_or_one_a_component(mesh, data):
    n = data.draw(st.integers(1, mesh.n_faces))
    n_components = int(edge_components(mesh).max()) + 1
    np.testing.assert_array_equal(np.unique(tree_of(mesh).cut(n)), np.arange(max(n, n_components)))


@given(meshes())
@settings(max_examples=30, deadline=None)
def test_one_patch_more_splits_one_patch_and_keeps_all_other_numbers(mesh):
    tree = tree_of(mesh)
    for n in range(tree.n_components, mesh.n_faces):
        fewer, more = tree.cut(n), tree.cut(n + 1)
        changed = more != fewer
        assert set(more[changed].tolist()) == {n}
        assert len(set(fewer[changed].tolist())) == 1


def test_the_smallest_loss_merges_first():
    tree = patch_tree(CHAIN, ONES, line(0, 1, 1.5, 4))
    np.testing.assert_array_equal(tree.merges, [[1, 2], [4, 0], [5, 3]])


def test_the_loss_is_ward_s():
    # 1 and 2 are closer than 0 and 1, but heavier: 4·4/8·0.9² > 1·4/5·1².
    tree = patch_tree(CHAIN[:2], np.array([1.0, 4.0, 4.0]), line(0, 1, 1.9))
    np.testing.assert_array_equal(tree.merges[0], [1, 0])


def test_only_neighbours_merge_however_alike():
    tree = patch_tree(CHAIN, ONES, line(0, 5, 0, 5.1))
    assert tree.cut(3).tolist() != [0, 1, 0, 2]
    assert {tuple(pair) for pair in tree.merges[:1].tolist()} <= {(0, 1), (1, 2), (2, 3)}


def test_the_larger_half_keeps_the_number():
    tree = patch_tree(CHAIN[:1], np.array([1.0, 3.0]), line(0, 1))
    np.testing.assert_array_equal(tree.cut(2), [1, 0])


def test_ties_go_to_the_lower_indices():
    tree = patch_tree(CHAIN, ONES, line(0, 0, 0, 0))
    np.testing.assert_array_equal(tree.merges[0], [0, 1])


def test_leaves_without_area_merge_first():
    tree = patch_tree(CHAIN, np.array([1.0, 0.0, 1.0, 1.0]), line(0, 100, 0.1, 0.2))
    assert 1 in tree.merges[0]


def test_repeated_pairs_change_nothing():
    features = line(0, 1, 1.5, 4)
    once, twice = (patch_tree(pairs, ONES, features) for pairs in (CHAIN, np.concatenate([CHAIN, CHAIN[:, ::-1]])))
    for n in range(1, 5):
        np.testing.assert_array_equal(once.cut(n), twice.cut(n))


def test_components_are_numbered_and_never_joined():
    tree = patch_tree(CHAIN[[0, 2]], ONES, line(0, 0, 0, 0))
    assert tree.n_components == 2
    np.testing.assert_array_equal(tree.cut(1), [0, 0, 1, 1])


def test_leaves_without_neighbours_are_patches():
    tree = patch_tree(np.zeros((0, 2), dtype=np.int64), ONES, line(1, 2, 3, 4))
    np.testing.assert_array_equal(tree.cut(1), [0, 1, 2, 3])


@pytest.mark.parametrize("n", [0, -1, 5])
def test_refuses_a_number_out_of_range(n):
    with pytest.raises(ParameterError, match=r"must be in 1 … 4, the number of faces"):
        patch_tree(CHAIN, ONES, line(1, 2, 3, 4)).cut(n)


@pytest.mark.parametrize("n", [2.0, True, float("nan"), "3"])
def test_refuses_what_is_no_whole_number(n):
    with pytest.raises(ParameterError, match="whole number"):
        patch_tree(CHAIN, ONES, line(1, 2, 3, 4)).cut(n)
