"""/collections/{collection_id}/ops, /rounds, /skips, /ops/people: how a collection is doing."""

from collections.abc import Mapping, Sequence
from dataclasses import replace
from datetime import UTC, datetime, timedelta
from typing import Annotated

from fastapi import APIRouter, Query

from partwise.store.catalog import Catalog
from partwise.store.records import Job, JobKind, JobState, SeenWorker, StageCount
from partwise.store.reviews import FOR_REVIEWERS
from partwise.workspace.disk import free_bytes
from partwise.workspace.segmentations import DESCRIBE, EVALUATE, PICTURE, REFINE, REMESH
from partwise.workspace.status import STAGE_ORDER
from partwise.workspace.workspace import Workspace
from partwise_service.answering import AnswerRoute
from partwise_service.dependencies import (
    CatalogDep,
    Operator,
    Reviewer,
    ScopedCollection,
    ServiceDep,
    visible_collection,
)
from partwise_service.schemas.base import MAX_ROW_ID
from partwise_service.schemas.operations import (
    BlockFigures,
    DiskFigures,
    FreshnessRow,
    LeaseFigures,
    OpsOut,
    PeopleOps,
    PersonOps,
    QueueFigures,
    RoundOut,
    RoundsOut,
    SkipOut,
    SkipsPage,
    StageFigures,
    WorkerFigures,
    WorkerUsageOut,
)

MAX_WORKERS = 100
MAX_PAGE = 500
WINDOW = timedelta(minutes=15)
SEEN_WITHIN = timedelta(minutes=1)
COUNTED_STAGES: Mapping[JobKind, tuple[str, ...]] = {
    JobKind.PREPROCESS: (REMESH, DESCRIBE, PICTURE),
    JobKind.REFINE: (REFINE,),
}
"""What jobs do again after a change of settings. Reading a file has none; evaluations are counted by their model."""

router = APIRouter(route_class=AnswerRoute, tags=["operations"])


@router.get("/collections/{collection_id}/ops")
def show_ops(_caller: Operator, service: ServiceDep, collection: ScopedCollection) -> OpsOut:
    """How the collection is doing: stages and their pace, failures, queue and leases, scores, disk, workers."""
    return service.ops.get(collection.id, lambda: _measured(service.workspace, collection.id))


@router.get("/collections/{collection_id}/rounds")
def list_rounds(_caller: Operator, collection: ScopedCollection, catalog: CatalogDep) -> RoundsOut:
    """Model by model: what it took, how unsure it was of all shapes that it scored, how right people were meanwhile."""
    score_name = catalog.ranking_score(collection.id)
    found = catalog.model_rounds(collection.id, score_name)
    return RoundsOut(score_name=score_name, items=[RoundOut.of(each) for each in found])


@router.get("/collections/{collection_id}/skips")
def list_skips(
    _caller: Reviewer,
    collection: ScopedCollection,
    catalog: CatalogDep,
    before: Annotated[int | None, Query(ge=1, le=MAX_ROW_ID, description="`next` of the page before.")] = None,
    limit: Annotated[int, Query(ge=1, le=MAX_PAGE)] = 100,
) -> SkipsPage:
    """Shapes that people gave back for good, and why, those that were handed out last first."""
    found = catalog.skips(collection.id, before=before, limit=limit)
    next_before = str(found[-1].lease_id) if len(found) == limit else None
    return SkipsPage(items=[SkipOut.model_validate(each) for each in found], next=next_before)


@router.get("/ops/people")
def show_people_at_work(
    caller: Operator,
    catalog: CatalogDep,
    collection: Annotated[int, Query(ge=1, le=MAX_ROW_ID, description="A collection's id.")],
    days: Annotated[float, Query(gt=0, le=3_660, description="How far back.")] = 30.0,
) -> PeopleOps:
    """How much people label, how fast, and how right they are."""
    found = visible_collection(catalog, caller, collection)
    since = datetime.now(UTC) - timedelta(days=days)
    return PeopleOps(days=days, items=[PersonOps.of(each) for each in catalog.person_figures(found.id, since)])


def _measured(workspace: Workspace, collection_id: int) -> OpsOut:
    catalog, now = workspace.catalog, datetime.now(UTC)
    depth, model = catalog.queue_depth(collection_id), catalog.latest_model(collection_id)
    leases, score_name = catalog.lease_counts(collection_id), catalog.ranking_score(collection_id)
    states, blocks = dict(catalog.state_counts(collection_id)), catalog.block_totals()
    array_bytes = sum(each.n_bytes for each in blocks)
    return OpsOut(
        measured_at=now,
        states=states,
        stages=_stages(catalog, collection_id, sum(states.values()), now),
        window_min=WINDOW.total_seconds() / 60,
        failures=dict(catalog.failure_kinds(collection_id)),
        queue=QueueFigures(free=depth.n_free, held=depth.n_held, assigned=depth.n_assigned, oldest_at=depth.oldest_at),
        leases=LeaseFigures(
            held=leases.n_active, prefetched=leases.n_prefetched, expired=leases.n_expired, people=leases.n_people
        ),
        model_version=None if model is None else model.version,
        score_name=score_name,
        freshness=_freshness(catalog, collection_id, score_name),
        open_reviews=catalog.count_open_reviews(collection_id, reasons=FOR_REVIEWERS),
        blocks=[BlockFigures(kind=each.kind, blocks=each.n_blocks, bytes=each.n_bytes) for each in blocks],
        disk=DiskFigures(
            database_bytes=catalog.database_bytes(), array_bytes=array_bytes, free_bytes=free_bytes(workspace.array_url)
        ),
        workers=_workers(catalog, collection_id, now),
    )


def _stages(catalog: Catalog, collection_id: int, n_shapes: int, now: datetime) -> list[StageFigures]:
    counts = _present_counts(catalog, collection_id)
    paces = catalog.stage_paces(collection_id, now - WINDOW)
    running = catalog.jobs(collection_id, state=JobState.RUNNING, limit=MAX_WORKERS)
    made = []
    for each in sorted(counts.values(), key=lambda each: _position(each.stage)):
        n_reaching = _n_reaching(each.stage, counts, n_shapes)
        remaining = max(0, n_reaching - each.n_done - each.n_failed)
        if each.stage in paces:
            remaining = max(remaining, _n_redone(each.stage, running))
        done = min(each.n_done, max(0, n_reaching - each.n_failed - remaining))
        per_min = paces.get(each.stage, 0) / (WINDOW.total_seconds() / 60)
        eta_s = 0.0 if not remaining else (60 * remaining / per_min if per_min else None)
        figures = {"done": done, "failed": each.n_failed, "remaining": remaining}
        made.append(StageFigures(stage=each.stage, **figures, per_min=per_min, eta_s=eta_s))
    return made


def _present_counts(catalog: Catalog, collection_id: int) -> dict[str, StageCount]:
    """How far each stage is. What an older model predicted is there until the newest has, but it is not done."""
    counts = {each.stage: each for each in catalog.stage_counts(collection_id)}
    model = catalog.latest_model(collection_id)
    by_newest = {} if model is None else catalog.stages_of_model(collection_id, model.version)
    of_models = {stage: counts[stage] for stage in (EVALUATE, REFINE) if stage in counts}
    return counts | {stage: replace(each, n_done=by_newest.get(stage, 0)) for stage, each in of_models.items()}


def _n_redone(stage: str, running: Sequence[Job]) -> int:
    """How many shapes a job at this stage has yet to finish: where settings changed, it does again what is on record.

    Those jobs count beforehand the shapes that need any of their stages.
    """
    totals = [job.progress for job in running if stage in COUNTED_STAGES.get(job.kind, ())]
    return sum(max(0, (each.n_total or 0) - each.n_done - each.n_failed) for each in totals)


def _n_reaching(stage: str, counts: Mapping[str, StageCount], n_shapes: int) -> int:
    """How many shapes come to a stage in the end: those that no stage before it has given up."""
    begins_with = n_shapes
    before = STAGE_ORDER[: _position(stage)]
    if stage in (EVALUATE, REFINE):  # of what is described, pictured or not
        begins_with = counts[DESCRIBE].n_done if DESCRIBE in counts else 0
        before = (EVALUATE,) if stage == REFINE else ()
    return begins_with - sum(counts[each].n_failed for each in before if each in counts)


def _freshness(catalog: Catalog, collection_id: int, score_name: str) -> list[FreshnessRow]:
    counts = catalog.scored_by(collection_id, score_name)
    n_scored = sum(counts.values())
    return [
        FreshnessRow(model_version=version, shapes=counts[version], share=counts[version] / n_scored)
        for version in sorted(counts, reverse=True)
    ]


def _workers(catalog: Catalog, collection_id: int, now: datetime) -> list[WorkerFigures]:
    """Those that are there, and those that have fallen silent at a job of the collection."""
    seen = {each.owner: each for each in catalog.workers(now - SEEN_WITHIN)}
    jobs = {job.owner or "": job for job in catalog.jobs(collection_id, state=JobState.RUNNING, limit=MAX_WORKERS)}
    return [_worker(owner, seen.get(owner), jobs.get(owner), now) for owner in sorted(seen.keys() | jobs.keys())]


def _worker(owner: str, seen: SeenWorker | None, job: Job | None, now: datetime) -> WorkerFigures:
    signs = [None if job is None else job.heartbeat_at, None if seen is None else seen.seen_at]
    last = max((sign for sign in signs if sign is not None), default=None)
    return WorkerFigures(
        owner=owner,
        is_busy=job is not None or (seen is not None and seen.is_busy),
        job_id=None if job is None else job.id,
        job_kind=None if job is None else job.kind,
        silent_s=None if last is None else max(0.0, (now - last).total_seconds()),
        done=None if job is None else job.progress.n_done,
        total=None if job is None else job.progress.n_total,
        usage=None if seen is None else WorkerUsageOut.model_validate(seen.usage),
    )


def _position(stage: str) -> int:
    return STAGE_ORDER.index(stage) if stage in STAGE_ORDER else len(STAGE_ORDER)
