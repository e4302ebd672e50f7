"""/collections/{collection_id}/failures: shapes that a stage gave up, and trying them again."""

from typing import Annotated

from fastapi import APIRouter, Query

from partwise.store.records import FailureKind, JobKind
from partwise.workspace.segmentations import EVALUATE, REFINE
from partwise_service.answering import AnswerRoute
from partwise_service.dependencies import CatalogDep, Operator, ScopedCollection
from partwise_service.schemas.base import MAX_ROW_ID, Page
from partwise_service.schemas.failures import FailureOut, Retried, Retry
from partwise_service.schemas.jobs import JobOut

MAX_PAGE = 500
JOB_OF_STAGE = {EVALUATE: JobKind.EVALUATE, REFINE: JobKind.REFINE}
"""Which job runs a stage; all others are of preprocessing, which is followed by what depends on it."""
router = APIRouter(prefix="/collections/{collection_id}/failures", route_class=AnswerRoute, tags=["failures"])


@router.get("")
def list_failures(
    _caller: Operator,
    collection: ScopedCollection,
    catalog: CatalogDep,
    kind: FailureKind | None = None,
    stage: Annotated[str | None, Query(pattern="^[a-z_]{1,64}$")] = None,
    after: Annotated[int, Query(ge=0, le=MAX_ROW_ID, description="`next` of the page before.")] = 0,
    limit: Annotated[int, Query(ge=1, le=MAX_PAGE)] = 100,
) -> Page[FailureOut]:
    """A page of failures, in the order in which they were recorded. Their logs are with each shape."""
    found = catalog.failures(collection.id, stage=stage, kind=kind, after=after, limit=limit)
    has_more = len(found) == limit
    return Page(items=[FailureOut.of(each) for each in found], next=str(found[-1].run.id) if has_more else None)


@router.post("/retry")
def retry_failures(caller: Operator, collection: ScopedCollection, catalog: CatalogDep, which: Retry) -> Retried:
    """Forget failures and ask for the job that tries those shapes again."""
    n_retried = catalog.clear_failures(
        collection.id, which.stage, which.shape_ids, kind=which.kind, reason_contains=which.text
    )
    if not n_retried:
        return Retried(n_retried=0, job=None)
    job = catalog.enqueue_job(collection.id, JOB_OF_STAGE.get(which.stage or "", JobKind.PREPROCESS))
    catalog.append_audit(caller.name, "retry failures", f"collection {collection.id}", {"n_retried": n_retried})
    return Retried(n_retried=n_retried, job=JobOut.of(job, caller.role))
