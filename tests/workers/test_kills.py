"""SIGKILL of the driver, of actors and of the raylet at random moments of `partwise preprocess`, each with its own Ray.

Whatever is killed: blocks on record stay whole, and running to the end gives what an undisturbed run gives.
"""

import os
import shutil
import signal
import subprocess
import sys
import tempfile
import time
from collections import Counter, deque
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
import psutil
import pytest
import trimesh

from partwise.io.write import write_mesh
from partwise.mesh import TriMesh
from partwise.store.array_store import BlockAddress
from partwise.workspace.ingest import ingest_folder
from partwise.workspace.shapes import all_shapes
from partwise.workspace.workspace import Workspace, init_workspace, open_workspace

pytestmark = [pytest.mark.slow, pytest.mark.timeout(1800)]

N_SHAPES = 100
DRIVER, ACTOR, RAYLET = "driver", "actor", "raylet"
KILLS = {DRIVER: 8, ACTOR: 10, RAYLET: 6}
MAX_EVENTS_BETWEEN_KILLS = 13
SETTINGS = """
[workers]
n_actors = 2
block_shapes = 4
max_attempts = 10

[remesh]
levels = [500]
min_wrap_faces = 500
max_distance = 1.0
contours = []

[[remesh.wraps]]
alpha_percent = 4.0
offset_percent = 1.0

[describe.light_field]
renderer = "raycast"
"""
COMMAND = (sys.executable, "-c", "from partwise_cli.main import main; main()", "preprocess")
SOME_FAILED, RAY_TROUBLE, INTERRUPTED = 1, 4, 130
POLL_S = 0.02
LOG = "driver.log"
GONE_WITHIN_S = 60.0
ENDS_WITHIN_S = 240.0  # of a driver whose raylet died, which Ray tells it late


def write_shapes(folder: Path) -> None:
    """Bumpy balls of 320 faces, no two alike, every fourth with a hole to be wrapped, and a file that is cut off."""
    rng = np.random.default_rng(0)
    ball = trimesh.creation.icosphere(subdivisions=2)
    for number in range(N_SHAPES):
        bumps = 1 + 0.2 * rng.random((len(ball.vertices), 1))
        faces = ball.faces if number % 4 else ball.faces[6:]
        write_mesh(TriMesh(ball.vertices * bumps, faces), folder / f"{number:02d}.off")
    (folder / "cut.off").write_bytes(b"OFF\n4 4 0\n0 0 0\n")


def make_workspace(path: Path, shapes: Path) -> Path:
    init_workspace(path)
    with (path / "partwise.toml").open("a", encoding="utf-8") as file:
        file.write(SETTINGS)
    with open_workspace(path) as workspace:
        ingest_folder(workspace, workspace.catalog.create_collection("balls", ["part"], {"working_faces": 500}), shapes)
    return path


@dataclass
class Driver:
    """`partwise preprocess` in a process of its own, and every process that it has been seen to start."""

    process: psutil.Popen
    descendants: set[psutil.Process] = field(default_factory=set)

    def look(self) -> list[psutil.Process]:
        """Today's descendants; they are remembered."""
        try:
            found = self.process.children(recursive=True)
        except psutil.NoSuchProcess:
            return []
        self.descendants.update(found)
        return found

    def left_behind(self) -> list[psutil.Process]:
        """Descendants that outlive the driver by more than a while. Nothing is left of it afterwards."""
        deadline = time.monotonic() + GONE_WITHIN_S
        while (
            left := [p for p in self.descendants if is_alive(p) and not is_agent(p)]
        ) and time.monotonic() < deadline:
            time.sleep(5 * POLL_S)
        for process in filter(is_alive, self.descendants):
            process.kill()
        return left


def is_agent(process: psutil.Process) -> bool:
    """Ray's own two agents go by themselves a minute after their raylet: so long they try to report its death."""
    try:
        return process.name() in ("ray::DashboardA", "ray::DashboardAgent", "ray::RuntimeEnv", "ray::RuntimeEnvAgent")
    except psutil.NoSuchProcess:
        return False


def is_alive(process: psutil.Process) -> bool:
    """Zombies are dead: where nobody adopts orphans, they stay listed."""
    try:
        return process.is_running() and process.status() != psutil.STATUS_ZOMBIE
    except psutil.NoSuchProcess:
        return False


@contextmanager
def preprocessing(workspace: Path) -> Iterator[Driver]:
    """Starts the driver. At the end nothing of it is left, and nobody else's Ray is touched."""
    ray_folder = tempfile.mkdtemp(prefix="pw-", dir="/tmp")  # short, as the paths of sockets must be
    environment = {name: value for name, value in os.environ.items() if name != "RAY_ADDRESS"}
    process = psutil.Popen(
        [*COMMAND, str(workspace)],
        env={**environment, "RAY_TMPDIR": ray_folder},
        stdout=subprocess.DEVNULL,
        stderr=(workspace.parent / LOG).open("wb"),
        start_new_session=True,
    )
    driver = Driver(process)
    try:
        yield driver
    finally:
        driver.look()
        if process.poll() is None:
            process.kill()
        process.wait()
        assert driver.left_behind() == []
        shutil.rmtree(ray_folder, ignore_errors=True)


def events(workspace: Path, driver: Driver) -> Iterator[int]:
    """Counts what happens in the array store, as it happens, until the driver ends."""
    seen: set[str] = set()
    n_events = 0
    while driver.process.poll() is None:
        found = {name for name in files(workspace / "arrays") if name not in seen}
        seen |= found
        n_events += len(found)
        driver.look()
        yield n_events
        time.sleep(POLL_S)


def files(folder: Path) -> Iterator[str]:
    for where, _, names in os.walk(folder):
        if "sources" not in where:
            yield from (f"{where}/{name}" for name in names)


def run_to_end(workspace: Path) -> None:
    with preprocessing(workspace) as driver:
        for _ in events(workspace, driver):
            pass
        assert driver.process.wait() in (0, SOME_FAILED)


@dataclass(frozen=True)
class Result:
    """All that a preprocessed shape is: its stage keys, its mesh's hash, its arrays; or why it failed."""

    keys: Mapping[str, str]
    mesh_hash: str | None
    arrays: Mapping[str, bytes]
    reason: str | None


STAGES = {
    "mesh": ("vertices", "faces"),
    "remesh": ("vertices", "faces", "level_vertices", "level_faces", "level_sizes", "working_level"),
    "describe": (
        "shape_context",
        "shape_context_scale",
        "spin_image",
        "spin_image_scale",
        "shape_diameter",
        "light_field",
    ),
    "picture": ("face_ids", "shading"),
}


def results(workspace: Workspace) -> dict[str, Result]:
    catalog = workspace.catalog
    (collection,) = catalog.list_collections()
    shapes = list(all_shapes(catalog, collection.id))
    ids = [shape.id for shape in shapes]
    runs = {stage: catalog.stage_runs(ids, stage) for stage in STAGES}
    meshes, failed = catalog.meshes(ids), catalog.failed_runs(ids, "mesh")
    found = {}
    for shape in shapes:
        own = {stage: of_stage[shape.id] for stage, of_stage in runs.items() if shape.id in of_stage}
        arrays = {
            f"{stage}/{quantity}": workspace.arrays.read(run.block_name, run.row, quantity).tobytes()
            for stage, run in own.items()
            for quantity in STAGES[stage]
        }
        mesh_hash = meshes[shape.id].mesh_hash if shape.id in meshes else None
        reason = failed[shape.id].reason if shape.id in failed else None
        found[shape.source_key] = Result({stage: run.key for stage, run in own.items()}, mesh_hash, arrays, reason)
    return found


def visible_blocks(path: Path) -> set[str]:
    """Names of the blocks on record, each read as a whole and compared with its checksum."""
    with open_workspace(path) as workspace:
        blocks = workspace.catalog.visible_blocks()
        for block in blocks:
            workspace.arrays.verify(BlockAddress(block.name, block.n_shapes, block.n_bytes, block.checksum))
        return {block.name for block in blocks}


def require_undisturbed_result(path: Path, undisturbed: Mapping[str, Result]) -> None:
    visible_blocks(path)
    with open_workspace(path) as workspace:
        assert results(workspace) == undisturbed
        shapes_in_blocks: Counter[str] = Counter()
        for block in workspace.catalog.visible_blocks():
            shapes_in_blocks[block.kind] += block.n_shapes
        # each shape went into one block of each stage, once
        assert shapes_in_blocks == dict.fromkeys(("mesh", "remesh", "features", "picture"), N_SHAPES)
        assert list(workspace.arrays.staged_keys()) == []


@pytest.fixture(scope="module")
def shapes(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("shapes")
    write_shapes(folder)
    return folder


@pytest.fixture(scope="module")
def undisturbed(tmp_path_factory: pytest.TempPathFactory, shapes: Path) -> Mapping[str, Result]:
    path = make_workspace(tmp_path_factory.mktemp("undisturbed") / "ws", shapes)
    run_to_end(path)
    with open_workspace(path) as workspace:
        return results(workspace)


def test_an_undisturbed_run_describes_every_shape_but_the_broken_one(undisturbed: Mapping[str, Result]) -> None:
    whole = {name for name, result in undisturbed.items() if set(result.keys) == set(STAGES)}
    assert len(whole) == N_SHAPES
    assert [name for name, result in undisturbed.items() if result.reason] == ["cut.off"]


def test_a_run_survives_whatever_is_killed(tmp_path: Path, shapes: Path, undisturbed: Mapping[str, Result]) -> None:
    path = make_workspace(tmp_path / "ws", shapes)
    rng = np.random.default_rng(0)
    victims = deque(rng.permutation([victim for victim, count in KILLS.items() for _ in range(count)]).tolist())
    on_record: set[str] = set()
    while victims:
        with preprocessing(path) as driver:
            kill_some(path, driver, victims, rng)
        after = visible_blocks(path)
        assert on_record <= after
        on_record = after
    run_to_end(path)
    assert on_record <= visible_blocks(path)  # nothing that was committed is done again
    require_undisturbed_result(path, undisturbed)


def kill_some(workspace: Path, driver: Driver, victims: deque[str], rng: np.random.Generator) -> None:
    """Kills the next victims, each a random number of events after the last, until a kill ends the run."""
    due = None
    for n_events in events(workspace, driver):
        due = n_events + rng.integers(1, MAX_EVENTS_BETWEEN_KILLS) if due is None else due
        if n_events < due:
            continue
        processes = [driver.process] if victims[0] == DRIVER else [p for p in driver.look() if is_a(p, victims[0])]
        if not processes:  # between two actors' lives
            continue
        time.sleep(float(rng.uniform(0, 0.1)))
        driver.look()
        processes[rng.integers(len(processes))].send_signal(signal.SIGKILL)
        if victims.popleft() in (DRIVER, RAYLET):
            ended = driver.process.wait(ENDS_WITHIN_S)
            assert ended in (-signal.SIGKILL, RAY_TROUBLE, SOME_FAILED), (workspace.parent / LOG).read_text()[-2000:]
            return
        if not victims:
            return
        due = None
    raise AssertionError(f"the run ended before {list(victims)} were killed")


def is_a(process: psutil.Process, victim: str) -> bool:
    try:
        command = process.cmdline()
    except psutil.Error:
        return False
    if victim == RAYLET:
        return bool(command) and Path(command[0]).name == RAYLET
    return "ray::_StageWorker" in " ".join(command) or "ray::_Packer" in " ".join(command)


def n_described(workspace: Path) -> int:
    """Shapes whose description waits in staging."""
    return sum(1 for _ in files(workspace / "arrays" / "staging" / "describe"))


def test_an_interrupted_run_keeps_what_is_finished_and_goes_on(
    tmp_path: Path, shapes: Path, undisturbed: Mapping[str, Result]
) -> None:
    path = make_workspace(tmp_path / "ws", shapes)
    with preprocessing(path) as driver:
        for _ in events(path, driver):
            # by the third, the driver has taken in at least one of two actors' first shapes
            if n_described(path) >= 3:
                os.killpg(driver.process.pid, signal.SIGINT)  # as a terminal does: to Ray's processes too
                break
        assert driver.process.wait() == INTERRUPTED
    assert visible_blocks(path) != set()
    run_to_end(path)
    require_undisturbed_result(path, undisturbed)
