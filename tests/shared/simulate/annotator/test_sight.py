"""What a simulated person sees: what is wrong, how much is right, and where another part begins."""

import numpy as np
import pytest

from partwise.errors import LabelError, NotEnoughDataError
from partwise.mesh import TriMesh
from partwise.simulate.annotator.sight import Sight


@pytest.fixture
def sheet():
    """A flat sheet of 8 × 8 squares whose first half is part 1, the rest part 2."""
    x, y = np.meshgrid(np.arange(9.0), np.arange(9.0), indexing="ij")
    corner = (np.arange(8)[:, None] * 9 + np.arange(8)).ravel()
    squares = np.stack([corner, corner + 9, corner + 10, corner + 1], axis=1)
    faces = np.concatenate([squares[:, [0, 1, 2]], squares[:, [0, 2, 3]]])
    mesh = TriMesh(np.column_stack([x.ravel(), y.ravel(), np.zeros(81)]), faces)
    left = mesh.vertices[mesh.faces].mean(axis=1)[:, 0] < np.median(mesh.vertices[:, 0])
    return mesh, np.where(left, 1, 2)


def test_the_truth_looks_all_right_and_the_rest_wrong(sheet):
    mesh, belongs = sheet
    sight = Sight.of(mesh, belongs)
    assert sight.right_share(belongs) == pytest.approx(1.0)
    assert not sight.is_wrong(belongs).any()
    half_wrong = np.ones_like(belongs)
    assert sight.right_share(half_wrong) == pytest.approx(0.5)
    np.testing.assert_array_equal(sight.is_wrong(half_wrong), belongs == 2)


def test_where_nobody_knows_nothing_is_wrong_and_no_area_counts(sheet):
    mesh, belongs = sheet
    sight = Sight.of(mesh, np.where(belongs == 2, 0, 1))
    assert sight.right_share(np.ones_like(belongs)) == pytest.approx(1.0)
    assert not sight.is_wrong(np.ones_like(belongs)).any()


def test_room_grows_with_distance_from_the_other_part(sheet):
    mesh, belongs = sheet
    sight = Sight.of(mesh, belongs)
    away = np.abs(sight.points[:, 0] - (sight.points[belongs == 1, 0].max() + sight.points[belongs == 2, 0].min()) / 2)
    assert sight.room[np.argmax(away)] == sight.room.max()
    assert sight.room.min() > 0


def test_a_shape_of_one_part_has_a_whole_diagonal_of_room(sheet):
    mesh, belongs = sheet
    assert (Sight.of(mesh, np.ones_like(belongs)).room == 1.0).all()


def test_gain_of_a_group_is_what_its_best_part_makes_right_beyond_what_is(sheet):
    mesh, belongs = sheet
    sight = Sight.of(mesh, belongs)
    part, gain = sight.gain_table(np.ones_like(belongs), belongs - 1)
    np.testing.assert_array_equal(part, [1, 2])
    np.testing.assert_allclose(gain, [0.0, 0.5], atol=1e-12)
    part, gain = sight.gain_table(belongs, np.zeros_like(belongs))  # one group over both: half would be lost
    assert gain[0] == pytest.approx(-0.5)


def test_filling_waits_until_every_segment_has_some_of_its_part(sheet):
    mesh, belongs = sheet
    sight = Sight.of(mesh, belongs)
    labels = np.zeros_like(belongs)
    labels[np.flatnonzero(belongs == 1)[0]] = 1
    assert not sight.is_ready_to_fill(labels)
    labels[np.flatnonzero(belongs == 2)[0]] = 2
    assert sight.is_ready_to_fill(labels)
    assert not sight.is_ready_to_fill(belongs)  # nothing left to fill


def test_the_pointer_meets_the_face_under_it(desk):
    for face in (0, 100, 700):
        assert desk.sight.face_at(desk.sight.points[face], desk.sight.normals[face]) == face


@pytest.mark.parametrize("belongs", [np.ones(3, np.int64), np.full(128, -1)])
def test_refuses_what_is_no_part_id_a_face(sheet, belongs):
    with pytest.raises(LabelError, match="part ids"):
        Sight.of(sheet[0], belongs)


def test_refuses_a_shape_of_which_nothing_is_known(sheet):
    with pytest.raises(NotEnoughDataError, match="label some"):
        Sight.of(sheet[0], np.zeros(sheet[0].n_faces, np.int64))
