"""Model refinement: costs with known values, behaviour on shapes whose parts are obvious, ugly meshes."""

import os
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra import numpy as arrays

from partwise.errors import LabelError, NotEnoughDataError, ParameterError
from partwise.exchange.labels_psb import read_psb_labels
from partwise.geometry.adjacency import edge_adjacency
from partwise.geometry.faces import face_areas
from partwise.io.read import read_mesh
from partwise.mesh import TriMesh
from partwise.segmentation.model_refinement import (
    RefinementProblem,
    boundary_costs,
    data_costs,
    refine,
    tune_smoothness,
)
from partwise.segmentation.parameters import RefinementParameters

DATA = os.environ.get("PARTWISE_DATA")
DEFAULTS = RefinementParameters()


def folded_pair(height):
    """Two triangles over a unit edge along y; the outer corner of the second rises by `height`: concave if > 0."""
    vertices = np.array([[0.0, 0, 0], [0, 1, 0], [-1, 0, 0], [1, 0, height]])
    return TriMesh(vertices, np.array([[0, 1, 2], [1, 0, 3]]))


def strip(n, lift=0.0):
    """A flat ribbon of 2n faces along x; past the middle it rises with slope `lift`."""
    x = np.arange(n + 1, dtype=float)
    z = lift * np.maximum(x - n / 2, 0)
    vertices = np.stack([np.stack([x, np.full(n + 1, y), z], axis=1) for y in (0.0, 1.0)], axis=1).reshape(-1, 3)
    k = 2 * np.arange(n)
    faces = np.stack([np.stack([k, k + 2, k + 1], 1), np.stack([k + 1, k + 2, k + 3], 1)], axis=1).reshape(-1, 3)
    return TriMesh(vertices, faces)


@st.composite
def ugly_meshes(draw):
    """Several components, degenerate and duplicate faces, edges without length, edges of many faces."""
    n, m = draw(st.integers(1, 8)), draw(st.integers(1, 16))
    vertices = draw(arrays.arrays(np.float64, (n, 3), elements=st.sampled_from([0.0, 1.0, -1.0, 0.5])))
    faces = draw(arrays.arrays(np.int64, (m, 3), elements=st.integers(0, n - 1)))
    weights = draw(arrays.arrays(np.float64, (m, 3), elements=st.floats(0.01, 1)))
    return TriMesh(vertices, faces), weights / weights.sum(axis=1, keepdims=True)


@pytest.mark.parametrize(("height", "factor"), [(1.0, 1.0), (-1.0, 0.08)])
def test_a_45_degree_edge_costs_by_its_side(height, factor):
    mesh = folded_pair(height)
    cost = boundary_costs(mesh, edge_adjacency(mesh), DEFAULTS)
    assert cost == pytest.approx([-np.log(factor / 4)])


def test_a_flat_edge_costs_the_floor():
    mesh = folded_pair(0.0)
    assert boundary_costs(mesh, edge_adjacency(mesh), DEFAULTS) == pytest.approx([-np.log(1e-3)])


def test_boundary_costs_do_not_depend_on_scale():
    mesh = strip(6, lift=0.7)
    scaled = TriMesh(mesh.vertices * 1000, mesh.faces)
    costs = [boundary_costs(m, edge_adjacency(m), DEFAULTS) for m in (mesh, scaled)]
    np.testing.assert_allclose(*costs)


def test_boundary_costs_are_in_proportion_to_edge_length():
    mesh = strip(4)
    adjacency = edge_adjacency(mesh)
    cost = boundary_costs(mesh, adjacency, DEFAULTS)
    np.testing.assert_allclose(cost / adjacency.lengths, cost[0] / adjacency.lengths[0])


def test_data_costs_by_area():
    probabilities = np.array([[1.0, 0.0], [0.5, 0.5]])
    cost = data_costs(probabilities, np.array([3.0, 1.0]), DEFAULTS)
    np.testing.assert_allclose(cost, [[0, -np.log(1e-6) * 1.5], [np.log(2) * 0.5] * 2], atol=1e-15)


def test_data_costs_unweighted():
    cost = data_costs(
        np.array([[0.5, 0.5], [0.5, 0.5]]), np.array([3.0, 1.0]), RefinementParameters(weight_by_area=False)
    )
    np.testing.assert_allclose(cost, np.log(2))


def test_probability_just_over_one_costs_nothing():
    assert data_costs(np.array([[1.0005]]), np.ones(1), DEFAULTS) == 0.0


def test_without_smoothness_the_first_choice_stands():
    mesh = strip(20, lift=0.5)
    probabilities = np.random.default_rng(0).dirichlet(np.ones(4), mesh.n_faces)
    labels = refine(mesh, probabilities, RefinementParameters(smoothness=0.0))
    np.testing.assert_array_equal(labels, np.argmax(probabilities, axis=1))


def test_a_lone_dissenter_is_overruled():
    mesh = strip(10)
    probabilities = np.tile([0.8, 0.2], (mesh.n_faces, 1))
    probabilities[7] = [0.3, 0.7]
    np.testing.assert_array_equal(refine(mesh, probabilities), np.zeros(mesh.n_faces))


def test_the_boundary_moves_to_the_concave_crease():
    mesh = strip(20, lift=1.0)
    truth = (np.arange(mesh.n_faces) >= mesh.n_faces // 2).astype(np.int64)
    probabilities = np.where(truth[:, None] == [0, 1], 0.9, 0.1)
    unsure = slice(mesh.n_faces // 2 - 5, mesh.n_faces // 2)
    probabilities[unsure] = [0.45, 0.55]
    np.testing.assert_array_equal(refine(mesh, probabilities), truth)


def test_more_smoothness_never_lengthens_the_boundary():
    mesh = strip(40, lift=0.5)
    problem = RefinementProblem.build(mesh, np.random.default_rng(1).dirichlet(np.ones(2), mesh.n_faces))
    base = problem.at_unit_smoothness
    lengths = []
    for smoothness in (0.0, 0.05, 0.2, 1.0, 5.0, 100.0):
        labels = problem.solve(smoothness)
        lengths.append(base.weights[labels[base.edges[:, 0]] != labels[base.edges[:, 1]]].sum())
    assert lengths == sorted(lengths, reverse=True)
    assert lengths[-1] == 0


def test_components_do_not_see_each_other():
    mesh = strip(8, lift=0.4)
    both = TriMesh(
        np.concatenate([mesh.vertices, mesh.vertices + 100]), np.concatenate([mesh.faces, mesh.faces + mesh.n_vertices])
    )
    probabilities = np.random.default_rng(2).dirichlet(np.ones(3), both.n_faces)
    together = refine(both, probabilities)
    apart = [refine(mesh, half) for half in np.split(probabilities, 2)]
    np.testing.assert_array_equal(together, np.concatenate(apart))


@given(ugly_meshes())
@settings(max_examples=100, deadline=None)
def test_ugly_meshes_have_finite_costs_and_labels(mesh_and_probabilities):
    mesh, probabilities = mesh_and_probabilities
    problem = RefinementProblem.build(mesh, probabilities)
    np.testing.assert_array_equal(problem.solve(0.0), np.argmax(probabilities, axis=1))
    assert set(problem.solve(1.0)) <= {0, 1, 2}


def test_a_mesh_without_area_counts_its_faces_alike():
    mesh = TriMesh(np.zeros((3, 3)), np.array([[0, 1, 2], [0, 2, 1]]))
    np.testing.assert_array_equal(refine(mesh, np.array([[0.9, 0.1], [0.2, 0.8]])), [0, 1])


def test_float16_probabilities_are_taken():
    mesh = strip(4)
    probabilities = np.random.default_rng(3).dirichlet(np.ones(3), mesh.n_faces).astype(np.float16)
    assert refine(mesh, probabilities).shape == (mesh.n_faces,)


@pytest.mark.parametrize(
    ("probabilities", "message"),
    [
        (np.ones((3, 2)), r"must be \(4, L\)"),
        (np.ones((4, 0)), r"must be \(4, L\)"),
        (np.full((4, 2), -0.1), "span -0.1"),
        (np.full((4, 2), 1.5), "to 1.5"),
        (np.full((4, 2), np.nan), "nan"),
    ],
)
def test_refuses_probabilities(probabilities, message):
    with pytest.raises(LabelError, match=message):
        refine(strip(2), probabilities)


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"smoothness": -0.1}, "smoothness"),
        ({"smoothness": np.inf}, "smoothness"),
        ({"smoothness": np.nan}, "smoothness"),
        ({"convex_factor": 0.0}, "convex_factor"),
        ({"convex_factor": 1.1}, "convex_factor"),
        ({"probability_floor": 0.0}, "probability_floor"),
        ({"probability_floor": 1.0}, "probability_floor"),
        ({"angle_floor": 0.0}, "angle_floor"),
        ({"max_sweeps": 0}, "max_sweeps"),
    ],
)
def test_refuses_parameters(changes, message):
    with pytest.raises(ParameterError, match=message):
        RefinementParameters(**changes)


def test_solving_refuses_negative_smoothness():
    with pytest.raises(ParameterError, match="smoothness"):
        RefinementProblem.build(strip(2), np.full((4, 2), 0.5)).solve(-1.0)


def noisy_strip(seed):
    mesh = strip(40, lift=1.0)
    truth = (np.arange(mesh.n_faces) >= mesh.n_faces // 2).astype(np.int64)
    share = np.clip(np.where(truth, 0.65, 0.35) + np.random.default_rng(seed).normal(0, 0.25, mesh.n_faces), 0.01, 0.99)
    return RefinementProblem.build(mesh, np.stack([1 - share, share], axis=1)), truth, face_areas(mesh)


def test_tuning_takes_the_best_candidate():
    problems, truths, areas = zip(*(noisy_strip(seed) for seed in range(3)), strict=True)
    choice = tune_smoothness(problems, truths, areas, candidates=(1.0, 0.0, 0.3))
    assert choice.candidates == (0.0, 0.3, 1.0)
    assert choice.smoothness > 0
    assert max(choice.accuracy_by_area) == choice.accuracy_by_area[choice.candidates.index(choice.smoothness)]


def test_tuning_reports_accuracy_over_labelled_area():
    problem, truth, areas = noisy_strip(0)
    truth = np.where(problem.first_choice == truth, truth, -1)
    assert tune_smoothness([problem], [truth], [areas], candidates=(0.0,)).accuracy_by_area == (1.0,)


def test_tuning_takes_the_smallest_of_equals():
    mesh = strip(3)
    problem = RefinementProblem.build(mesh, np.tile([1.0, 0.0], (6, 1)))
    choice = tune_smoothness([problem], [np.zeros(6, dtype=np.int64)], [np.ones(6)], candidates=(5.0, 0.5, 1.0))
    assert choice.smoothness == 0.5


@pytest.mark.parametrize(
    ("n_shapes", "truth", "areas", "candidates", "error", "message"),
    [
        (0, [], [], (1.0,), NotEnoughDataError, "has 0 and 1"),
        (1, [np.zeros(4, dtype=int)], [np.ones(4)], (), NotEnoughDataError, "has 1 and 0"),
        (1, [], [np.ones(4)], (1.0,), LabelError, "labels and areas"),
        (1, [np.zeros(4, dtype=int)], [], (1.0,), LabelError, "labels and areas"),
        (1, [np.zeros(3, dtype=int)], [np.ones(4)], (1.0,), LabelError, "one value a face"),
        (1, [np.zeros(4, dtype=int)], [np.ones(5)], (1.0,), LabelError, "one value a face"),
        (1, [np.full(4, -1)], [np.ones(4)], (1.0,), NotEnoughDataError, "true label and area"),
    ],
)
def test_tuning_refuses(n_shapes, truth, areas, candidates, error, message):
    problem = RefinementProblem.build(strip(2), np.full((4, 2), 0.5))
    with pytest.raises(error, match=message):
        tune_smoothness([problem] * n_shapes, truth, areas, candidates)


@pytest.mark.skipif(not DATA, reason="PARTWISE_DATA is not set: no real meshes at hand")
def test_noise_on_a_real_shape_is_mended():
    path = Path(DATA) / "lpsb" / "Airplane" / "61.off"
    mesh = read_mesh(path)
    labels = read_psb_labels(path.with_name("61_labels.txt"), mesh.n_faces)
    logits = 2.5 * np.eye(len(labels.part_names))[labels.indices]
    noisy = np.exp(logits + np.random.default_rng(0).normal(0, 2, logits.shape))
    probabilities = noisy / noisy.sum(axis=1, keepdims=True)
    wrong_before = (np.argmax(probabilities, axis=1) != labels.indices).mean()
    wrong_after = (refine(mesh, probabilities) != labels.indices).mean()
    assert wrong_after < 0.1 * wrong_before
