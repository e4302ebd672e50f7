"""Displaced boundaries stay within their bound, and are the same for the same seed."""

import numpy as np
import pytest

from partwise.errors import LabelError, ParameterError
from partwise.mesh import TriMesh
from partwise_cli.bench.displacement import displaced, smooth_field


def sheet(n: int) -> TriMesh:
    """A flat unit square of 2 n² triangles, column by column."""
    x, y = (grid.ravel() for grid in np.meshgrid(*[np.linspace(0, 1, n + 1)] * 2, indexing="ij"))
    i, j = (grid.ravel() for grid in np.meshgrid(np.arange(n), np.arange(n), indexing="ij"))
    a, b, c, d = (p * (n + 1) + q for p, q in ((i, j), (i + 1, j), (i + 1, j + 1), (i, j + 1)))
    return TriMesh(np.stack([x, y, 0 * x], axis=1), np.stack([a, b, c, a, c, d], axis=1).reshape(-1, 3))


def halves(mesh: TriMesh) -> np.ndarray:
    return np.where(mesh.vertices[mesh.faces][:, :, 0].mean(axis=1) < 0.5, 2, 9)


@pytest.mark.parametrize("seed", range(4))
def test_only_faces_near_the_boundary_change(seed):
    mesh = sheet(40)
    labels = halves(mesh)
    moved = displaced(mesh, labels, np.random.default_rng(seed), furthest=0.05)
    distance = np.abs(mesh.vertices[mesh.faces][:, :, 0].mean(axis=1) - 0.5)
    bound = 0.05 * np.sqrt(2) * 1.1  # paths over faces are a little longer than straight
    assert (moved != labels).sum() > 0
    assert distance[moved != labels].max() < bound
    assert np.isin(moved, [2, 9]).all()


def test_the_same_seed_gives_the_same_labels_and_another_does_not():
    mesh = sheet(30)
    first, again, other = (displaced(mesh, halves(mesh), np.random.default_rng(seed)) for seed in (1, 1, 2))
    np.testing.assert_array_equal(first, again)
    assert (first != other).any()


def test_a_single_part_has_no_boundary_to_move():
    mesh = sheet(3)
    np.testing.assert_array_equal(displaced(mesh, np.full(18, 4), np.random.default_rng(0)), np.full(18, 4))


def test_the_field_is_bounded_and_smooth():
    points = np.stack([np.linspace(0, 3, 3001), np.zeros(3001), np.zeros(3001)], axis=1)
    field = smooth_field(points, np.random.default_rng(3))
    assert np.abs(field).max() <= 1.0
    assert np.abs(np.diff(field)).max() < 0.1  # a thousandth of a unit apart
    assert np.ptp(field) > 0.5


@pytest.mark.parametrize("wrong", [np.zeros(5, dtype=np.int64), np.full(18, -1)])
def test_refuses_labels_that_do_not_fit_or_are_missing(wrong):
    with pytest.raises(LabelError, match="label every face"):
        displaced(sheet(3), wrong, np.random.default_rng(0))


@pytest.mark.parametrize("name", ["furthest", "wavelength"])
@pytest.mark.parametrize("value", [0.0, -1.0, np.nan, np.inf])
def test_refuses_sizes_out_of_range(name, value):
    with pytest.raises(ParameterError, match=name):
        displaced(sheet(3), halves(sheet(3)), np.random.default_rng(0), **{name: value})
