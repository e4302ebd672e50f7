"""ShapeNetPart points: read, written, sampled."""

import numpy as np
import pytest

from partwise.errors import DegenerateMeshError, FileFormatError, LabelError, ParameterError
from partwise.exchange import labelled_points
from partwise.exchange.labelled_mesh import LabelledMesh
from partwise.exchange.labelled_points import (
    LabelledPoints,
    read_point_pair,
    read_points,
    sample_labelled_points,
    write_points,
)
from partwise.io.limits import ReadLimits
from partwise.mesh import TriMesh

# Two triangles in the plane z = 0, of area 0.5 and 1, and one without area.
MESH = TriMesh(np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [3.0, 0, 0]]), np.array([[0, 1, 2], [2, 3, 1], [0, 1, 1]]))
LABELLED = LabelledMesh(MESH, np.array([4, -1, 9]))


def sample(n_points=2_000, seed=3, **options):
    return sample_labelled_points(LABELLED, n_points, np.random.default_rng(seed), **options)


def test_points_come_back(tmp_path):
    points = sample(50)
    write_points(tmp_path / "a.txt", points)
    again = read_points(tmp_path / "a.txt")
    np.testing.assert_array_equal(again.points.astype(np.float32), points.points.astype(np.float32))
    np.testing.assert_array_equal(again.normals, points.normals)
    np.testing.assert_array_equal(again.labels, points.labels)


def test_the_same_seed_gives_the_same_bytes(tmp_path):
    for name in "ab":
        write_points(tmp_path / name, sample(50))
    assert (tmp_path / "a").read_bytes() == (tmp_path / "b").read_bytes()


def test_points_are_drawn_by_area():
    labels = sample(20_000).labels
    assert abs((labels == -1).mean() - 2 / 3) < 0.017  # five standard deviations
    assert not (labels == 9).any()


def test_points_lie_in_their_faces():
    points = sample(500)
    on_first = points.points[points.labels == 4]
    assert (on_first >= 0).all()
    assert (on_first.sum(axis=1) <= 1 + 1e-12).all()
    np.testing.assert_array_equal(np.abs(points.normals), np.tile([0.0, 0.0, 1.0], (500, 1)))


def test_unlabelled_faces_can_be_left_out():
    assert set(sample(500, omit_unlabelled=True).labels.tolist()) == {4}


@pytest.mark.parametrize("n_points", [0, 5_000_001])
def test_too_few_or_many_points_to_draw(n_points):
    with pytest.raises(ParameterError, match="n_points"):
        sample(n_points)


def test_nothing_to_draw_on():
    blank = LabelledMesh(MESH, np.array([-1, -1, 9]))
    with pytest.raises(DegenerateMeshError, match="by area"):
        sample_labelled_points(blank, 5, np.random.default_rng(0), omit_unlabelled=True)


def test_as_the_dataset_writes_them():
    points = read_points("a.txt", b"0.1 0.2 0.3 0 1 0 12.000000\n-1e-3 0 0 0 0 1 0.000000\n")
    assert points.labels.tolist() == [12, 0]
    assert points.points[1].tolist() == [-1e-3, 0, 0]
    assert points.normals[0].tolist() == [0, 1, 0]


@pytest.mark.parametrize(
    ("data", "error", "message"),
    [
        (b"", FileFormatError, "empty"),
        (b"0 0 0 0 0 1\n", FileFormatError, "have 6 columns"),
        (b"0 0 0 0 0 1 2\n0 0 0 0", FileFormatError, "truncated"),
        (b"0 0 0 0 0 1 seat\n", FileFormatError, "truncated"),
        (b"0 0 0 0 0 1 0.5\n", LabelError, "point 1 has 0.5"),
        (b"0 0 0 0 0 1 nan\n", LabelError, "point 1 has nan"),
        (b"0 0 0 0 0 1 1e300\n", LabelError, "whole numbers"),
        (b"0 0 0 0 0 1 -2\n", LabelError, "one is -2"),
        (b"inf 0 0 0 0 1 1\n", LabelError, "finite"),
    ],
)
def test_reading_refuses(data, error, message):
    with pytest.raises(error, match=message) as caught:
        read_points("a.txt", data)
    assert str(caught.value).startswith("a.txt: ")
    assert "\n" not in str(caught.value)


def test_too_many_lines(monkeypatch):
    monkeypatch.setattr(labelled_points, "MAX_POINTS", 2)
    with pytest.raises(FileFormatError, match="5 lines"):
        read_points("a.txt", b"0 0 0 0 0 1 2\n" * 5)


def test_a_file_of_absurd_size(tmp_path):
    with (tmp_path / "a.txt").open("wb") as file:
        file.truncate(ReadLimits().max_bytes + 1)
    with pytest.raises(FileFormatError, match="bytes"):
        read_points(tmp_path / "a.txt")


def test_a_pair_of_files():
    points = read_point_pair("a.pts", "a.seg", b"0 0 1\n1 2 3\n", b"3\n1\n")
    assert points.normals is None
    assert points.points.tolist() == [[0, 0, 1], [1, 2, 3]]
    assert points.labels.tolist() == [3, 1]


@pytest.mark.parametrize(
    ("points", "labels", "error", "message"),
    [
        (b"0 0 1\n1 2 3\n", b"3\n", LabelError, r"^a\.seg: 2 points must have a label"),
        (b"0 0 1\n", b"seat\n", FileFormatError, r"^a\.seg: labels must be whole"),
        (b"0 0 1\n", b"", FileFormatError, r"^a\.seg: .*empty"),
        (b"0 0\n", b"1\n", FileFormatError, r"^a\.pts: .*2 columns"),
    ],
)
def test_a_pair_refuses(points, labels, error, message):
    with pytest.raises(error, match=message):
        read_point_pair("a.pts", "a.seg", points, labels)


def test_points_without_normals_are_not_written(tmp_path):
    with pytest.raises(LabelError, match="must have normals"):
        write_points(tmp_path / "a.txt", LabelledPoints(np.zeros((1, 3)), None, np.zeros(1, dtype=np.int64)))
    assert not list(tmp_path.iterdir())


def test_no_points():
    with pytest.raises(LabelError, match="1 to 5000000"):
        LabelledPoints(np.zeros((0, 3)), None, np.zeros(0, dtype=np.int64))


def test_renumbered_to_a_schema():
    points = LabelledPoints(np.zeros((3, 3)), None, np.array([13, -1, 12]))
    assert points.renumbered({12: 1, 13: 2, 14: 3}).labels.tolist() == [2, -1, 1]
    with pytest.raises(LabelError, match=r"\[13\] have none"):
        points.renumbered({12: 1})
