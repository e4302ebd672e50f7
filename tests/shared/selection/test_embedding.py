from collections.abc import Iterator

import numpy as np
import pytest
from sklearn.decomposition import PCA

from partwise.errors import NotEnoughDataError, ParameterError
from partwise.selection.embedding import Embedding, fit_embedding, sample_rows


def _rng(seed: int = 0) -> np.random.Generator:
    return np.random.default_rng(seed)


def _descriptors(n: int, length: int = 300, rank: int = 12) -> np.ndarray:
    """Bytes that vary along a few directions of falling weight, and a little along all."""
    rng = _rng(1)
    factors = rng.normal(size=(n, rank)) * np.geomspace(40, 4, rank)
    values = 120 + factors @ rng.normal(size=(rank, length)) / np.sqrt(rank) + rng.normal(size=(n, length))
    return values.clip(0, 255).astype(np.uint8)


def _batches(descriptors: np.ndarray, size: int = 7) -> Iterator[np.ndarray]:
    return (descriptors[start : start + size] for start in range(0, len(descriptors), size))


def test_few_shapes_are_embedded_exactly() -> None:
    descriptors = _descriptors(30)
    embedding = fit_embedding(_batches(descriptors), _rng())
    oracle = PCA(29, svd_solver="full").fit(descriptors.astype(np.float64))
    assert embedding.components.shape == (29, 300)
    np.testing.assert_allclose(embedding.mean, oracle.mean_, rtol=1e-6)
    np.testing.assert_allclose(embedding.explained_variance_ratio, oracle.explained_variance_ratio_, rtol=1e-3)
    np.testing.assert_allclose(np.abs((embedding.components * oracle.components_).sum(axis=1)), 1.0, atol=1e-4)


def test_many_shapes_are_embedded_closely_by_random_directions() -> None:
    descriptors = _descriptors(400)
    embedding = fit_embedding(_batches(descriptors), _rng(), max_dimensions=10)
    oracle = PCA(10, svd_solver="full").fit(descriptors.astype(np.float64))
    np.testing.assert_allclose(embedding.explained_variance_ratio, oracle.explained_variance_ratio_, rtol=1e-3)
    np.testing.assert_allclose(np.abs((embedding.components * oracle.components_).sum(axis=1)), 1.0, atol=1e-3)


def test_a_full_embedding_keeps_distances() -> None:
    descriptors = _descriptors(20)
    points = fit_embedding(_batches(descriptors), _rng()).project(descriptors)
    values = descriptors.astype(np.float64)
    expected = np.linalg.norm(values[:, None] - values[None], axis=2)
    np.testing.assert_allclose(np.linalg.norm(points[:, None] - points[None], axis=2), expected, rtol=1e-4, atol=1e-3)


def test_components_are_orthonormal_with_positive_largest_entries() -> None:
    components = fit_embedding(_batches(_descriptors(200)), _rng(), max_dimensions=12).components
    np.testing.assert_allclose(components @ components.T, np.eye(12), atol=1e-5)
    assert (components[np.arange(12), np.abs(components).argmax(axis=1)] > 0).all()


def test_neither_batch_size_nor_seed_changes_an_exact_fit_and_its_signs() -> None:
    descriptors = _descriptors(25)
    first = fit_embedding(_batches(descriptors, size=1), _rng(0)).project(descriptors)
    second = fit_embedding(_batches(descriptors, size=25), _rng(99)).project(descriptors)
    np.testing.assert_allclose(first, second, atol=0.05)  # coordinates are of the order of 100


def test_the_same_seed_gives_the_same_arrays() -> None:
    first, second = (fit_embedding(_batches(_descriptors(300)), _rng(4), max_sample=250) for _ in range(2))
    for name, values in first.to_arrays().items():
        np.testing.assert_array_equal(values, second.to_arrays()[name])


def test_new_shapes_are_projected_without_refitting() -> None:
    descriptors = _descriptors(50)
    embedding = fit_embedding(_batches(descriptors[:40]), _rng(), max_dimensions=8)
    points = embedding.project(descriptors[40:])
    assert points.dtype == np.float32
    expected = (descriptors[40:].astype(np.float64) - embedding.mean) @ embedding.components.T.astype(np.float64)
    np.testing.assert_allclose(points, expected, atol=1e-2)


def test_the_mean_is_projected_to_the_origin() -> None:
    descriptors = np.array([[0, 10, 200], [100, 30, 100]], dtype=np.uint8)
    embedding = fit_embedding([descriptors], _rng())
    np.testing.assert_allclose(embedding.project(np.array([[50, 20, 150]], dtype=np.uint8)), [[0.0]], atol=1e-4)


def test_dimensions_that_do_not_vary_are_left_out() -> None:
    line = np.arange(10, dtype=np.uint8)[:, None] * np.array([[1, 2, 3]], dtype=np.uint8)
    assert fit_embedding([line], _rng()).n_dimensions == 1


def test_only_a_sample_is_fitted_where_there_are_more() -> None:
    """Rows encode their position, so the mean tells whether the sample is uniform over the stream."""
    stream = (np.full((100, 4), k, dtype=np.uint8) + np.eye(100, 4, dtype=np.uint8) for k in range(250))
    embedding = fit_embedding(stream, _rng(), max_dimensions=3, max_sample=2000)
    assert embedding.mean[3] == pytest.approx(124.5, abs=6.0)  # 3.7 standard errors


def test_sample_rows_are_distinct_sorted_and_all_where_they_fit() -> None:
    np.testing.assert_array_equal(sample_rows(5, _rng(), 10), np.arange(5))
    rows = sample_rows(1000, _rng(), 10)
    assert len(rows) == 10
    assert (np.diff(rows) > 0).all()


def test_arrays_round_trip() -> None:
    embedding = fit_embedding(_batches(_descriptors(12)), _rng())
    copy = Embedding.from_arrays(embedding.to_arrays())
    np.testing.assert_array_equal(copy.project(_descriptors(3)), embedding.project(_descriptors(3)))


def test_a_missing_array_is_named() -> None:
    with pytest.raises(ParameterError, match="'components'"):
        Embedding.from_arrays({"mean": np.zeros(3), "explained_variance_ratio": np.zeros(1)})


def test_arrays_that_do_not_fit_are_refused() -> None:
    with pytest.raises(ParameterError, match=r"\(2, 3\) but are \(2, 4\)"):
        Embedding(np.zeros(3), np.zeros((2, 4)), np.zeros(2))


def test_values_that_are_not_finite_are_refused() -> None:
    with pytest.raises(ParameterError, match="its mean is not"):
        Embedding(np.array([np.nan]), np.zeros((1, 1)), np.zeros(1))


def test_descriptors_of_another_length_cannot_be_projected() -> None:
    embedding = fit_embedding(_batches(_descriptors(12)), _rng())
    with pytest.raises(ParameterError, match=r"\(shapes, 300\) but are \(2, 299\)"):
        embedding.project(np.zeros((2, 299), dtype=np.uint8))


@pytest.mark.parametrize(
    "batches",
    [
        [np.zeros((2, 3), dtype=np.uint8), np.zeros((2, 4), dtype=np.uint8)],
        [np.zeros((2, 3))],
        [np.zeros(3, dtype=np.uint8)],
    ],
)
def test_batches_of_another_form_are_refused(batches: list[np.ndarray]) -> None:
    with pytest.raises(ParameterError, match="but a batch is"):
        fit_embedding(batches, _rng())


@pytest.mark.parametrize("limits", [(0, 10), (1, 1)])
def test_limits_out_of_range_are_refused(limits: tuple[int, int]) -> None:
    with pytest.raises(ParameterError, match="max_dimensions ≥ 1"):
        fit_embedding(_batches(_descriptors(5)), _rng(), *limits)


@pytest.mark.parametrize("batches", [[], [np.zeros((1, 3), dtype=np.uint8)]])
def test_fewer_than_two_shapes_are_not_enough(batches: list[np.ndarray]) -> None:
    with pytest.raises(NotEnoughDataError, match="2 shapes or more"):
        fit_embedding(batches, _rng())


def test_equal_shapes_have_no_embedding() -> None:
    with pytest.raises(NotEnoughDataError, match="all 6 are equal"):
        fit_embedding([np.full((6, 10), 77, dtype=np.uint8)], _rng())
