"""The main job on simulated shapes, where ground truth can stand in for an annotator and judge the result."""

import shutil
import time
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from statistics import median
from typing import Any

from partwise.config import CONFIG_FILE
from partwise.errors import ConfigError
from partwise.io.atomic import write_atomically
from partwise.store.records import Collection, RevisionKind
from partwise.workspace.assessment import ShapeAccuracy, assess
from partwise.workspace.export import ExportFormat, export_labels
from partwise.workspace.first_shapes import select_first_shapes
from partwise.workspace.ingest import ingest_folder
from partwise.workspace.labelling import commit_labels, import_labels
from partwise.workspace.queue import all_ranked
from partwise.workspace.ranking import bring_into_order
from partwise.workspace.segmentations import REMESH, Segmentation, reference_labels
from partwise.workspace.shapes import pages_of_shapes, shape_mesh
from partwise.workspace.workspace import INITIAL_CONFIG, Workspace, init_workspace, open_workspace
from partwise_cli.pictures import write_worst_shapes
from partwise_cli.run_view import run_progress
from partwise_cli.simulated import SimulationRequest, write_collection
from partwise_cli.terminal import progress
from partwise_workers.cluster import connected
from partwise_workers.passes import evaluate, preprocess, refine
from partwise_workers.training import train_collection

ANNOTATOR = "simulated annotator"
SCORE = "entropy"
N_WORST = 12
DIRTY_EVERY = 4
"""One shape in so many is an open, non-manifold soup, as most are in real collections."""
LEVELS = (10_000, 5_000)
"""Resolutions of remeshed shapes: finer ones take longest, and the demo does not look at them."""
MARKER = ".partwise-demo"


@dataclass(frozen=True, slots=True)
class DemoRequest:
    """What `partwise demo` was asked for."""

    category: str
    n_shapes: int
    n_confirmed: int
    seed: int
    n_iterations: int


@dataclass(frozen=True, slots=True)
class Remeshing:
    """How many shapes were described as they are, how many were remeshed and how many could not be.

    median_core_s : seconds of processor time a remeshed shape took, all attempts and levels; 0 where none was.
    """

    n_as_is: int
    n_remeshed: int
    n_refused: int
    median_core_s: float


@dataclass(frozen=True, slots=True)
class DemoReport:
    """Accuracies of the shapes that nobody confirmed, in order of rank, the least certain first.

    n_unjudged : of those, that have no accuracy because their ground truth did not come to the working mesh whole.
    """

    request: DemoRequest
    n_described: int
    remeshing: Remeshing
    n_unjudged: int
    predicted: tuple[ShapeAccuracy, ...]
    refined: tuple[ShapeAccuracy, ...]
    model_version: int
    seconds: dict[str, float]
    shapes: Path
    workspace: Path
    exported: Path
    picture: Path


class _Stopwatch:
    """Wall seconds by step."""

    def __init__(self) -> None:
        self.seconds: dict[str, float] = {}
        self._since = time.perf_counter()

    def lap(self, step: str) -> None:
        now = time.perf_counter()
        self.seconds[step] = now - self._since
        self._since = now


def run_demo(out: Path, request: DemoRequest) -> DemoReport:
    """Runs every step into `out`. What an earlier demo left there is removed first.

    Raises
    ------
    ConfigError : `out` holds something that no demo made.
    """
    simulation = SimulationRequest(request.category, request.n_shapes, request.seed, dirty_every=DIRTY_EVERY)
    prepare_folder(out)
    shapes, workspace_path = out / "shapes", out / "workspace"
    watch = _Stopwatch()
    with progress("simulate") as on_progress:
        write_collection(simulation, shapes, on_progress)
    watch.lap("simulate")
    _init(workspace_path, request)
    with connected(), open_workspace(workspace_path) as workspace:
        collection = workspace.catalog.create_collection(request.category, simulation.part_names, {"up": "y"})
        watch.lap("init")
        ingest_folder(workspace, collection, shapes)
        watch.lap("ingest")
        with run_progress("preprocess") as tally:
            described = preprocess(workspace, collection, tally.on_progress, tally.on_event)
        watch.lap("preprocess")
        import_labels(workspace, collection, shapes, RevisionKind.REFERENCE, "simulation")
        confirmed = _confirm_first_shapes(workspace, collection, request)
        watch.lap("select and confirm")
        return _learn_and_report(out, request, workspace, collection, described.n_done, confirmed, watch)


def prepare_folder(out: Path) -> None:
    """Makes `out` ready: removes what an earlier demo left, and marks the folder as the demo's.

    Raises
    ------
    ConfigError : `out` holds something that no demo made.
    """
    if (out / MARKER).is_file():
        for name in ("shapes", "workspace", "labels"):
            shutil.rmtree(out / name, ignore_errors=True)
    elif out.exists() and (not out.is_dir() or any(out.iterdir())):
        raise ConfigError(f"the demo needs an empty folder but {out} holds something; remove it or name another")
    write_atomically(out / MARKER, b"Made by `partwise demo`, which removes its own folders here when it runs again.\n")


def _init(path: Path, request: DemoRequest) -> None:
    settings = f"\n[remesh]\nlevels = {list(LEVELS)}\n"
    settings += f"\n[train]\nseed = {request.seed}\nn_iterations = {request.n_iterations}\n"
    write_atomically(path / CONFIG_FILE, (INITIAL_CONFIG + settings).encode())
    init_workspace(path)


def remeshing_of(workspace: Workspace, collection: Collection) -> Remeshing:
    """What became of the collection's shapes at remeshing, from the catalog."""
    summaries: list[Mapping[str, Any]] = []
    n_refused = 0
    for page in pages_of_shapes(workspace.catalog, collection.id):
        ids = [shape.id for shape in page]
        summaries += [run.summary for run in workspace.catalog.stage_runs(ids, REMESH).values()]
        n_refused += len(workspace.catalog.failed_runs(ids, REMESH))
    made = [each for each in summaries if not each["is_as_is"]]
    core_s = [sum(step["core_s"] for step in (*each["attempts"], *each["levels"])) for each in made]
    return Remeshing(len(summaries) - len(made), len(made), n_refused, median(core_s) if core_s else 0.0)


def _confirm_first_shapes(workspace: Workspace, collection: Collection, request: DemoRequest) -> set[int]:
    """The simulated annotator labels the first shapes as ground truth says, where there is any. Returns their ids."""
    firsts = select_first_shapes(workspace, collection, request.n_confirmed, 1, request.seed)
    confirmed = set()
    for shape in workspace.catalog.shapes_by_id([first.shape_id for first in firsts]).values():
        truth = reference_labels(workspace, shape_mesh(workspace, shape))
        if truth is not None:
            commit_labels(workspace, collection, shape, truth, RevisionKind.HUMAN, ANNOTATOR)
            confirmed.add(shape.id)
    return confirmed


def _learn_and_report(
    out: Path,
    request: DemoRequest,
    workspace: Workspace,
    collection: Collection,
    n_described: int,
    confirmed: set[int],
    watch: _Stopwatch,
) -> DemoReport:
    with progress("train") as on_progress:
        model = train_collection(workspace, collection, on_progress)
    watch.lap("train")
    for name, run in (("evaluate", evaluate), ("refine", refine)):
        with run_progress(name) as tally:
            run(workspace, collection, tally.on_progress, tally.on_event)
        watch.lap(name)
    bring_into_order(workspace, collection)
    exported = out / "labels"
    export_labels(workspace, collection, Segmentation.REFINED, ExportFormat.PLY, exported)
    watch.lap("export")
    ranked = [row.shape for row in all_ranked(workspace, collection, SCORE) if row.shape.id not in confirmed]
    order = {shape.id: rank for rank, shape in enumerate(ranked)}
    predicted, refined = (
        tuple(
            sorted(
                (a for a in assess(workspace, collection, segmentation) if a.shape.id in order),
                key=lambda a: order[a.shape.id],
            )
        )
        for segmentation in (Segmentation.PREDICTED, Segmentation.REFINED)
    )
    picture = out / "worst.png"
    write_worst_shapes(workspace, collection, ranked[:N_WORST], refined, picture)
    watch.lap("picture")
    return DemoReport(
        request,
        n_described,
        remeshing_of(workspace, collection),
        len(ranked) - len(refined),
        predicted,
        refined,
        model.version,
        watch.seconds,
        out / "shapes",
        workspace.path,
        exported,
        picture,
    )
