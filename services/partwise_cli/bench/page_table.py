"""What the table of very many shapes holds, and how long a page of tiles takes, wherever somebody jumps to."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from partwise_cli.bench.page_browser import Meter, Weight, new_person, wait_until
from partwise_cli.bench.page_shape import Figures, figures

if TYPE_CHECKING:
    from playwright.sync_api import Browser

_GRID = "[role=grid][aria-label=Shapes]"
# Of every tile that is drawn: its row is there, not a place that waits for one.
_ROWS_ARE_THERE = f"""
(() => {{
  const tiles = [...document.querySelectorAll('{_GRID} [role=gridcell]')];
  return tiles.length > 0 && tiles.every((tile) => tile.dataset.place !== undefined);
}})()
"""
_PICTURES_ARE_THERE = f"""
(() => {{
  const grid = document.querySelector('{_GRID}').getBoundingClientRect();
  return [...document.querySelectorAll('{_GRID} img')]
    .filter((image) => {{
      const box = image.getBoundingClientRect();
      return box.bottom > grid.top && box.top < grid.bottom;
    }})
    .every((image) => image.complete && image.naturalWidth > 0);
}})()
"""
_JUMP = f"""
async (share) => {{
  const grid = document.querySelector('{_GRID}');
  const start = performance.now();
  const frame = () => new Promise((done) => requestAnimationFrame(done));
  grid.scrollTop = share * (grid.scrollHeight - grid.clientHeight);
  await frame();
  await frame();
  while (!{_ROWS_ARE_THERE}) await frame();
  const rows = performance.now() - start;
  while (!{_PICTURES_ARE_THERE}) await frame();
  return {{ rows, pictures: performance.now() - start }};
}}
"""


@dataclass(frozen=True, slots=True)
class TableReport:
    """before, after : at the top as it was opened, and there again after jumps through everything. at_most : anywhere
    on the way. to_rows, to_pictures : from a jump until every tile in view has its row, and then its picture.
    """

    n_shapes: int
    opened_ms: float
    before: Weight
    at_most: Weight
    after: Weight
    to_rows: Figures
    to_pictures: Figures


def measure_table(
    browser: "Browser",
    origin: str,
    token: str,
    address: str,
    n_shapes: int,
    n_jumps: int,
    on_done: Callable[[int, int], None],
) -> TableReport:
    """Opens the table, jumps through all of it from top to bottom, and back to the top."""
    context = new_person(browser, origin, token)
    page = context.new_page()
    page.goto(origin + address, wait_until="commit")
    wait_until(page, _ROWS_ARE_THERE)
    opened_ms = page.evaluate("performance.now()")
    wait_until(page, _PICTURES_ARE_THERE)
    meter = Meter(browser, page)
    before = meter.weight()
    jumps, weights = [], []
    for n_done, share in enumerate(np.linspace(0, 1, n_jumps), start=1):
        jumps.append(page.evaluate(_JUMP, float(share)))
        weights.append(meter.weight())
        on_done(n_done, n_jumps)
    page.evaluate(_JUMP, 0.0)
    after = meter.weight()
    context.close()
    return TableReport(
        n_shapes,
        round(opened_ms, 1),
        before,
        _most([before, *weights]),
        after,
        figures([each["rows"] for each in jumps]),
        figures([each["pictures"] for each in jumps]),
    )


def _most(weights: list[Weight]) -> Weight:
    return Weight(
        max(each.elements for each in weights),
        max(each.nodes for each in weights),
        max(each.heap_mb for each in weights),
    )
