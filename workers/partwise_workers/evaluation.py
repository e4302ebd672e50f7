"""Evaluation in the background: shapes in an order of the caller's, each cut right after it is predicted.

Unlike the passes, which go through a collection by id and count beforehand, it begins at once, as a collection may be
too large for a model to see it all before the next one.
"""

from collections.abc import Iterator, Sequence
from itertools import chain

from partwise.store.records import Collection, Model
from partwise.workspace.progress import OnRunProgress, RunProgress
from partwise.workspace.shapes import PAGE
from partwise.workspace.workspace import Workspace
from partwise_workers.events import OnEvent
from partwise_workers.model_store import ModelReference
from partwise_workers.passes import MayGoOn, refinement_parameters, run_tasks, scores_of
from partwise_workers.plan import description_stages, plan_page
from partwise_workers.stage import Stage
from partwise_workers.stages.evaluate import EvaluateStage
from partwise_workers.stages.refine import RefineStage
from partwise_workers.staging import sweep_staging
from partwise_workers.tasks import ShapeTask


def evaluate_in_order(
    workspace: Workspace,
    collection: Collection,
    model: Model,
    shape_ids: Sequence[int],
    on_progress: OnRunProgress,
    on_event: OnEvent,
    may_go_on: MayGoOn,
) -> RunProgress:
    """Lets the model predict, score and cut shapes that it has not seen, in this order, until it is stopped.

    Results are seen block by block. The total is what is left to look at; it falls by what needs nothing.

    Raises
    ------
    StoreError : a store is full or cannot be reached; what is finished is kept for the next run.
    WorkerError : Ray or its processes cannot be started.
    """
    stages = (
        EvaluateStage(ModelReference.of(model)),
        RefineStage(refinement_parameters(workspace, model), model.version),
    )
    earlier = description_stages(workspace, collection)
    plan = _Plan(workspace, shape_ids, stages, earlier, may_go_on)
    tasks = iter(plan)
    first = next(tasks, None)
    result = RunProgress(0, 0, 0)
    if first is not None:
        result = run_tasks(
            workspace,
            stages,
            chain([first], tasks),
            plan.n_left,
            lambda run: on_progress(RunProgress(run.n_done, run.n_failed, plan.n_left)),
            on_event,
            scores_of(model),
        )
    sweep_staging(workspace, collection, stages, earlier)
    return RunProgress(result.n_done, result.n_failed, plan.n_left)


class _Plan:
    """Tasks of shapes in order, read from the catalog as they are taken. n_left : tasks and shapes not looked at."""

    def __init__(
        self,
        workspace: Workspace,
        shape_ids: Sequence[int],
        stages: Sequence[Stage],
        earlier: Sequence[Stage],
        may_go_on: MayGoOn,
    ) -> None:
        self._workspace = workspace
        self._shape_ids = shape_ids
        self._stages = stages
        self._earlier = earlier
        self._may_go_on = may_go_on
        self.n_left = len(shape_ids)

    def __iter__(self) -> Iterator[ShapeTask]:
        for start in range(0, len(self._shape_ids), PAGE):
            ids = self._shape_ids[start : start + PAGE]
            known = self._workspace.catalog.shapes_by_id(ids)
            page = [known[shape_id] for shape_id in ids if shape_id in known]
            tasks = list(plan_page(self._workspace, page, self._stages, self._earlier))
            self.n_left -= len(ids) - len(tasks)
            for task in tasks:
                if not self._may_go_on():
                    return
                yield task
