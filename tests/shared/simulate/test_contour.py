"""Contouring, reduction and label clean-up."""

import numpy as np
import pytest

from partwise.errors import DegenerateMeshError
from partwise.geometry.faces import face_areas, face_normals
from partwise.geometry.manifold import manifold_report
from partwise.mesh import TriMesh
from partwise.simulate.collection import CATEGORIES
from partwise.simulate.contour import (
    contour,
    grid_over,
    largest_component,
    reduce_faces,
    smooth_labels,
    tight_bounds,
)
from partwise.simulate.primitives import Ellipsoid, TorusArc

BOX = np.array([[-0.7, -0.7, -0.7], [0.7, 0.7, 0.7]])
SPHERE = Ellipsoid((0.5, 0.5, 0.5)).distance


def sphere_mesh() -> TriMesh:
    return contour(SPHERE, grid_over(BOX, 0.03))


def test_a_contoured_sphere_is_clean() -> None:
    assert manifold_report(sphere_mesh()).is_clean


def test_a_contoured_sphere_has_the_area_of_a_sphere() -> None:
    assert face_areas(sphere_mesh()).sum() == pytest.approx(np.pi, rel=0.01)


def test_faces_look_outwards() -> None:
    mesh = sphere_mesh()
    assert (np.einsum("ij,ij->i", face_normals(mesh), mesh.vertices[mesh.faces[:, 0]]) > 0.0).all()


@pytest.mark.parametrize("category", sorted(CATEGORIES))
def test_skipping_empty_blocks_loses_no_surface(category: str) -> None:
    blueprint = CATEGORIES[category].draw(np.random.default_rng(4))
    bounds = tight_bounds(blueprint.distance, blueprint.bounds())
    spacing = float(np.ptp(bounds, axis=0).max()) / 44
    grid = grid_over(bounds, spacing)
    points = grid.origin + np.indices(grid.shape).reshape(3, -1).T * spacing
    inside = (blueprint.distance(points) < 0.0).reshape(grid.shape)
    n_crossed_edges = sum(int((np.diff(inside.astype(int), axis=axis) != 0).sum()) for axis in range(3))
    assert contour(blueprint.distance, grid).n_vertices == n_crossed_edges


def test_a_field_that_crosses_nothing_is_refused() -> None:
    with pytest.raises(DegenerateMeshError, match="does not cross"):
        contour(lambda points: np.full(len(points), 5.0), grid_over(BOX, 0.1))


def test_a_field_that_is_nowhere_inside_has_no_bounds() -> None:
    with pytest.raises(DegenerateMeshError, match="negative somewhere"):
        tight_bounds(lambda points: np.full(len(points), 5.0), BOX)


def test_tight_bounds_hold_the_shape_closely() -> None:
    bounds = tight_bounds(SPHERE, 3.0 * BOX)
    assert (bounds[0] < -0.5).all()
    assert (bounds[1] > 0.5).all()
    assert np.abs(bounds).max() < 0.8


def test_the_largest_component_is_kept() -> None:
    sphere = sphere_mesh()
    small = TriMesh(0.5 * sphere.vertices + 2.0, sphere.faces)
    both = TriMesh(
        np.concatenate([small.vertices, sphere.vertices]),
        np.concatenate([small.faces, sphere.faces + small.n_vertices]),
    )
    kept, share = largest_component(both)
    assert kept.content_hash() == sphere.content_hash()
    assert share == pytest.approx(0.8)


@pytest.mark.parametrize("n_faces", [200, 1000, 2000])
def test_reduction_hits_its_count_and_stays_clean(n_faces: int) -> None:
    reduced = reduce_faces(sphere_mesh(), n_faces)
    assert reduced is not None
    assert manifold_report(reduced).is_clean
    assert abs(reduced.n_faces - n_faces) <= 2


def test_reduction_keeps_the_hole_of_a_ring() -> None:
    ring = contour(TorusArc(0.4, 0.12, np.pi).distance, grid_over(BOX, 0.04))
    reduced = reduce_faces(ring, 200)
    assert reduced is not None
    n_edges = reduced.n_faces * 3 // 2
    assert reduced.n_vertices - n_edges + reduced.n_faces == 0


def test_an_open_surface_cannot_be_reduced_to_a_clean_one() -> None:
    sphere = sphere_mesh()
    assert reduce_faces(TriMesh(sphere.vertices, sphere.faces[100:]), 1000) is None


def test_an_island_takes_the_label_around_it() -> None:
    mesh = sphere_mesh()
    labels = (mesh.vertices[mesh.faces[:, 0], 1] > 0.0).astype(np.int64)
    speckled = labels.copy()
    speckled[np.argmax(mesh.vertices[mesh.faces[:, 0], 1])] = 0
    np.testing.assert_array_equal(smooth_labels(mesh, speckled, 0.01), labels)


def test_large_regions_keep_their_labels() -> None:
    mesh = sphere_mesh()
    labels = (mesh.vertices[mesh.faces[:, 0], 1] > 0.0).astype(np.int64)
    np.testing.assert_array_equal(smooth_labels(mesh, labels, 0.01), labels)
