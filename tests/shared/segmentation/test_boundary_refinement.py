"""Boundary refinement: finds the crease, fills what is unlabelled, and never leaves a lower energy."""

import itertools
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from partwise.errors import LabelError, ParameterError
from partwise.mesh import TriMesh
from partwise.segmentation.boundary_refinement import BoundaryRefiner, refine_boundaries
from partwise.segmentation.energy import energy
from partwise.segmentation.parameters import PAPER_BOUNDARY, BoundaryParameters
from partwise.testing.meshes import meshes

PRESETS = pytest.mark.parametrize("parameters", [BoundaryParameters(), PAPER_BOUNDARY], ids=["default", "paper"])


def folded_sheet(n: int = 24, fold: int = 12, up: float = 1.0) -> TriMesh:
    """A square of 2 n² triangles, flat up to column `fold`, from there rising (up = 1, a concave fold seen from
    above) or falling (up = −1) at a right angle. Faces come column by column."""
    s, y = np.meshgrid(np.arange(n + 1.0), np.arange(n + 1.0), indexing="ij")
    vertices = np.stack([np.minimum(s, fold), y, up * np.maximum(s - fold, 0.0)], axis=-1).reshape(-1, 3)
    i, j = (grid.ravel() for grid in np.meshgrid(np.arange(n), np.arange(n), indexing="ij"))
    a, b, c, d = (p * (n + 1) + q for p, q in ((i, j), (i + 1, j), (i + 1, j + 1), (i, j + 1)))
    return TriMesh(vertices, np.stack([a, b, c, a, c, d], axis=1).reshape(-1, 3))


def from_column(column: int, n: int = 24) -> np.ndarray:
    """Labels 3 before a column and 7 from it on."""
    return np.where(np.arange(2 * n * n) // (2 * n) < column, 3, 7).astype(np.int64)


def side_by_side(first: TriMesh, second: TriMesh, gap: float) -> TriMesh:
    vertices = np.concatenate([first.vertices, second.vertices + np.array([0.0, gap, 0.0])])
    return TriMesh(vertices, np.concatenate([first.faces, second.faces + first.n_vertices]))


@pytest.mark.parametrize("column", [11, 13])
def test_a_boundary_beside_a_concave_fold_moves_onto_it(column):
    parameters = BoundaryParameters(band=0.1, smoothness=0.3)  # a column is 3 % of the diagonal
    refined = refine_boundaries(folded_sheet(), from_column(column), parameters)
    np.testing.assert_array_equal(refined, from_column(12))


def test_a_boundary_on_a_fold_stays():
    np.testing.assert_array_equal(refine_boundaries(folded_sheet(), from_column(12)), from_column(12))


def test_a_convex_fold_attracts_less_than_a_concave_one():
    mesh = folded_sheet(up=-1.0)
    refined = refine_boundaries(mesh, from_column(11), BoundaryParameters(band=0.1, smoothness=0.3))
    np.testing.assert_array_equal(refined, from_column(11))


def test_shape_diameter_attracts_where_there_is_no_crease():
    mesh = folded_sheet(up=0.0)  # degenerate beyond the fold
    flat = TriMesh(np.stack([np.repeat(np.arange(25.0), 25), mesh.vertices[:, 1], np.zeros(625)], axis=1), mesh.faces)
    diameter = np.where(from_column(12) == 3, 0.1, 0.9)
    parameters = BoundaryParameters(band=0.1, smoothness=1.0)
    with_diameter = refine_boundaries(flat, from_column(11), parameters, shape_diameter=diameter)
    np.testing.assert_array_equal(with_diameter, from_column(12))
    plain = replace(parameters, angle_weight=1.0)
    np.testing.assert_array_equal(
        refine_boundaries(flat, from_column(11), plain, shape_diameter=diameter),
        refine_boundaries(flat, from_column(11), plain),
    )


def test_unlabelled_faces_between_two_parts_are_split_at_the_fold():
    labels = from_column(12)
    labels[2 * 24 * 8 : 2 * 24 * 18] = -1
    np.testing.assert_array_equal(refine_boundaries(folded_sheet(), labels), from_column(12))


@PRESETS
def test_a_piece_without_labels_takes_those_of_the_nearest_piece(parameters):
    sheet = folded_sheet(8, 4)
    mesh = side_by_side(side_by_side(sheet, sheet, gap=20.0), sheet, gap=41.0)
    labels = np.repeat([5, 2, -1], sheet.n_faces)
    np.testing.assert_array_equal(refine_boundaries(mesh, labels, parameters), np.repeat([5, 2, 2], sheet.n_faces))


@PRESETS
def test_one_part_fills_everything(parameters):
    labels = np.full(2 * 24 * 24, -1)
    labels[100] = 4
    assert (refine_boundaries(folded_sheet(), labels, parameters) == 4).all()


def test_a_pass_with_the_same_anchor_changes_nothing_more():
    mesh, rng = folded_sheet(), np.random.default_rng(1)
    labels = np.where(rng.random(mesh.n_faces) < 0.1, 7, from_column(10))
    refiner = BoundaryRefiner.build(mesh)
    once = refiner.refine(labels)
    assert (once != labels).any()
    np.testing.assert_array_equal(refiner.refine(once, anchor=labels), once)


@st.composite
def labelled_meshes(draw):
    mesh = draw(meshes())
    labels = draw(st.lists(st.integers(-1, 3), min_size=mesh.n_faces, max_size=mesh.n_faces))
    labels[draw(st.integers(0, mesh.n_faces - 1))] = 2
    return mesh, np.array(labels, dtype=np.int64)


@PRESETS
@given(labelled_meshes())
@settings(max_examples=40, deadline=None)
def test_energy_never_rises_and_every_face_is_labelled(parameters, mesh_and_labels):
    mesh, labels = mesh_and_labels
    refiner = BoundaryRefiner.build(mesh)
    part_ids = np.unique(labels[labels >= 0])
    problem = refiner.problem(labels, part_ids, parameters)
    refined = refiner.refine(labels, parameters)
    assert np.isin(refined, part_ids).all()
    start = refiner.filled(labels)
    np.testing.assert_array_equal(start[labels >= 0], labels[labels >= 0])
    reached, before = (energy(problem, np.searchsorted(part_ids, given)) for given in (refined, start))
    assert reached <= before + 1e-9 * abs(before)


@PRESETS
@pytest.mark.parametrize("seed", range(3))
def test_renamed_parts_give_renamed_labels(parameters, seed):
    rng = np.random.default_rng(seed)
    mesh = folded_sheet()
    mesh = TriMesh(mesh.vertices + 0.05 * rng.standard_normal(mesh.vertices.shape), mesh.faces)  # no ties
    labels = np.where(rng.random(mesh.n_faces) < 0.1, rng.integers(-1, 4, mesh.n_faces), from_column(10) % 4)
    names = np.array([40, 10, 30, 20, -1])  # of parts 0 … 3, and of −1
    refiner = BoundaryRefiner.build(mesh)
    np.testing.assert_array_equal(refiner.refine(names[labels], parameters), names[refiner.refine(labels, parameters)])


@PRESETS
def test_within_twice_the_optimum_on_a_tiny_mesh(parameters):
    mesh = folded_sheet(2, 1)
    rng = np.random.default_rng(0)
    for _ in range(10):
        labels = rng.integers(-1, 3, mesh.n_faces)
        labels[0] = 0
        part_ids = np.unique(labels[labels >= 0])
        refiner = BoundaryRefiner.build(mesh)
        problem = refiner.problem(labels, part_ids, parameters)
        best = min(
            energy(problem, np.array(choice)) for choice in itertools.product(range(len(part_ids)), repeat=mesh.n_faces)
        )
        reached = energy(problem, np.searchsorted(part_ids, refiner.refine(labels, parameters)))
        assert reached <= 2 * best + 1e-9


def test_scale_and_place_do_not_matter():
    mesh = folded_sheet()
    labels = from_column(11)
    moved = TriMesh(mesh.vertices * 1e-3 + 5.0, mesh.faces)
    np.testing.assert_array_equal(refine_boundaries(moved, labels), refine_boundaries(mesh, labels))


@pytest.mark.parametrize("anchor", [None, np.full(1152, -1)])
def test_refuses_labels_without_any_part(anchor):
    with pytest.raises(LabelError, match="all are −1"):
        refine_boundaries(folded_sheet(), np.full(1152, -1), anchor=anchor)


@pytest.mark.parametrize("wrong", [np.zeros(7, dtype=np.int64), np.zeros(1152)])
def test_refuses_labels_of_another_mesh(wrong):
    with pytest.raises(LabelError, match="whole numbers"):
        refine_boundaries(folded_sheet(), wrong)


def test_refuses_an_anchor_of_another_mesh():
    with pytest.raises(LabelError, match="anchor must be"):
        refine_boundaries(folded_sheet(), from_column(12), anchor=np.zeros(7, dtype=np.int64))


def test_refuses_labels_below_unlabelled():
    with pytest.raises(LabelError, match="−1 where unlabelled"):
        refine_boundaries(folded_sheet(), np.full(1152, -2))


@pytest.mark.parametrize("wrong", [np.zeros(7), np.full(1152, np.nan)])
def test_refuses_shape_diameters_that_do_not_fit(wrong):
    with pytest.raises(ParameterError, match="shape diameters must be"):
        refine_boundaries(folded_sheet(), from_column(12), shape_diameter=wrong)


@pytest.mark.parametrize(
    ("name", "value"),
    [
        ("band", 0.0), ("band", np.inf), ("band", np.nan), ("angle_weight", -0.1), ("angle_weight", 1.1),
        ("least_move_cost", 1.5), ("least_move_cost", np.nan), ("smoothness", -1.0), ("angle_floor", 0.0),
        ("angle_floor", 1.0), ("max_sweeps", 0), ("flatness", np.nan), ("concave_gain", -1.0), ("convex_gain", np.inf),
        ("diameter_gain", -1.0), ("form", "flat"),
    ],
)  # fmt: skip
def test_refuses_parameters_out_of_range(name, value):
    with pytest.raises(ParameterError, match=name):
        BoundaryParameters(**{name: value})
