"""How much faster preprocessing goes with more actors: the same simulated shapes, half of them soups, from scratch.

Each actor computes with one thread. Ray's and the actors' start, and the first shapes, on which libraries are loaded
and kernels compiled, are left out of the rate and said apart.
"""

import shutil
import time
from collections.abc import Callable, Sequence
from contextlib import AbstractContextManager
from dataclasses import dataclass
from pathlib import Path

from partwise.config import CONFIG_FILE
from partwise.io.atomic import write_atomically
from partwise.workspace.ingest import ingest_folder
from partwise.workspace.progress import RunProgress
from partwise.workspace.workspace import INITIAL_CONFIG, init_workspace, open_workspace
from partwise_cli.run_tally import RunTally
from partwise_cli.simulated import SimulationRequest, write_collection
from partwise_cli.terminal import Advance, counted
from partwise_workers.cluster import connected
from partwise_workers.events import RunEvent, StageDone
from partwise_workers.passes import preprocess

CATEGORY, SEED, DIRTY_EVERY = "chairs", 5, 2
WARM_UP_PER_ACTOR = 2
"""Shapes of each actor that do not count."""

MARKER = "throughput-"
Watch = Callable[[str], AbstractContextManager[RunTally]]
"""(what runs) → a tally to be told of it, shown while it runs."""


@dataclass(frozen=True, slots=True)
class ThroughputRequest:
    """n_shapes : that count. n_faces : of the clean ones. levels : of remeshing."""

    n_shapes: int
    actors: tuple[int, ...] = (1, 2)
    n_faces: int = 4000
    levels: tuple[int, ...] = (10_000, 5_000)

    @property
    def n_warm_up(self) -> int:
        """The same for all runs, so that all count the same shapes."""
        return WARM_UP_PER_ACTOR * max(self.actors)


@dataclass(frozen=True, slots=True)
class Throughput:
    """One run. rate_per_min, wall_s : of the shapes that count. warm_up_s : from planning to the first of them.

    stage_s : seconds inside of stages, summed over the shapes that count: where it grows with the number of actors they
    were in each other's way, or the machine was busy with something else.
    """

    n_actors: int
    n_shapes: int
    n_failed: int
    warm_up_s: float
    wall_s: float
    rate_per_min: float
    stage_s: float


@dataclass(frozen=True, slots=True)
class ThroughputReport:
    """ratio : of each run's rate to that of the first."""

    runs: tuple[Throughput, ...]
    ratios: tuple[float, ...]


def measure_throughput(
    folder: Path, request: ThroughputRequest, on_simulated: Advance, watch: Watch
) -> ThroughputReport:
    """Simulates the shapes into `folder` and preprocesses them in a workspace for each number of actors."""
    shapes = folder / f"shapes-{request.n_shapes}-{request.n_faces}"
    n_total = request.n_shapes + request.n_warm_up
    simulation = SimulationRequest(CATEGORY, n_total, SEED, n_faces=request.n_faces, dirty_every=DIRTY_EVERY)
    write_collection(simulation, shapes, on_simulated)
    with connected(n_cpus=max(request.actors)):
        runs = [_run(folder, shapes, simulation, request, n_actors, watch) for n_actors in request.actors]
    return ThroughputReport(tuple(runs), ratios([run.rate_per_min for run in runs]))


def ratios(rates: Sequence[float]) -> tuple[float, ...]:
    """Each rate over the first."""
    return tuple(round(rate / rates[0], 3) if rates[0] else 0.0 for rate in rates)


@dataclass(slots=True)
class _Clock:
    """Runs from the end of the warm-up to the last shape."""

    n_warm_up: int
    began: float
    counts_from: float = 0.0
    ended: float = 0.0
    stage_s: float = 0.0
    _n_seen: int = 0

    def on_progress(self, progress: RunProgress) -> None:
        now, n_seen = time.perf_counter(), progress.n_done + progress.n_failed
        if n_seen < self._n_seen:
            return  # labels that move afterwards are another round
        self._n_seen = n_seen
        if n_seen <= self.n_warm_up:
            self.counts_from = now
        self.ended = now

    def on_event(self, event: RunEvent, /) -> None:
        if self._n_seen >= self.n_warm_up and isinstance(event, StageDone):
            self.stage_s += event.seconds


def _run(
    folder: Path,
    shapes: Path,
    simulation: SimulationRequest,
    request: ThroughputRequest,
    n_actors: int,
    watch: Watch,
) -> Throughput:
    path = folder / f"{MARKER}{n_actors}"
    shutil.rmtree(path, ignore_errors=True)
    config = f"\n[workers]\nn_actors = {n_actors}\n\n[remesh]\nlevels = {list(request.levels)}\n"
    write_atomically(path / CONFIG_FILE, (INITIAL_CONFIG + config).encode())
    init_workspace(path)
    settings = {"working_faces": max(request.levels)}  # which is made whatever the levels are
    with open_workspace(path) as workspace, watch(counted(n_actors, "actor")) as tally:
        collection = workspace.catalog.create_collection(CATEGORY, simulation.part_names, settings)
        ingest_folder(workspace, collection, shapes)
        clock = _Clock(request.n_warm_up, time.perf_counter())

        def on_progress(progress: RunProgress) -> None:
            clock.on_progress(progress)
            tally.on_progress(progress)

        def on_event(event: RunEvent, /) -> None:
            clock.on_event(event)
            tally.on_event(event)

        result = preprocess(workspace, collection, on_progress, on_event)
    shutil.rmtree(path)
    wall_s = clock.ended - clock.counts_from
    return Throughput(
        n_actors,
        request.n_shapes,
        result.n_failed,
        round(clock.counts_from - clock.began, 2),
        round(wall_s, 2),
        round(60 * request.n_shapes / wall_s, 2),
        round(clock.stage_s, 2),
    )
