"""How fast a large shape is on the screen, and how fast the brush and new colours follow."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from partwise_cli.bench.page_browser import Meter, ProcessorTime, measured, new_person, rest, wait_until

if TYPE_CHECKING:
    from playwright.sync_api import Browser, Page

FIRST_PAINT, BRUSH = "partwise:first-paint", "partwise:brush"
_TURN = 2 * np.pi
_ROUNDS = 3.0
_REACH = 0.16  # of the view: the drag stays about the middle, where the shape is
_N_CHANGES = 40
_NUDGE_MS = 30  # between two changes: no frame has two

_READY = "document.querySelector('[aria-label=\"Save state\"]') !== null"  # there are labels, which may be changed
_VIEW = "document.querySelector('section[aria-label=Shape]').getBoundingClientRect().toJSON()"
# Each change is one key, as people press it; it is over when the frame that shows it is drawn.
_CHANGE = """
async ({ keys, nudgeMs }) => {
  const took = [];
  for (const key of keys) {
    const start = performance.now();
    window.dispatchEvent(new KeyboardEvent('keydown', { key, ctrlKey: true, bubbles: true, cancelable: true }));
    const commanded = performance.now();
    await new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done)));
    took.push({ script: commanded - start, seen: window.partwiseDrawn() - start });
    await new Promise((done) => setTimeout(done, nudgeMs));
  }
  return took;
}
"""


@dataclass(frozen=True, slots=True)
class Figures:
    """Milliseconds, of `n` samples."""

    n: int
    median: float
    p99: float
    most: float


@dataclass(frozen=True, slots=True)
class BrushReport:
    """Of a drag of the brush. to_command : from the event until the frame's drawing is asked for. to_frame : until it
    is drawn. script_ms, thread_ms, graphics_ms : processor time a pointer move: of scripts, of the page's whole thread,
    of the process that draws in software.
    """

    n_moves: int
    to_command: Figures
    to_frame: Figures
    script_ms: float
    thread_ms: float
    graphics_ms: float


@dataclass(frozen=True, slots=True)
class RecolourReport:
    """Of taking a large stroke back and doing it again. script_ms, graphics_ms : processor time for each."""

    script: Figures
    to_frame: Figures
    script_ms: float
    graphics_ms: float


@dataclass(frozen=True, slots=True)
class ShapeReport:
    """first_paint : from the beginning of the navigation until the shape is drawn, in a browser with nothing cached
    (cold), and again in the same browser (warm). asked_to_paint : of the warm ones, from when the page asked for it.
    cold_core, warm_core : processor milliseconds of all of the browser's processes until then, which other programs do
    not lengthen; work in several threads counts together.
    """

    cold: Figures
    warm: Figures
    asked_to_paint: Figures
    cold_core: Figures
    warm_core: Figures
    brush: BrushReport
    recolour: RecolourReport


def figures(samples: "list[float] | np.ndarray") -> Figures:
    """The usual figures of milliseconds; the p99 is a sample."""
    values = np.asarray(samples, dtype=np.float64)
    median, p99 = np.percentile(values, [50, 99], method="higher")
    return Figures(len(values), *(round(float(value), 1) for value in (median, p99, values.max())))


def measure_shape(
    browser: "Browser", origin: str, token: str, address: str, n_repeats: int, on_done: Callable[[int, int], None]
) -> ShapeReport:
    """Opens the shape at an address of the page again and again, then paints on it."""
    cold, warm, n_steps = [], [], 2 * n_repeats + 2
    for n_done in range(n_repeats):
        context = new_person(browser, origin, token)
        cold.append(_first_paint(browser, context.new_page(), origin + address))
        if n_done + 1 < n_repeats:
            context.close()
        on_done(n_done + 1, n_steps)
    page = context.new_page()
    for n_done in range(n_repeats):
        page.goto("about:blank")
        rest(browser)  # from what the page before was still at
        warm.append(_first_paint(browser, page, origin + address))
        on_done(n_repeats + n_done + 1, n_steps)
    wait_until(page, _READY)
    brush = _brush(browser, page)
    on_done(n_steps - 1, n_steps)
    recolour = _recolour(browser, page)
    on_done(n_steps, n_steps)
    context.close()
    return ShapeReport(
        figures([each.seen_ms for each in cold]),
        figures([each.seen_ms for each in warm]),
        figures([each.asked_ms for each in warm]),
        figures([each.core_ms for each in cold]),
        figures([each.core_ms for each in warm]),
        brush,
        recolour,
    )


@dataclass(frozen=True, slots=True)
class _FirstPaint:
    """Milliseconds until the shape was seen: from the navigation's beginning, from asking for it, of processors."""

    seen_ms: float
    asked_ms: float
    core_ms: float


def _first_paint(browser: "Browser", page: "Page", address: str) -> _FirstPaint:
    time = ProcessorTime(browser)
    page.goto(address, wait_until="commit")
    wait_until(page, f"window.partwiseMeasured.some(({{ name }}) => name === '{FIRST_PAINT}')")
    core_ms = time.spent_ms()
    paint = measured(page, FIRST_PAINT)[0]
    return _FirstPaint(paint.seen, paint.seen - paint.start, core_ms)


def _brush(browser: "Browser", page: "Page", n_moves: int = 300) -> BrushReport:
    """Drags the brush around the middle of the view: over the shape, its edge, and the space beside it."""
    page.keyboard.press("b")
    page.keyboard.press("1")
    box = page.evaluate(_VIEW)
    angles = np.linspace(0, _ROUNDS * _TURN, n_moves)
    reach = _REACH * min(box["width"], box["height"]) * np.linspace(0.1, 1.0, n_moves)
    xs = box["x"] + box["width"] / 2 + reach * np.cos(angles)
    ys = box["y"] + box["height"] / 2 + reach * np.sin(angles)
    page.mouse.move(xs[0], ys[0])
    page.mouse.down()
    measured(page, BRUSH)
    meter = Meter(browser, page)
    before = meter.spent()
    for x, y in zip(xs, ys, strict=True):
        page.mouse.move(x, y)
    spent = meter.spent() - before
    page.mouse.up()
    moves = measured(page, BRUSH)
    per_move = (round(value / n_moves, 2) for value in (spent.script_ms, spent.thread_ms, spent.graphics_ms))
    return BrushReport(
        n_moves,
        figures([each.end - each.start for each in moves]),
        figures([each.seen - each.start for each in moves]),
        *per_move,
    )


def _recolour(browser: "Browser", page: "Page") -> RecolourReport:
    meter = Meter(browser, page)
    before = meter.spent()
    keys = ["z", "y"] * (_N_CHANGES // 2)
    took = page.evaluate(_CHANGE, {"keys": keys, "nudgeMs": _NUDGE_MS})
    spent = meter.spent() - before
    return RecolourReport(
        figures([each["script"] for each in took]),
        figures([each["seen"] for each in took]),
        round(spent.script_ms / len(keys), 2),
        round(spent.graphics_ms / len(keys), 2),
    )
