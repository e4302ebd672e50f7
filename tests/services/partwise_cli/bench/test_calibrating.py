"""bench calibration: the shapes of the experiment, and its table."""

import pytest

from partwise.remesh.calibration import Calibration, ShapeOutcome
from partwise_cli.bench import calibrating
from partwise_cli.bench.calibrating import known_shapes


def test_every_category_has_its_shapes_dirty_and_clean() -> None:
    shapes = known_shapes(1, 11)
    assert [shape.category for shape in shapes] == ["chairs", "lamps", "mugs", "planes", "tables"]
    for shape in shapes:
        assert len(shape.labels) == shape.dirty.n_faces
        assert shape.dirty.content_hash() != shape.clean.content_hash()


def test_the_table_and_the_threshold_are_printed(invoke, monkeypatch: pytest.MonkeyPatch) -> None:
    outcome = ShapeOutcome("mugs", "0", 0.1, 0.15, (0.6, 0.7), 0.5, 0.99, 10_000, 5.0)
    monkeypatch.setattr(calibrating, "calibrated", lambda *_: Calibration((outcome,), ("lamps 3",)))
    result = invoke("bench", "calibration")
    assert "| mugs | 1 | 0.100 (≤ 0.100) |" in result.stdout
    assert result.stdout.splitlines()[-1] == "suggested max_distance: 0.200"
    assert "not remeshed: lamps 3" in result.stderr
