"""Random-walk patches: walks average, creases hold them back, and thickness tells parts apart."""

import numpy as np
import pytest

from partwise.errors import ParameterError
from partwise.geometry.adjacency import edge_adjacency
from partwise.geometry.faces import face_areas, face_centroids
from partwise.mesh import TriMesh
from partwise.segmentation.crease_walk import crease_distances, walk_conductances, walk_means
from partwise.segmentation.patch_parameters import RandomWalkParameters
from partwise.segmentation.random_walk_patches import RandomWalkPatches

DEFAULTS = RandomWalkParameters()


def strip(heights, step=1.0, n_across=6):
    """A sheet of n_across rows along a profile of the given heights, facing up; two triangles a square."""
    n = len(heights)
    x, y = np.meshgrid(np.arange(n) * step, np.arange(n_across + 1) * step, indexing="ij")
    z = np.repeat(np.asarray(heights, dtype=np.float64)[:, None], n_across + 1, axis=1)
    vertices = np.stack([x, y, z], axis=-1).reshape(-1, 3)
    corner = (np.arange(n - 1)[:, None] * (n_across + 1) + np.arange(n_across)).ravel()
    a, b, c, d = corner, corner + n_across + 1, corner + n_across + 2, corner + 1
    return TriMesh(vertices, np.concatenate([np.stack([a, b, c], axis=1), np.stack([a, c, d], axis=1)]))


def valley():
    """Two slopes of 6 squares each that meet in a concave crease at x = 6."""
    return strip(np.abs(np.arange(13) - 6.0))


def ridge():
    return strip(-np.abs(np.arange(13) - 6.0))


def test_flat_sheets_have_no_creases():
    mesh = strip(np.zeros(5))
    np.testing.assert_array_equal(crease_distances(mesh, edge_adjacency(mesh), 0.1), 0.0)


def test_a_convex_crease_counts_convex_factor_times_a_concave_one():
    # A valley and a ridge of the same angle in one mesh, so that both are divided by the same mean.
    mesh = strip([1, 0, 1, 2, 1, 2, 3])
    adjacency = edge_adjacency(mesh)
    d = crease_distances(mesh, adjacency, 0.25)
    x = mesh.vertices[adjacency.edges][:, :, 0]
    valley_d, ridge_d = (d[(x == at).all(axis=1)] for at in (1.0, 3.0))
    assert len(valley_d) == len(ridge_d) == 6
    np.testing.assert_allclose(ridge_d, 0.25 * valley_d)


def test_the_mean_crease_over_length_is_one():
    mesh = strip(np.cos(np.arange(20)))
    adjacency = edge_adjacency(mesh)
    assert np.average(crease_distances(mesh, adjacency, 0.1), weights=adjacency.lengths) == pytest.approx(1.0)


def test_conductances_do_not_depend_on_scale():
    small, large = (strip(np.cos(np.arange(9)) * step, step) for step in (1.0, 50.0))
    first, second = (walk_conductances(mesh, edge_adjacency(mesh), DEFAULTS) for mesh in (small, large))
    np.testing.assert_allclose(first, second)


def test_walks_leave_a_constant_as_it_is():
    mesh = valley()
    means = walk_means(mesh, edge_adjacency(mesh), np.full((mesh.n_faces, 2), 7.0), DEFAULTS)
    np.testing.assert_allclose(means, 7.0)


def test_walks_keep_the_integral_and_stay_between_the_extremes():
    mesh = valley()
    values = np.random.default_rng(0).standard_normal((mesh.n_faces, 1))
    means = walk_means(mesh, edge_adjacency(mesh), values, DEFAULTS)
    areas = face_areas(mesh)
    assert areas @ means == pytest.approx(areas @ values)
    assert values.min() < means.min()
    assert means.max() < values.max()


def test_a_short_reach_leaves_values_and_a_long_one_averages_them():
    mesh = strip(np.zeros(13))
    values = face_centroids(mesh)[:, :1]
    near, far = (
        walk_means(mesh, edge_adjacency(mesh), values, RandomWalkParameters(reach=reach)) for reach in (1e-5, 1e3)
    )
    np.testing.assert_allclose(near, values, atol=1e-6)
    np.testing.assert_allclose(far[:, 0], face_areas(mesh) @ values[:, 0] / face_areas(mesh).sum(), atol=1e-3)


def test_walks_solve_the_dense_equations():
    mesh = valley()
    adjacency = edge_adjacency(mesh)
    values = face_centroids(mesh)
    i, j = adjacency.faces.T
    diagonal = np.linalg.norm(np.ptp(mesh.vertices, axis=0))
    laplacian = np.zeros((mesh.n_faces, mesh.n_faces))
    for a, b, w in zip(i, j, walk_conductances(mesh, adjacency, DEFAULTS), strict=True):
        laplacian[[a, b], [a, b]] += w
        laplacian[[a, b], [b, a]] -= w
    M = np.diag(face_areas(mesh))
    expected = np.linalg.solve(M + (DEFAULTS.reach * diagonal) ** 2 * laplacian, M @ values)
    np.testing.assert_allclose(walk_means(mesh, adjacency, values, DEFAULTS), expected, atol=1e-9)


def test_two_slopes_are_two_patches_that_meet_in_the_crease():
    mesh = strip(np.abs(np.arange(13) - 4.0))  # not in the middle, where position alone would cut
    labels = RandomWalkPatches(mesh, np.zeros(mesh.n_faces)).patches(2)
    is_left = face_centroids(mesh)[:, 0] < 4
    assert len(np.unique(labels[is_left])) == len(np.unique(labels[~is_left])) == 1


def test_a_concave_crease_holds_walks_back_more_than_a_convex_one():
    def jump(mesh):
        # A long bend beside the crease, so that the mean crease is alike in both.
        values = face_centroids(mesh)[:, :1]
        means = walk_means(mesh, edge_adjacency(mesh), values, RandomWalkParameters(reach=1.0))[:, 0]
        is_left = face_centroids(mesh)[:, 0] < 6
        return means[~is_left].mean() - means[is_left].mean()

    bumps = [0, 1, 0, 1, 0, 1, 0]
    first = strip([*bumps, 1, 2, 3, 4])  # concave at x = 6
    second = strip([*bumps, -1, -2, -3, -4])  # straight through x = 6
    assert jump(first) > jump(second)


def test_thickness_alone_cuts_where_it_changes():
    mesh = strip(np.zeros(13))
    is_thick = face_centroids(mesh)[:, 0] < 4
    labels = RandomWalkPatches(
        mesh, is_thick.astype(np.float64), RandomWalkParameters(reach=1e-3, thickness_weight=100.0)
    ).patches(2)
    assert len(np.unique(labels[is_thick])) == len(np.unique(labels[~is_thick])) == 1
    assert labels[is_thick][0] != labels[~is_thick][0]


def test_left_out_shape_diameters_are_computed():
    from partwise.features.shape_diameter import shape_diameter

    mesh = ridge()
    given, computed = RandomWalkPatches(mesh, shape_diameter(mesh)), RandomWalkPatches(mesh)
    np.testing.assert_array_equal(given.patches(8), computed.patches(8))


@pytest.mark.parametrize("diameters", [np.zeros(3), np.full(144, np.nan)])
def test_refuses_shape_diameters_that_do_not_fit(diameters):
    with pytest.raises(ParameterError, match=r"shape diameters must be \(144,\) finite numbers"):
        RandomWalkPatches(valley(), diameters)


@pytest.mark.parametrize(
    ("name", "value"),
    [
        ("convex_factor", 0.0),
        ("convex_factor", 1.1),
        ("crease_scale", 0.0),
        ("crease_scale", np.inf),
        ("reach", -1.0),
        ("reach", np.nan),
        ("thickness_weight", -0.1),
        ("thickness_weight", np.inf),
    ],
)
def test_refuses_parameters_out_of_range(name, value):
    with pytest.raises(ParameterError, match=f"{name} must be"):
        RandomWalkParameters(**{name: value})
