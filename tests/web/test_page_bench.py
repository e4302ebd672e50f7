"""`partwise bench page`: what it measures of a small page, and what it says where it cannot."""

import json
import sys
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import TypeVar

import pytest

from partwise.errors import ConfigError, StoreError
from partwise_cli.bench.page import REPORT, PageRequest, run_page
from partwise_cli.bench.page_browser import chromium
from partwise_cli.bench.page_report import print_page
from partwise_cli.bench.page_shape import figures

T = TypeVar("T")
SMALL = PageRequest(n_faces=2_000, n_shapes=2_000, repeats=1, jumps=3)
MAX_ELEMENTS = 1_600
"""Of the table: what is in view and near, a fifth of what so many shapes would take."""


def _apart(act: Callable[[], T]) -> T:
    """In a thread of its own: this one may have a browser already, of which Playwright allows one a thread."""
    with ThreadPoolExecutor(1) as thread:
        return thread.submit(act).result()


def test_a_small_page_is_measured(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    steps: list[str] = []
    report = _apart(lambda: run_page(tmp_path / "out", SMALL, lambda what, _done, _total: steps.append(what)))
    assert list(dict.fromkeys(steps)) == ["fill the catalog", "open and paint", "jump through the table"]
    shape, table = report.shape, report.table
    assert shape.cold.n == shape.warm.n == 1
    assert 0 < shape.asked_to_paint.median < shape.warm.median
    assert shape.brush.to_command.n > 10  # frames of the drag
    assert shape.brush.to_frame.median >= shape.brush.to_command.median
    assert (table.n_shapes, table.to_rows.n) == (2_001, 3)
    assert 50 < table.before.elements <= table.at_most.elements < MAX_ELEMENTS
    written = json.loads((tmp_path / "out" / REPORT).read_text())
    assert written["shape"]["cold"]["n"] == 1
    print_page(report)
    assert "software" in capsys.readouterr().out


def test_a_folder_with_other_things_is_refused(tmp_path: Path) -> None:
    (tmp_path / "letter").touch()
    with pytest.raises(ConfigError, match="empty folder"):
        run_page(tmp_path, SMALL, lambda *_: None)


def test_a_missing_playwright_is_told_with_its_remedy(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "playwright.sync_api", None)
    with pytest.raises(StoreError, match=r"pip install partwise\[dev\]"), chromium():
        pass


def test_a_chromium_that_does_not_start_is_told(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("PARTWISE_CHROMIUM", "/nowhere/chromium")

    def start() -> None:
        with chromium():
            pass

    with pytest.raises(StoreError, match="make web"):
        _apart(start)


def test_figures_are_samples() -> None:
    found = figures([5.0, 1.0, 3.0])
    assert (found.n, found.median, found.p99, found.most) == (3, 3.0, 5.0, 5.0)
