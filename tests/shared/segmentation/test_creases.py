"""Creases: their sign and size on folds, and what does not change them."""

import numpy as np
import pytest
from hypothesis import given, settings

from partwise.geometry.adjacency import edge_adjacency
from partwise.mesh import TriMesh
from partwise.segmentation.creases import SCALE, measure_creases
from partwise.testing.meshes import meshes


def bent_sheet(height: float) -> tuple[TriMesh, np.ndarray]:
    """A sheet of 40 × 40 squares folded along its middle, valley up for height > 0; and which edges are on the fold."""
    n = 40
    x, y = (grid.ravel() for grid in np.meshgrid(*[np.arange(n + 1.0)] * 2, indexing="ij"))
    i, j = (grid.ravel() for grid in np.meshgrid(np.arange(n), np.arange(n), indexing="ij"))
    a, b, c, d = (p * (n + 1) + q for p, q in ((i, j), (i + 1, j), (i + 1, j + 1), (i, j + 1)))
    vertices = np.stack([x, y, height * np.maximum(x - n / 2, 0.0)], axis=1)
    mesh = TriMesh(vertices, np.stack([a, b, c, a, c, d], axis=1).reshape(-1, 3))
    return mesh, (vertices[edge_adjacency(mesh).edges][:, :, 0] == n / 2).all(axis=1)


@pytest.mark.parametrize("height", [1.0, -1.0])
def test_a_fold_has_its_angle_positive_where_concave(height):
    mesh, on_fold = bent_sheet(height)
    creases = measure_creases(mesh, edge_adjacency(mesh))
    np.testing.assert_allclose(creases.angles[on_fold], np.sign(height) * np.pi / 4)
    np.testing.assert_allclose(creases.angles[~on_fold], 0.0, atol=1e-6)
    assert (np.sign(height) * creases.bends[on_fold] > 0).all()


def test_a_sphere_bends_by_its_curvature():
    # On a sphere of radius R normals turn by s/R over a way of s; the bend is that for s = SCALE·diagonal, convex.
    rng = np.random.default_rng(0)
    n = 60
    theta, phi = np.meshgrid(np.linspace(0.4, np.pi - 0.4, n), np.linspace(0, np.pi, n), indexing="ij")
    vertices = np.stack([np.sin(theta) * np.cos(phi), np.sin(theta) * np.sin(phi), np.cos(theta)], axis=-1)
    i, j = (grid.ravel() for grid in np.meshgrid(np.arange(n - 1), np.arange(n - 1), indexing="ij"))
    a, b, c, d = (p * n + q for p, q in ((i, j), (i + 1, j), (i + 1, j + 1), (i, j + 1)))
    mesh = TriMesh(vertices.reshape(-1, 3) * rng.uniform(1, 3), np.stack([a, b, c, a, c, d], axis=1).reshape(-1, 3))
    adjacency = edge_adjacency(mesh)
    diagonal = np.linalg.norm(np.ptp(mesh.vertices, axis=0))
    radius = np.linalg.norm(mesh.vertices[0])
    bends = measure_creases(mesh, adjacency).bends
    assert np.median(bends) == pytest.approx(-SCALE * diagonal / radius, rel=0.05)


def test_diameters_jump_and_slope_where_they_change():
    mesh, on_fold = bent_sheet(0.0)
    diameter = np.where(np.arange(mesh.n_faces) < mesh.n_faces // 2, 0.2, 0.5)
    creases = measure_creases(mesh, edge_adjacency(mesh), diameter)
    np.testing.assert_allclose(creases.diameter_jumps, np.where(on_fold, 0.3, 0.0))
    assert creases.diameter_slopes[on_fold].min() > creases.diameter_slopes[~on_fold].max()


def test_without_diameters_there_are_no_changes_of_them():
    mesh, _ = bent_sheet(1.0)
    creases = measure_creases(mesh, edge_adjacency(mesh))
    assert not creases.has_diameter
    assert not creases.diameter_jumps.any()
    assert not creases.diameter_slopes.any()


@given(meshes())
@settings(max_examples=80, deadline=None)
def test_everything_is_finite_on_any_mesh(mesh):
    adjacency = edge_adjacency(mesh)
    creases = measure_creases(mesh, adjacency, np.linspace(0, 1, mesh.n_faces))
    for values in (creases.angles, creases.bends, creases.diameter_jumps, creases.diameter_slopes):
        assert values.shape == (len(adjacency.faces),)
        assert np.isfinite(values).all()


def test_a_mesh_without_pairs_of_faces_has_no_creases():
    mesh = TriMesh(np.eye(3), np.array([[0, 1, 2]]))
    assert len(measure_creases(mesh, edge_adjacency(mesh)).angles) == 0
