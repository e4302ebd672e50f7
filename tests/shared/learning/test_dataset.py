"""Pools hold labelled faces only, sampled uniformly, and batches visit all of them alike."""

from collections.abc import Iterator

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from partwise.errors import LabelError, NotEnoughDataError, ParameterError
from partwise.learning.dataset import CodedGrids, FacePool, LabelledFaces, batch_rows, classes_of


def _faces(numbers: np.ndarray, classes: np.ndarray, branch: str = "shape_context") -> LabelledFaces:
    """Faces whose scale is their number, so that they can be told apart afterwards."""
    return LabelledFaces(
        {branch: CodedGrids(np.zeros((len(numbers), 256), np.uint8), numbers.astype(np.float32))},
        classes.astype(np.int64),
    )


def _shapes(sizes: list[int]) -> Iterator[LabelledFaces]:
    start = 0
    for size in sizes:
        numbers = np.arange(start, start + size)
        yield _faces(numbers, numbers % 2)
        start += size


def _numbers(pool: FacePool) -> list[int]:
    return pool.grids["shape_context"].scale.astype(int).tolist()


def test_below_capacity_every_face_is_kept() -> None:
    pool = FacePool.from_shapes(_shapes([3, 0, 4]), (1, 2), capacity=7, rng=np.random.default_rng(0))
    assert _numbers(pool) == list(range(7))


@settings(max_examples=30)
@given(st.lists(st.integers(1, 9), min_size=1, max_size=6), st.integers(1, 20), st.integers(0, 99))
def test_faces_are_kept_at_most_once_with_their_own_label(sizes: list[int], capacity: int, seed: int) -> None:
    pool = FacePool.from_shapes(_shapes(sizes), (1, 2), capacity, np.random.default_rng(seed))
    numbers = _numbers(pool)
    assert len(set(numbers)) == len(numbers) == min(capacity, sum(sizes))
    assert pool.classes.tolist() == [number % 2 for number in numbers]


def test_above_capacity_every_face_is_kept_equally_often() -> None:
    counts = np.zeros(40)
    for seed in range(600):
        pool = FacePool.from_shapes(_shapes([7, 3, 18, 12]), (1, 2), 10, np.random.default_rng(seed))
        counts[_numbers(pool)] += 1
    # Each count is binomial(600, 1/4): mean 150, standard deviation 10.6; 5 of them are allowed.
    assert np.abs(counts - 150).max() < 53


def test_unlabelled_faces_are_left_out() -> None:
    shape = _faces(np.arange(6), np.array([0, -1, 1, -1, -1, 0]))
    assert _numbers(FacePool.from_shapes([shape], (1, 2), 100, np.random.default_rng(0))) == [0, 2, 5]


def test_only_unlabelled_faces_are_refused() -> None:
    shape = _faces(np.arange(2), np.array([-1, -1]))
    with pytest.raises(NotEnoughDataError, match="confirm some shapes"):
        FacePool.from_shapes([shape], (1, 2), 100, np.random.default_rng(0))


def test_no_shapes_are_refused() -> None:
    with pytest.raises(NotEnoughDataError, match="confirm some shapes"):
        FacePool.from_shapes([], (1, 2), 100, np.random.default_rng(0))


def test_a_capacity_of_none_is_refused() -> None:
    with pytest.raises(ParameterError, match="capacity"):
        FacePool.from_shapes([], (1, 2), 0, np.random.default_rng(0))


def test_shapes_with_other_branches_are_refused() -> None:
    shapes = [_faces(np.arange(2), np.zeros(2)), _faces(np.arange(2), np.zeros(2), branch="spin_image")]
    with pytest.raises(LabelError, match="same columns"):
        FacePool.from_shapes(shapes, (1, 2), 100, np.random.default_rng(0))


@pytest.mark.parametrize("bad", [-2, 2])
def test_classes_without_a_part_are_refused(bad: int) -> None:
    with pytest.raises(LabelError, match=f"contain {bad}"):
        FacePool.from_shapes([_faces(np.arange(2), np.array([0, bad]))], (1, 2), 100, np.random.default_rng(0))


def test_a_label_per_face_is_required() -> None:
    with pytest.raises(LabelError, match="same mesh"):
        _faces(np.arange(3), np.zeros(2))


def test_a_pool_refuses_an_empty_one() -> None:
    with pytest.raises(NotEnoughDataError, match="confirm some shapes"):
        FacePool({}, np.empty(0, np.int64), (1, 2))


def test_a_pool_refuses_repeated_parts() -> None:
    with pytest.raises(LabelError, match="listed twice"):
        FacePool({}, np.zeros(1, np.int64), (1, 1))


def test_a_pool_refuses_branches_of_other_lengths() -> None:
    grids = CodedGrids(np.zeros((2, 256), np.uint8), np.float32(1))
    with pytest.raises(LabelError, match="3 faces"):
        FacePool({"spin_image": grids}, np.zeros(3, np.int64), (1, 2))


def test_a_pool_refuses_narrow_classes() -> None:
    with pytest.raises(LabelError, match="int64"):
        FacePool({}, np.zeros(1, np.int32), (1, 2))


@pytest.mark.parametrize(
    ("codes", "scale", "message"),
    [
        (np.zeros((2, 256), np.float32), 1.0, "uint8"),
        (np.zeros((2, 16, 16), np.uint8), 1.0, "uint8"),
        (np.zeros((2, 255), np.uint8), 1.0, "uint8"),
        (np.zeros((2, 256), np.uint8), np.ones(3), "one per face"),
        (np.zeros((2, 256), np.uint8), np.nan, "finite"),
        (np.zeros((2, 256), np.uint8), -1.0, "at least 0"),
    ],
)
def test_grids_of_the_wrong_form_are_refused(codes: np.ndarray, scale: float, message: str) -> None:
    with pytest.raises(ParameterError, match=message):
        CodedGrids(codes, scale)


def test_one_scale_stands_for_all_faces() -> None:
    assert CodedGrids(np.zeros((3, 256), np.uint8), np.float32(0.5)).scale.tolist() == [0.5, 0.5, 0.5]


def test_taking_rows_takes_codes_and_scales() -> None:
    grids = CodedGrids(np.arange(3, dtype=np.uint8)[:, None].repeat(256, 1), np.arange(3, dtype=np.float32))
    taken = grids.take(np.array([2, 0]))
    assert taken.codes[:, 0].tolist() == taken.scale.tolist() == [2, 0]


def test_labels_become_positions_among_the_parts() -> None:
    assert classes_of(np.array([0, 7, 2, 7], np.uint16), (7, 2)).tolist() == [-1, 0, 1, 0]


@pytest.mark.parametrize("stranger", [3, 9])
def test_labels_of_other_parts_are_refused(stranger: int) -> None:
    with pytest.raises(LabelError, match=f"contain {stranger}"):
        classes_of(np.array([0, stranger], np.uint16), (7, 2))


def test_each_pass_visits_every_face_once() -> None:
    batches = batch_rows(10, 4, np.random.default_rng(0))
    rows = np.concatenate([next(batches) for _ in range(5)])
    assert sorted(rows[:10]) == sorted(rows[10:]) == list(range(10))


def test_passes_have_different_orders() -> None:
    batches = batch_rows(10, 10, np.random.default_rng(0))
    assert next(batches).tolist() != next(batches).tolist()


def test_a_batch_is_full_even_if_there_are_fewer_faces() -> None:
    assert len(next(batch_rows(3, 8, np.random.default_rng(0)))) == 8
