import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from partwise.errors import ParameterError
from partwise.selection.acquisition import (
    face_bald,
    face_entropy,
    face_variation_ratio,
    mean_bald,
    mean_bald_by_area,
    mean_entropy,
    mean_entropy_by_area,
    mean_variation_ratio,
    mean_variation_ratio_by_area,
)

SURE_AND_UNSURE = np.array([[1.0, 0.0], [0.5, 0.5]])
SEEDS = st.integers(0, 2**32 - 1)


def _snapshots(seed: int) -> np.ndarray:
    """(s, m, c) random distributions, some of them with zeros."""
    rng = np.random.default_rng(seed)
    shape = (int(rng.integers(1, 6)), int(rng.integers(1, 20)), int(rng.integers(1, 6)))
    weights = rng.gamma(0.3, size=shape) * (rng.random(shape) < 0.8)
    weights[..., 0] += 1e-3
    return weights / weights.sum(axis=2, keepdims=True)


def test_entropy_is_zero_where_sure_and_log_c_where_uniform() -> None:
    np.testing.assert_allclose(face_entropy(SURE_AND_UNSURE), [0.0, np.log(2)])
    assert mean_entropy(np.full((7, 5), 0.2)) == pytest.approx(np.log(5))


def test_mean_entropy_is_the_mean_over_faces() -> None:
    assert mean_entropy(SURE_AND_UNSURE) == pytest.approx(np.log(2) / 2)


def test_area_weights_move_the_mean() -> None:
    assert mean_entropy_by_area(SURE_AND_UNSURE, np.array([3.0, 1.0])) == pytest.approx(np.log(2) / 4)


def test_float16_rounding_hardly_moves_entropy() -> None:
    probabilities = np.random.default_rng(0).dirichlet(np.full(8, 0.2), size=500)
    assert mean_entropy(probabilities.astype(np.float16)) == pytest.approx(mean_entropy(probabilities), rel=1e-3)


@settings(max_examples=30, deadline=None)
@given(SEEDS)
def test_entropy_lies_between_zero_and_log_c(seed: int) -> None:
    probabilities = _snapshots(seed)[0]
    entropies = face_entropy(probabilities)
    assert (entropies >= 0).all()
    assert (entropies <= np.log(probabilities.shape[1]) + 1e-12).all()


@settings(max_examples=30, deadline=None)
@given(SEEDS)
def test_equal_areas_change_nothing(seed: int) -> None:
    snapshots = _snapshots(seed)
    areas = np.full(snapshots.shape[1], 0.7)
    assert mean_entropy_by_area(snapshots[0], areas) == pytest.approx(mean_entropy(snapshots[0]))
    assert mean_bald_by_area(snapshots, areas) == pytest.approx(mean_bald(snapshots), abs=1e-12)
    assert mean_variation_ratio_by_area(snapshots, areas) == pytest.approx(mean_variation_ratio(snapshots))


@settings(max_examples=30, deadline=None)
@given(SEEDS)
def test_the_order_of_classes_and_snapshots_does_not_matter_to_bald(seed: int) -> None:
    snapshots = _snapshots(seed)
    np.testing.assert_allclose(face_bald(snapshots[::-1, :, ::-1]), face_bald(snapshots), atol=1e-12)


def test_bald_is_zero_where_models_agree_and_log_s_where_they_contradict() -> None:
    agreeing_but_unsure = [[0.5, 0.5], [0.5, 0.5]]
    contradicting = [[1.0, 0.0], [0.0, 1.0]]
    snapshots = np.array([agreeing_but_unsure, contradicting]).transpose(1, 0, 2)
    np.testing.assert_allclose(face_bald(snapshots), [0.0, np.log(2)], atol=1e-12)


@settings(max_examples=30, deadline=None)
@given(SEEDS)
def test_bald_is_at_most_the_entropy_of_the_mean(seed: int) -> None:
    snapshots = _snapshots(seed)
    information = face_bald(snapshots)
    assert (information >= 0).all()
    assert (information <= face_entropy(snapshots.mean(axis=0)) + 1e-12).all()
    assert (information <= np.log(len(snapshots)) + 1e-12).all()


def test_variation_ratio_is_the_share_of_dissenting_votes() -> None:
    votes = np.array([[0, 0, 0], [0, 0, 1], [0, 0, 2], [0, 1, 2]])  # snapshots × faces
    snapshots = np.eye(3)[votes]
    np.testing.assert_allclose(face_variation_ratio(snapshots), [0.0, 0.25, 0.5])
    assert mean_variation_ratio(snapshots) == pytest.approx(0.25)


@pytest.mark.parametrize(
    ("probabilities", "message"),
    [
        (np.ones(3), r"\(faces, classes\)"),
        (np.ones((0, 3)), "empty"),
        (np.ones((3, 0)), "empty"),
        (np.array([[1.5, -0.5]]), "≥ 0 but contain -0.5"),
        (np.array([[np.nan, 1.0]]), "≥ 0 but contain nan"),
        (np.array([[np.inf, 1.0]]), "sums to inf"),
        (np.array([[1.0, 0.0], [0.5, 0.4]]), "sums to 0.9"),
    ],
)
def test_what_is_not_a_distribution_is_refused(probabilities: np.ndarray, message: str) -> None:
    with pytest.raises(ParameterError, match=message):
        mean_entropy(probabilities)


@pytest.mark.parametrize("score", [face_bald, face_variation_ratio])
def test_one_model_without_its_axis_is_refused(score: object) -> None:
    with pytest.raises(ParameterError, match="stack the models"):
        score(SURE_AND_UNSURE)  # type: ignore[operator]


@pytest.mark.parametrize(
    ("areas", "message"),
    [
        (np.ones(3), "one area a face"),
        (np.array([1.0, -1.0]), "range from -1.0 to 1.0"),
        (np.array([1.0, np.nan]), "finite"),
        (np.zeros(2), "not all 0"),
    ],
)
def test_wrong_areas_are_refused(areas: np.ndarray, message: str) -> None:
    with pytest.raises(ParameterError, match=message):
        mean_entropy_by_area(SURE_AND_UNSURE, areas)
