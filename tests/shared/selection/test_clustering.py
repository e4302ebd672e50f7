import numpy as np
import pytest

from partwise.errors import NotEnoughDataError, ParameterError
from partwise.selection.clustering import FirstShape, clustered, first_shapes, nearest_centres, typical_shapes

IDS = [f"shape-{k}" for k in range(60)]


def _rng() -> np.random.Generator:
    return np.random.default_rng(5)


def _three_blobs() -> tuple[np.ndarray, np.ndarray]:
    """60 points in blobs of 30, 20 and 10 that are far apart, and the blob of each."""
    blob_ids = np.repeat([0, 1, 2], [30, 20, 10])
    centres = np.array([[0.0, 0, 0], [100, 0, 0], [0, 100, 0]])
    return centres[blob_ids] + _rng().normal(size=(60, 3)), blob_ids


def test_each_blob_gives_its_most_central_shapes() -> None:
    points, blob_ids = _three_blobs()
    chosen = first_shapes(points, IDS, 3, 2, _rng())
    for blob_id in range(3):
        rows = np.flatnonzero(blob_ids == blob_id)
        distances = np.linalg.norm(points[rows] - points[rows].mean(axis=0), axis=1)
        nearest = np.argsort(distances)[:2]
        found = [shape for shape in chosen if shape.cluster == blob_id]  # clusters are numbered by size, as the blobs
        assert [shape.id for shape in found] == [IDS[row] for row in rows[nearest]]
        np.testing.assert_allclose([shape.distance for shape in found], distances[nearest])


def test_the_same_seed_gives_the_same_shapes() -> None:
    points = _rng().normal(size=(60, 4))
    assert first_shapes(points, IDS, 5, 3, _rng()) == first_shapes(points, IDS, 5, 3, _rng())


def test_small_clusters_are_filled_up_with_others_and_nobody_is_chosen_twice() -> None:
    points = np.concatenate([np.linspace(0, 1, 9), [50.0]])[:, None]
    chosen = first_shapes(points, IDS[:10], 2, 5, _rng())
    assert sorted(shape.id for shape in chosen) == sorted(IDS[:10])
    alone, *filling = [shape for shape in chosen if shape.cluster == 1]
    assert alone == FirstShape("shape-9", 1, 0.0)
    assert [shape.distance for shape in filling] == sorted(shape.distance for shape in filling)


def test_all_shapes_can_be_asked_for_one_by_one() -> None:
    points = _rng().normal(size=(6, 2))
    chosen = first_shapes(points, IDS[:6], 6, 1, _rng())
    assert {shape.id for shape in chosen} == set(IDS[:6])
    np.testing.assert_allclose([shape.distance for shape in chosen], 0.0, atol=1e-12)


def test_typical_shapes_come_one_from_each_blob() -> None:
    points, blob_ids = _three_blobs()
    chosen = typical_shapes(points, IDS, 3, _rng())
    assert [blob_ids[IDS.index(shape.id)] for shape in chosen] == [0, 1, 2]


def test_typical_shapes_lie_where_a_cluster_is_dense() -> None:
    dense, sparse = 0.01 * _rng().normal(size=(25, 2)), np.array([[4.0, 0.0], [8.0, 0.0], [12.0, 0.0], [5.9, 0.0]])
    (chosen,) = typical_shapes(np.concatenate([dense, sparse]), IDS[:29], 1, _rng())
    assert IDS.index(chosen.id) < 25


def test_a_lone_shape_is_typical_of_itself() -> None:
    points = np.array([[0.0], [0.1], [0.2], [90.0]])
    assert typical_shapes(points, IDS[:4], 2, _rng())[1] == FirstShape("shape-3", 1, 0.0)


def test_points_of_a_clustering_are_nearest_to_their_own_centres() -> None:
    points, _ = _three_blobs()
    clustering = clustered(points, 3, _rng())
    np.testing.assert_array_equal(nearest_centres(points, clustering.centres), clustering.cluster_ids)


@pytest.mark.parametrize(
    ("points", "ids", "counts", "message"),
    [
        (np.zeros((4, 2)), IDS[:4], (0, 1), "at least 1 but are 0 and 1"),
        (np.zeros((4, 2)), IDS[:4], (1, 0), "at least 1 but are 1 and 0"),
        (np.zeros((4, 2)), IDS[:3], (1, 1), r"\(4, 2\) for 3 ids"),
        (np.zeros(4), IDS[:4], (1, 1), r"\(4,\) for 4 ids"),
        (np.zeros((4, 0)), IDS[:4], (1, 1), r"\(4, 0\) for 4 ids"),
        (np.zeros((3, 2)), ["a", "b", "a"], (1, 1), "'a' is there twice"),
        (np.array([[0.0], [np.nan]]), ["a", "b"], (1, 1), "those of 'b' are not"),
    ],
)
def test_wrong_input_is_refused(points: np.ndarray, ids: list[str], counts: tuple[int, int], message: str) -> None:
    with pytest.raises(ParameterError, match=message):
        first_shapes(points, ids, *counts, _rng())


def test_more_shapes_than_there_are_is_an_error() -> None:
    with pytest.raises(NotEnoughDataError, match=r"3 clusters × 2 shapes are 6 but there are only 5"):
        first_shapes(np.zeros((5, 2)), IDS[:5], 3, 2, _rng())


@pytest.mark.filterwarnings("ignore::sklearn.exceptions.ConvergenceWarning")
def test_more_clusters_than_different_shapes_is_an_error() -> None:
    with pytest.raises(NotEnoughDataError, match="only 2 differ"):
        first_shapes(np.array([[0.0], [0], [0], [1], [1]]), IDS[:5], 3, 1, _rng())
