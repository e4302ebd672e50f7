"""What a simulated person thinks of doing next."""

import numpy as np
import pytest

from partwise.labels.operations import Assign, Paint, SegmentWide
from partwise.segmentation.paint import PaintSurface, painted_faces
from partwise.simulate.annotator.motor import Hand, MotorModel, Tool
from partwise.simulate.annotator.moves import Outlook, paint_moves, patch_moves, segment_moves


@pytest.fixture
def outlook(desk):
    """Makes what a person has before them with these labels, looking from above."""

    def make(labels, n_patches=True, level=0) -> Outlook:
        patches = desk.equipped(Tool.PATCHES).patches if n_patches else ()
        hand = Hand(np.zeros(3), np.array([0.0, 0.0, 1.0]))
        return Outlook(desk.sight, labels.astype(np.uint16), hand, MotorModel(), patches, level)

    return make


def test_one_click_fills_a_blank_shape_with_its_largest_part(desk, outlook):
    blank = np.zeros(desk.mesh.n_faces)
    (move,) = segment_moves(outlook(blank))
    assert isinstance(move.operation, SegmentWide)
    assert move.operation.label == 1  # the body
    assert move.gain == pytest.approx(desk.sight.right_share(np.ones(desk.mesh.n_faces)))


def test_a_patch_move_assigns_whole_patches_and_gains_what_they_make_right(desk, outlook):
    blank = np.zeros(desk.mesh.n_faces, np.uint16)
    for move in patch_moves(outlook(blank)):
        assert isinstance(move.operation, Assign)
        after = blank.copy()
        after[move.operation.faces()] = move.operation.label
        assert move.gain == pytest.approx(desk.sight.right_share(after))
        patches = desk.equipped(Tool.PATCHES).patches[move.level]
        inside = np.zeros(len(patches), bool)
        inside[move.operation.faces()] = True
        taken = np.unique(patches[inside])
        np.testing.assert_array_equal(inside, np.isin(patches, taken))


def test_more_patches_are_thought_of_and_cost_the_slider(desk, outlook):
    model = MotorModel()
    moves = list(patch_moves(outlook(np.zeros(desk.mesh.n_faces))))
    assert [move.level for move in moves] == [0, 1, 2]
    assert [move.gesture.extra_s for move in moves] == [0.0, model.slider_s, model.slider_s]
    later = list(patch_moves(outlook(np.zeros(desk.mesh.n_faces), level=1)))
    assert [move.level for move in later] == [1, 2]  # nobody goes back


def test_a_brush_stays_clear_of_other_parts(desk, outlook):
    surface = PaintSurface.build(desk.mesh)
    moves = list(paint_moves(outlook(np.zeros(desk.mesh.n_faces))))
    assert moves
    for move in moves:
        assert isinstance(move.operation, Paint)
        taken = painted_faces(surface, move.operation.seeds, move.operation.brush)
        assert (desk.belongs[taken] == move.operation.label).all()


def test_a_brush_takes_about_what_a_person_expects(desk, outlook):
    surface = PaintSurface.build(desk.mesh)
    for move in paint_moves(outlook(np.zeros(desk.mesh.n_faces))):
        taken = painted_faces(surface, move.operation.seeds, move.operation.brush)
        assert desk.sight.areas[taken].sum() >= 0.5 * move.gain


def test_nothing_is_thought_of_where_all_is_right(desk, outlook):
    done = outlook(desk.belongs)
    assert [*segment_moves(done), *patch_moves(done), *paint_moves(done)] == []
