"""The experiment's bookkeeping; its findings are in docs/remeshing.md."""

from dataclasses import replace

import numpy as np
import pytest

from partwise.errors import NotEnoughDataError
from partwise.mesh import TriMesh
from partwise.remesh.calibration import (
    Calibration,
    KnownShape,
    ShapeOutcome,
    calibrate,
    round_trip_share,
    table,
    without_smallest_part,
)
from partwise.remesh.parameters import AlphaWrap, RemeshParameters
from partwise.render.raycast import RayCastRenderer

ANYTHING = RemeshParameters(wraps=(AlphaWrap(3.0, 0.4),), contours=(), levels=(500,), max_distance=1.4)
OUTCOME = ShapeOutcome("bowls", "a", 0.2, 0.25, (0.5, 0.6), 0.3, 0.99, 1_000, 2.0)


@pytest.fixture(scope="module")
def bowls(ball: TriMesh, open_bowl: TriMesh) -> list[KnownShape]:
    def bowl(name: str, stretch: np.ndarray) -> KnownShape:
        dirty = TriMesh(open_bowl.vertices * stretch, open_bowl.faces)
        labels = (dirty.vertices[dirty.faces].mean(axis=1)[:, 1] > -0.3).astype(np.int64)
        return KnownShape("bowls", name, dirty, labels, TriMesh(ball.vertices * stretch, ball.faces))

    return [bowl("round", np.ones(3)), bowl("long", np.array([3.0, 1.0, 1.0]))]


def test_a_bowl_looks_like_itself_and_unlike_the_other(bowls: list[KnownShape], renderer: RayCastRenderer) -> None:
    calibration = calibrate(bowls, ANYTHING, 500, renderer)
    assert [outcome.name for outcome in calibration.outcomes] == ["round", "long"]
    assert calibration.greatest_good < calibration.suggested_distance < calibration.least_wrong


def test_a_category_of_one_shape_has_no_wrong_pairs(bowls: list[KnownShape], renderer: RayCastRenderer) -> None:
    with pytest.raises(NotEnoughDataError, match="two shapes a category"):
        calibrate(bowls[:1], ANYTHING, 500, renderer)


def test_nothing_remeshed_is_no_calibration(bowls: list[KnownShape], renderer: RayCastRenderer) -> None:
    with pytest.raises(NotEnoughDataError, match="none of 2 shapes"):
        calibrate(bowls, replace(ANYTHING, max_distance=0.0), 500, renderer)


def test_the_threshold_lies_a_fifth_of_the_way() -> None:
    assert Calibration((OUTCOME,), ()).suggested_distance == pytest.approx(0.26)


def test_overlapping_distances_have_no_threshold() -> None:
    overlapping = replace(OUTCOME, own_distance=0.5)
    with pytest.raises(NotEnoughDataError, match="good pairs must lie closer"):
        _ = Calibration((overlapping,), ()).suggested_distance


def test_the_part_of_least_area_goes(bowls: list[KnownShape]) -> None:
    rest = without_smallest_part(bowls[0])
    assert rest.n_faces == max(np.bincount(bowls[0].labels))


def test_labels_survive_the_way_to_the_same_mesh(bowls: list[KnownShape]) -> None:
    assert round_trip_share(bowls[0].dirty, bowls[0].labels, bowls[0].dirty) == 1.0


def test_the_table_has_a_row_for_each_category() -> None:
    rows = table(Calibration((OUTCOME, replace(OUTCOME, category="cups")), ())).splitlines()
    assert [row.split(" | ")[0] for row in rows[2:]] == ["| bowls", "| cups"]
    assert "0.200 (≤ 0.200)" in rows[2]
