"""The page as browsers have it: how soon a large shape is seen, how the brush follows, what a long table holds."""

import json
import os
from collections.abc import Callable
from dataclasses import asdict, dataclass
from pathlib import Path

from partwise.errors import ConfigError
from partwise.io.atomic import write_atomically
from partwise.store.records import ShapeState
from partwise.workspace.workspace import open_workspace
from partwise_cli.bench.load_server import HOST, served
from partwise_cli.bench.load_workspace import LoadedWorkspace
from partwise_cli.bench.page_browser import chromium
from partwise_cli.bench.page_shape import ShapeReport, measure_shape
from partwise_cli.bench.page_table import TableReport, measure_table
from partwise_cli.bench.page_workspace import make_page_workspace

OnStep = Callable[[str, int, int], None]
"""(what is being done, how much is done, of how much)"""
REPORT = "page.json"
MEASURED = (
    "Measured in headless Chromium, with the page as it is built for use, on loopback. Times are of the clock, with "
    "whatever else ran; processor times are not touched by it."
)
INFERRED = (
    "No graphics card was there: the process that draws did so in software, which stands in for a card. That a card "
    "draws within what is left of a frame is inferred, not measured."
)


@dataclass(frozen=True, slots=True)
class PageRequest:
    """n_shapes : rows of the table. n_faces : of the shape. repeats : navigations, cold and warm each."""

    n_faces: int = 50_000
    n_shapes: int = 300_000
    repeats: int = 5
    jumps: int = 60
    seed: int = 0


@dataclass(frozen=True, slots=True)
class BrowserReport:
    """n_faces : that the shape has. load_average : of the machine over the last minute, before and after."""

    request: PageRequest
    n_faces: int
    chromium: str
    n_cpus: int
    load_average: tuple[float, float]
    shape: ShapeReport
    table: TableReport
    measured: str = MEASURED
    inferred: str = INFERRED


def run_page(out: Path, request: PageRequest, on_step: OnStep) -> BrowserReport:
    """Makes a workspace in a new folder, serves it, measures its page, and leaves the report beside it as JSON.

    Raises
    ------
    ConfigError : the folder holds other things. StoreError : there is no browser, or the service does not come up.
    """
    if out.exists() and (not out.is_dir() or any(out.iterdir())):
        raise ConfigError(f"the benchmark needs an empty folder but {out} holds other files; choose another path")
    before = os.getloadavg()[0]
    with chromium() as browser:  # first: without one, nothing is worth making
        path = out / "workspace"
        path.mkdir(parents=True)
        on_step("fill the catalog", 0, 1)
        url = f"sqlite:///{(path / 'catalog.sqlite').absolute()}"
        workspace = make_page_workspace(path, url, request.n_shapes, request.n_faces, request.seed)
        on_step("fill the catalog", 1, 1)
        with served(path, out / "service.log") as server:
            origin, token = f"http://{HOST}:{server.port}", workspace.people[0].secret
            room = f"/c/{workspace.collection_id}"
            shape = measure_shape(
                browser,
                origin,
                token,
                f"{room}/work?shapes={_a_shape(workspace)}",
                request.repeats,
                lambda n_done, n_total: on_step("open and paint", n_done, n_total),
            )
            table = measure_table(
                browser,
                origin,
                token,
                f"{room}/table",
                workspace.n_shapes + 1,  # with the one whose mesh all others have
                request.jumps,
                lambda n_done, n_total: on_step("jump through the table", n_done, n_total),
            )
        version = browser.version
    load = (before, os.getloadavg()[0])
    report = BrowserReport(request, workspace.n_faces, version, os.cpu_count() or 1, load, shape, table)
    write_atomically(out / REPORT, json.dumps(asdict(report), indent=2).encode())
    return report


def _a_shape(workspace: LoadedWorkspace) -> int:
    """One that waits for labels."""
    with open_workspace(workspace.path) as opened:
        return opened.catalog.shapes(workspace.collection_id, limit=1, state=ShapeState.READY)[0].id
