"""The passes over a collection: preprocess, evaluate, refine. Each plans what is missing and runs it on Ray.

What happens is counted in Ray's metrics, and told to `on_event`.
"""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace
from itertools import takewhile

from partwise.errors import NotFoundError
from partwise.segmentation.parameters import RefinementParameters
from partwise.store.records import Collection, MeshRole, Model, NewMesh, NewScore
from partwise.workspace.progress import OnRunProgress, RunProgress
from partwise.workspace.relabel import MoveReport
from partwise.workspace.settings import settings_of
from partwise.workspace.workspace import Workspace
from partwise_workers.cluster import connected
from partwise_workers.events import OnEvent, RunEvent, ignore_events
from partwise_workers.metrics import RunMetrics
from partwise_workers.model_store import ModelReference
from partwise_workers.plan import description_stages, plan_tasks
from partwise_workers.publishing import AlsoPublish, Published, nothing_else
from partwise_workers.relabelling import move_labels
from partwise_workers.runner import StageRunner
from partwise_workers.stage import Stage
from partwise_workers.stages import evaluate as evaluate_stage
from partwise_workers.stages import mesh as mesh_stage
from partwise_workers.stages import remesh as remesh_stage
from partwise_workers.stages.evaluate import EvaluateStage
from partwise_workers.stages.picture import PictureStage
from partwise_workers.stages.refine import RefineStage
from partwise_workers.staging import sweep_staging
from partwise_workers.tasks import ShapeTask, StagedResult

MESH_ROLES = {mesh_stage.NAME: MeshRole.ORIGINAL, remesh_stage.NAME: MeshRole.WORKING}
"""What the mesh that a stage made is to its shape."""


MayGoOn = Callable[[], bool]
"""Asked before each shape that a run takes up; once it says no, the run ends with what it has in hand."""


def always() -> bool:
    """The run goes on to its end."""
    return True


def preprocess(
    workspace: Workspace,
    collection: Collection,
    on_progress: OnRunProgress,
    on_event: OnEvent = ignore_events,
    on_moved: Callable[[MoveReport], None] = lambda _: None,
    may_go_on: MayGoOn = always,
) -> RunProgress:
    """Reads, checks, remeshes, describes and pictures every shape that is not yet described as it is configured to be.

    Then labels move to the meshes that are new; `on_moved` is told how that went. A run that is stopped moves none.

    Raises
    ------
    StoreError : a store is full or cannot be reached; what is finished is kept for the next run. So do all passes.
    WorkerError : Ray or its processes cannot be started. So do all passes.
    """
    stages = (*description_stages(workspace, collection), PictureStage(settings_of(collection).up))
    result = _run(workspace, collection, stages, (), on_progress, on_event, _meshes, may_go_on)
    if may_go_on():
        on_moved(move_labels(workspace, collection, on_progress))
    return result


def evaluate(
    workspace: Workspace, collection: Collection, on_progress: OnRunProgress, on_event: OnEvent = ignore_events
) -> RunProgress:
    """Lets the newest model predict and score every described shape that it has not seen.

    Raises
    ------
    NotFoundError : no model was trained yet.
    """
    model = newest_model(workspace, collection)
    stage = EvaluateStage(ModelReference.of(model))
    earlier = description_stages(workspace, collection)
    return _run(workspace, collection, (stage,), earlier, on_progress, on_event, scores_of(model))


def scores_of(model: Model) -> AlsoPublish:
    """The scores that a model gave a shape, of the results of stage `evaluate`."""

    def scores(shape_id: int, result: StagedResult, row: int) -> Published:  # noqa: ARG001 - AlsoPublish's signature
        if result.stage != evaluate_stage.NAME:
            return Published()
        return Published(
            scores=tuple(NewScore(shape_id, model.id, name, result.summary[name]) for name in evaluate_stage.SCORES)
        )

    return scores


def refine(
    workspace: Workspace,
    collection: Collection,
    on_progress: OnRunProgress,
    on_event: OnEvent = ignore_events,
    may_go_on: MayGoOn = always,
) -> RunProgress:
    """Graph cut on the newest model's probabilities, with the smoothness that its training chose.

    Raises
    ------
    NotFoundError : no model was trained yet.
    """
    model = newest_model(workspace, collection)
    stage = RefineStage(refinement_parameters(workspace, model), model.version)
    earlier = (*description_stages(workspace, collection), EvaluateStage(ModelReference.of(model)))
    return _run(workspace, collection, (stage,), earlier, on_progress, on_event, nothing_else, may_go_on)


def newest_model(workspace: Workspace, collection: Collection) -> Model:
    """The collection's newest model; NotFoundError if there is none."""
    model = workspace.catalog.latest_model(collection.id)
    if model is None:
        raise NotFoundError(f"collection {collection.name!r} has no model yet; run `partwise train`")
    return model


def refinement_parameters(workspace: Workspace, model: Model) -> RefinementParameters:
    """Those of `partwise.toml`, with the smoothness that the model's training chose where it chose one."""
    tuned = model.recipe.get("smoothness")
    return workspace.config.refine if tuned is None else replace(workspace.config.refine, smoothness=tuned)


def _meshes(shape_id: int, result: StagedResult, row: int) -> Published:
    role = MESH_ROLES.get(result.stage)
    if role is None:
        return Published()
    made = result.summary
    return Published(meshes=(NewMesh(shape_id, made["mesh_hash"], made["n_vertices"], made["n_faces"], row, role),))


def _run(
    workspace: Workspace,
    collection: Collection,
    stages: Sequence[Stage],
    earlier: Sequence[Stage],
    on_progress: OnRunProgress,
    on_event: OnEvent,
    also_publish: AlsoPublish,
    may_go_on: MayGoOn = always,
) -> RunProgress:
    n_total = sum(1 for _ in plan_tasks(workspace, collection, stages, earlier))
    on_progress(RunProgress(0, 0, n_total))
    result = RunProgress(0, 0, 0)
    if n_total:
        tasks = takewhile(lambda _: may_go_on(), plan_tasks(workspace, collection, stages, earlier))
        result = run_tasks(workspace, stages, tasks, n_total, on_progress, on_event, also_publish)
    sweep_staging(workspace, collection, stages, earlier)
    return result


def run_tasks(
    workspace: Workspace,
    stages: Sequence[Stage],
    tasks: Iterator[ShapeTask],
    n_total: int,
    on_progress: OnRunProgress,
    on_event: OnEvent,
    also_publish: AlsoPublish,
) -> RunProgress:
    """One run over planned tasks, `n_total` of them at most, on the connected Ray or one of its own."""
    with connected():
        metrics = RunMetrics()

        def tell(event: RunEvent) -> None:
            metrics(event)
            on_event(event)

        def tell_progress(run: RunProgress) -> None:
            metrics.on_progress(run)
            on_progress(run)

        ws = workspace
        runner = StageRunner(ws.catalog, ws.arrays, ws.array_url, stages, ws.config.workers, also_publish, tell)
        try:
            return runner.run(tasks, n_total, tell_progress)
        finally:
            metrics.end()
