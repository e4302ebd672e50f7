"""The path of a drag over points."""

import numpy as np

from partwise.simulate.annotator.kernels.scribble import scribble

LINE = np.column_stack([np.arange(10) / 10, np.zeros(10), np.zeros(10)])


def test_a_drag_goes_on_to_the_nearest_point_that_is_not_covered():
    seeds, covered = scribble(LINE, np.ones(10, bool), 0, 0.15, 0.5, 40)
    np.testing.assert_array_equal(seeds, [0, 2, 4, 6, 8])
    assert covered.all()


def test_it_ends_after_so_many_seeds_and_where_the_next_is_too_far():
    assert len(scribble(LINE, np.ones(10, bool), 0, 0.15, 0.5, 2)[0]) == 2
    eligible = np.arange(10) != 2
    eligible[3:6] = False
    seeds, covered = scribble(LINE, eligible, 0, 0.15, 0.3, 40)
    np.testing.assert_array_equal(seeds, [0])
    np.testing.assert_array_equal(np.flatnonzero(covered), [0, 1])


def test_the_brush_is_put_on_eligible_points_only():
    eligible = np.isin(np.arange(10), [3, 7])
    seeds, _ = scribble(LINE, eligible, 3, 0.15, 1.0, 40)
    np.testing.assert_array_equal(seeds, [3, 7])
