"""k-means patches: clusters of position and normal, exactly as many connected pieces as asked for."""

import numpy as np
import pytest

from partwise.errors import ParameterError
from partwise.geometry.faces import face_centroids
from partwise.mesh import TriMesh
from partwise.segmentation.k_means_patches import KMeansPatches
from partwise.segmentation.patch_parameters import KMeansParameters
from partwise.testing.meshes import subdivided


def cube(n_subdivisions=2):
    corners = np.array([[x, y, z] for x in (0, 1) for y in (0, 1) for z in (0, 1)], dtype=np.float64)
    quads = np.array([[0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3]])
    mesh = TriMesh(corners, np.concatenate([quads[:, [0, 1, 2]], quads[:, [0, 2, 3]]]))
    for _ in range(n_subdivisions):
        mesh = subdivided(mesh)
    return mesh


def sheet(n):
    """A flat row of n squares, 2 n triangles."""
    x = np.arange(n + 1, dtype=np.float64)
    vertices = np.concatenate([np.stack([x, 0 * x, 0 * x], axis=1), np.stack([x, 0 * x + 1, 0 * x], axis=1)])
    a = np.arange(n)
    lower, upper = np.stack([a, a + 1, a + n + 2], axis=1), np.stack([a, a + n + 2, a + n + 1], axis=1)
    return TriMesh(vertices, np.concatenate([lower, upper]))


def test_six_patches_of_a_cube_are_its_sides():
    mesh = cube()
    labels = KMeansPatches(mesh, KMeansParameters(normal_weight=1.0)).patches(6)
    side = np.argmin(np.abs(np.concatenate([face_centroids(mesh), 1 - face_centroids(mesh)], axis=1)), axis=1)
    assert len(np.unique(np.stack([labels, side]), axis=1).T) == 6


def test_a_sheet_is_cut_in_equal_lengths():
    mesh = sheet(40)
    assert np.bincount(KMeansPatches(mesh).patches(4)).tolist() == pytest.approx([20] * 4, abs=2)


def test_a_cluster_in_two_pieces_is_not_one_patch():
    # Three steps: the two treads share a normal that counts for nearly everything, the riser between parts them.
    profile = np.array([[0, 0], [1, 0], [1, 1], [2, 1]], dtype=np.float64)
    vertices = np.concatenate([np.insert(profile, 1, y, axis=1) for y in (0.0, 1.0)])
    a = np.arange(3)
    faces = np.concatenate([np.stack([a, a + 1, a + 5], axis=1), np.stack([a, a + 5, a + 4], axis=1)])
    labels = KMeansPatches(TriMesh(vertices, faces), KMeansParameters(normal_weight=100.0)).patches(3)
    np.testing.assert_array_equal(labels[:3], labels[3:])
    assert len(set(labels[:3].tolist())) == 3


def test_faces_that_look_the_same_are_still_as_many_patches_as_asked():
    mesh = sheet(3)
    doubled = TriMesh(mesh.vertices, np.concatenate([mesh.faces, mesh.faces]))  # each face twice, in one place
    assert len(np.unique(KMeansPatches(doubled).patches(12))) == 12


@pytest.mark.parametrize(("name", "value"), [("normal_weight", -1.0), ("normal_weight", np.nan), ("max_iterations", 0)])
def test_refuses_parameters_out_of_range(name, value):
    with pytest.raises(ParameterError, match=f"{name} must be"):
        KMeansParameters(**{name: value})
