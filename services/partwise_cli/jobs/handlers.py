"""What each kind of job does. `HANDLERS` is the list of them."""

from collections.abc import Mapping, Sequence
from contextlib import suppress

from partwise.errors import NotEnoughDataError, NotFoundError
from partwise.store.records import FirstShape, JobKind, Model
from partwise.workspace.first_shapes import select_first_shapes
from partwise.workspace.placed_shapes import PlacedShapes, place_new_shapes, read_placed
from partwise.workspace.progress import RunProgress
from partwise.workspace.ranking import make_orderings, refill_queue
from partwise.workspace.relabel import MoveReport
from partwise.workspace.segmentations import DESCRIBE
from partwise.workspace.similarity import most_similar_first
from partwise_cli.jobs.export import export
from partwise_cli.jobs.ingest import ingest
from partwise_cli.jobs.reranking import Reranking
from partwise_cli.jobs.stage_events import StageTally
from partwise_cli.jobs.turns import Turn
from partwise_cli.jobs.work import Handler, Outcome, Work

N_CLUSTERS, N_PER_CLUSTER, SEED = 5, 2, 0
"""Of the first selection, as `partwise select` makes it unless told otherwise."""


def preprocess(work: Work) -> Outcome:
    """Mends, describes and places what is new. A model, if there is one, then predicts; until then some come first."""
    from partwise_workers.passes import preprocess as run

    work.connect()
    turn, stages, moves = Turn(work), StageTally(work), list[MoveReport]()
    result = run(work.workspace, work.collection, work.tell, stages.on_event, moves.append, turn.may_go_on)
    stages.flush()
    turn.raise_if_over()
    catalog = work.workspace.catalog
    _embed(work)
    Reranking(work).rank()
    make_orderings(work.workspace, work.collection)
    if catalog.latest_model(work.collection.id) is not None:
        catalog.enqueue_job(work.collection.id, JobKind.EVALUATE)
    moved = {"n_moved": moves[0].n_moved, "n_in_review": moves[0].n_in_review} if moves else {}
    return _outcome("preprocessed", result.n_done, result.n_failed, moved)


def _embed(work: Work) -> None:
    """Embeds the collection as soon as there is anything to choose from, and anew once it has doubled.

    What is described in between is placed in the embedding that there is.
    """
    placed = _placed(work)
    if placed is None or _n_described(work) >= 2 * placed.n_fitted:
        with suppress(NotEnoughDataError):  # shapes that are all alike are as good first as any other
            _select(work, placed)
            return
    if placed is not None:
        try:
            place_new_shapes(work.workspace, work.collection)
        except NotFoundError:  # what was fitted is lost: shapes are nowhere to be placed
            _select(work, placed)


def select(work: Work) -> Outcome:
    """Embeds the collection anew and chooses the first shapes from it."""
    firsts = _select(work, _placed(work))
    Reranking(work).rank()
    make_orderings(work.workspace, work.collection)
    return Outcome(f"the map is drawn, and {_shapes(len(firsts))} chosen to be labelled first")


def _select(work: Work, before: PlacedShapes | None) -> Sequence[FirstShape]:
    """As many clusters as before, unless there were too few shapes for more."""
    n_clusters, n_per_cluster, n_described = N_CLUSTERS, N_PER_CLUSTER, _n_described(work)
    if before is not None and before.n_fitted >= N_CLUSTERS * N_PER_CLUSTER:
        n_clusters = before.n_clusters
        n_per_cluster = max(1, len(work.workspace.catalog.first_shapes(work.collection.id)) // n_clusters)
    n_clusters = max(1, min(n_clusters, n_described // n_per_cluster))

    def on_progress(run: RunProgress) -> None:
        work.tell(run)
        work.pulse.raise_if_stopped()

    return select_first_shapes(work.workspace, work.collection, n_clusters, n_per_cluster, SEED, on_progress)


def _placed(work: Work) -> PlacedShapes | None:
    found = work.workspace.catalog.embedding(work.collection.id)
    return None if found is None else read_placed(work.workspace, found.key)


def _n_described(work: Work) -> int:
    counts = work.workspace.catalog.stage_counts(work.collection.id)
    return next((each.n_done for each in counts if each.stage == DESCRIBE), 0)


def train(work: Work) -> None:
    """Trains on what is confirmed; the model, the job's end and the evaluation to come are one transaction."""
    from partwise_workers.training import trained_model

    def on_progress(n_done: int, n_total: int) -> None:
        work.tell(RunProgress(n_done, 0, n_total))
        work.pulse.raise_if_stopped()

    work.connect()
    model = trained_model(work.workspace, work.collection, on_progress, work.on_event)
    work.workspace.catalog.finish_training(work.job.id, work.owner, model)


def evaluate(work: Work) -> Outcome:
    """Lets the newest model predict, score and cut all it has not seen, most like the newly confirmed first.

    A newer model makes the rest moot: it goes on with that one.
    """
    work.connect()
    reranking, n_done, n_failed = Reranking(work), 0, 0
    while True:
        model = _newest_model(work)
        result = _evaluate_with(work, model, reranking)
        n_done, n_failed = n_done + result.n_done, n_failed + result.n_failed
        if _newest_model(work).id == model.id:
            break
    make_orderings(work.workspace, work.collection)
    return _outcome(f"evaluated by model version {model.version}", n_done, n_failed)


def _evaluate_with(work: Work, model: Model, reranking: Reranking) -> RunProgress:
    from partwise_workers.evaluation import evaluate_in_order

    turn = Turn(work, lambda: _newest_model(work).id != model.id)
    stages = StageTally(work)

    def on_progress(run: RunProgress) -> None:
        work.tell(run)
        reranking.now_and_then()

    shape_ids = most_similar_first(work.workspace, work.collection, model)
    result = evaluate_in_order(
        work.workspace, work.collection, model, shape_ids, on_progress, stages.on_event, turn.may_go_on
    )
    stages.flush()
    reranking.rank()
    turn.raise_if_over()
    return result


def _newest_model(work: Work) -> Model:
    from partwise_workers.passes import newest_model

    return newest_model(work.workspace, work.collection)


def refine(work: Work) -> Outcome:
    """Cuts what the newest model has predicted, where that is missing or was done with other parameters."""
    from partwise_workers.passes import refine as run

    work.connect()
    turn, stages = Turn(work), StageTally(work)
    result = run(work.workspace, work.collection, work.tell, stages.on_event, turn.may_go_on)
    stages.flush()
    turn.raise_if_over()
    return _outcome("refined", result.n_done, result.n_failed)


def refill(work: Work) -> Outcome:
    """Brings the queue in line with the number of labels that a shape is to get."""
    refill_queue(work.workspace, work.collection)
    return Outcome("the queue has as many places as labels are wanted")


def _outcome(what: str, n_done: int, n_failed: int, more: Mapping[str, int] | None = None) -> Outcome:
    return Outcome(
        f"{_shapes(n_done)} {what}, {n_failed:,} failed", {"n_done": n_done, "n_failed": n_failed, **(more or {})}
    )


def _shapes(n: int) -> str:
    return "1 shape" if n == 1 else f"{n:,} shapes"


HANDLERS: Mapping[JobKind, Handler] = {
    JobKind.PREPROCESS: preprocess,
    JobKind.TRAIN: train,
    JobKind.EVALUATE: evaluate,
    JobKind.REFINE: refine,
    JobKind.SELECT: select,
    JobKind.REFILL: refill,
    JobKind.INGEST: ingest,
    JobKind.EXPORT: export,
}
"""What a worker can do: it takes jobs of these kinds. Modules of handlers load Ray and torch when they need them."""
