"""Every rule of the ladder's parameters."""

import subprocess
import sys

import pytest

from partwise.errors import ParameterError
from partwise.remesh.parameters import AlphaWrap, ImplicitContour, RemeshParameters


def test_wraps_come_before_contours() -> None:
    wrap, contour = AlphaWrap(1.0, 0.2), ImplicitContour(64)
    assert RemeshParameters(wraps=(wrap,), contours=(contour,)).attempts == (wrap, contour)


def test_a_wrap_aims_beyond_the_finest_level_and_never_below_its_minimum() -> None:
    fine = RemeshParameters(levels=(40_000, 5_000), faces_over_finest=1.5, min_wrap_faces=10_000)
    coarse = RemeshParameters(levels=(5_000,), faces_over_finest=1.5, min_wrap_faces=10_000)
    assert (fine.n_wrap_faces, coarse.n_wrap_faces) == (60_000, 10_000)


@pytest.mark.parametrize(("alpha", "offset"), [(0.0, 1.0), (51.0, 1.0), (1.0, 0.0), (1.0, float("nan"))])
def test_a_percentage_out_of_range_is_refused(alpha: float, offset: float) -> None:
    with pytest.raises(ParameterError, match="percent must be in"):
        AlphaWrap(alpha, offset)


@pytest.mark.parametrize(("n_cells", "offset", "rule"), [(15, 1.0, "n_cells"), (513, 1.0, "n_cells"), (64, 0.4, "off")])
def test_a_grid_out_of_range_is_refused(n_cells: int, offset: float, rule: str) -> None:
    with pytest.raises(ParameterError, match=rule):
        ImplicitContour(n_cells, offset)


@pytest.mark.parametrize(
    ("changes", "rule"),
    [
        ({"wraps": (), "contours": ()}, "needs an attempt"),
        ({"levels": ()}, "100 or more"),
        ({"levels": (99,)}, "100 or more"),
        ({"levels": (5_000, 10_000)}, "descend"),
        ({"levels": (5_000, 5_000)}, "descend"),
        ({"level_tolerance": 0.6}, "level_tolerance"),
        ({"max_faces_as_is": 3}, "max_faces_as_is"),
        ({"faces_over_finest": 0.9}, "faces_over_finest"),
        ({"min_wrap_faces": 99}, "min_wrap_faces"),
        ({"max_distance": 1.5}, "max_distance"),
        ({"max_dropped_area": -0.1}, "max_dropped_area"),
    ],
)
def test_a_rule_of_the_ladder_that_is_broken_is_named(changes: dict[str, object], rule: str) -> None:
    with pytest.raises(ParameterError, match=rule):
        RemeshParameters(**changes)  # type: ignore[arg-type]


def test_parameters_load_nothing_heavy() -> None:
    code = (
        "import sys, partwise.remesh.parameters; print(sorted({'pymeshlab', 'igl', 'scipy', 'cv2'} & set(sys.modules)))"
    )
    assert subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True).stdout == "[]\n"
