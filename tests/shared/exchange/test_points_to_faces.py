"""Labels from points to faces: true on simulated shapes, refused off the mesh, blank where no point is."""

from functools import cache

import numpy as np
import pytest

from partwise.errors import LabelError, ParameterError
from partwise.exchange.labelled_mesh import LabelledMesh
from partwise.exchange.labelled_points import LabelledPoints, sample_labelled_points
from partwise.exchange.points_to_faces import PointTransfer, face_labels_from_points
from partwise.geometry.faces import face_areas
from partwise.mesh import TriMesh
from partwise.simulate.collection import shape_seed, simulate_shape


@cache
def shape(category="chairs", dirty=False):
    return simulate_shape(category, shape_seed(category, 5, 0), "a", dirty=dirty, n_faces=2_000)


def points_of(labelled, n_points=2_500, seed=1):
    return sample_labelled_points(labelled, n_points, np.random.default_rng(seed))


@pytest.mark.parametrize(
    ("category", "dirty"), [("chairs", False), ("chairs", True), ("lamps", True), ("tables", False), ("mugs", False)]
)
def test_most_of_the_surface_gets_its_label_back(category, dirty):
    true = shape(category, dirty)
    found = face_labels_from_points(points_of(LabelledMesh(true.mesh, true.labels)), true.mesh)
    areas = face_areas(true.mesh)
    assert areas[found == true.labels].sum() >= 0.97 * areas.sum()


def test_fitting_the_box_undoes_scale_and_shift():
    true = shape()
    points = points_of(LabelledMesh(true.mesh, true.labels), 10_000)
    moved = LabelledPoints(points.points * 0.3 + [5, 0, -2], points.normals, points.labels)
    found = face_labels_from_points(moved, true.mesh, PointTransfer(fit_box=True))
    assert (found == true.labels).mean() > 0.97


def test_points_of_another_place_are_refused():
    true = shape()
    points = points_of(LabelledMesh(true.mesh, true.labels))
    moved = LabelledPoints(points.points * 0.3, points.normals, points.labels)
    with pytest.raises(LabelError, match="fit their box"):
        face_labels_from_points(moved, true.mesh)


def test_points_of_another_shape_are_refused():
    chair, table = shape(), shape("tables")
    points = points_of(LabelledMesh(table.mesh, table.labels))
    with pytest.raises(LabelError, match="another mesh"):
        face_labels_from_points(points, chair.mesh, PointTransfer(fit_box=True))


def test_where_no_point_is_faces_stay_unlabelled():
    """Two squares far apart; points on the first."""
    square = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]], dtype=np.float64)
    faces = np.array([[0, 1, 2], [0, 2, 3]])
    mesh = TriMesh(np.concatenate([square, square + np.array([9, 0, 0])]), np.concatenate([faces, faces + 4]))
    labelled = LabelledMesh(mesh, np.array([3, 5, -1, -1]))
    points = sample_labelled_points(labelled, 400, np.random.default_rng(0), omit_unlabelled=True)
    assert face_labels_from_points(points, mesh).tolist() == [3, 5, -1, -1]
    everywhere = PointTransfer(reach=np.inf)
    assert -1 not in face_labels_from_points(points, mesh, everywhere)


def test_the_sides_of_a_thin_wall_are_told_apart_by_normals():
    """Opposite faces of a slab have other labels; a rim point's nearest neighbour is often the floor's."""
    square = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]], dtype=np.float64)
    wall = np.array([[0, 0, 0], [0, 0, 1], [0, 1, 1], [0, 1, 0]], dtype=np.float64)
    faces = np.array([[0, 1, 2], [0, 2, 3]])
    mesh = TriMesh(np.concatenate([square, wall]), np.concatenate([faces, faces + 4]))
    labelled = LabelledMesh(mesh, np.array([1, 1, 2, 2]))
    assert face_labels_from_points(points_of(labelled, 60), mesh).tolist() == [1, 1, 2, 2]


def test_a_single_point():
    mesh = TriMesh(np.eye(3), np.array([[0, 1, 2]]))
    points = LabelledPoints(np.full((1, 3), 1 / 3), None, np.array([7]))
    assert face_labels_from_points(points, mesh, PointTransfer(n_neighbours=5)).tolist() == [7]


def test_neighbours_outvote_a_stray_label():
    mesh = TriMesh(np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0.0]]), np.array([[0, 1, 2]]))
    points = points_of(LabelledMesh(mesh, np.array([1])), 30)
    labels = points.labels.copy()
    labels[::6] = 2
    stray = LabelledPoints(points.points, points.normals, labels)
    assert face_labels_from_points(stray, mesh, PointTransfer(n_neighbours=5)).tolist() == [1]


@pytest.mark.parametrize("changes", [{"n_neighbours": 0}, {"max_distance": 0.0}, {"reach": np.nan}])
def test_parameters_out_of_range(changes):
    with pytest.raises(ParameterError):
        PointTransfer(**changes)
