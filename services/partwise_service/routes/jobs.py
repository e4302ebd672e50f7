"""/collections/{collection_id}/jobs, /jobs/{job_id}: what the workers do, and what they are asked to do."""

from typing import Annotated

from fastapi import APIRouter, Body, Depends, Query

from partwise.errors import NotFoundError
from partwise.store.records import Job, JobKind, JobState, Role
from partwise_service.answering import AnswerRoute
from partwise_service.dependencies import Caller, CatalogDep, ScopedCollection, require_role
from partwise_service.schemas.base import MAX_ROW_ID, RowId
from partwise_service.schemas.exports import NewExport
from partwise_service.schemas.jobs import JobOut, JobsPage, NewJob
from partwise_service.security.identity import Identity

MAX_PAGE = 500
router = APIRouter(route_class=AnswerRoute, tags=["jobs"])

Before = Annotated[int | None, Query(ge=1, le=MAX_ROW_ID, description="`next` of the page before.")]
Limit = Annotated[int, Query(ge=1, le=MAX_PAGE, description="Jobs of a page, at most.")]


def scoped_job(job_id: RowId, caller: Caller, catalog: CatalogDep) -> Job:
    """The job in the path, if the caller may know of it."""
    try:
        found = catalog.job(job_id)
    except NotFoundError:
        found = None
    if found is None or not caller.may_see(found.collection_id):
        raise NotFoundError(f"there is no job {job_id}; see /collections/…/jobs")
    return found


ScopedJob = Annotated[Job, Depends(scoped_job)]


def require_job_role(caller: Identity, kind: JobKind) -> None:
    """403 unless the caller may begin and end jobs of this kind: reviewers trainings, operators all."""
    require_role(caller, Role.REVIEWER if kind is JobKind.TRAIN else Role.OPERATOR)


@router.get("/collections/{collection_id}/jobs")
def list_jobs(
    caller: Caller,
    collection: ScopedCollection,
    catalog: CatalogDep,
    before: Before = None,
    limit: Limit = 100,
    state: JobState | None = None,
) -> JobsPage:
    """A page of the collection's jobs, newest first."""
    jobs = catalog.jobs(collection.id, before=before, limit=limit, state=state)
    return JobsPage(
        items=[JobOut.of(job, caller.role) for job in jobs], next=str(jobs[-1].id) if len(jobs) == limit else None
    )


@router.post("/collections/{collection_id}/jobs", status_code=201)
def enqueue_job(
    caller: Caller,
    collection: ScopedCollection,
    catalog: CatalogDep,
    new: Annotated[NewJob | NewExport, Body(discriminator="kind")],
) -> JobOut:
    """Ask for work: `train` for reviewers, all kinds for operators. One that waits already is returned as it is."""
    require_job_role(caller, new.kind)
    job = catalog.enqueue_job(collection.id, new.kind, new.parameters.model_dump(mode="json"))
    catalog.append_audit(caller.name, "enqueue", f"job {job.id}", {"kind": job.kind.value})
    return JobOut.of(job, caller.role)


@router.get("/jobs/{job_id}")
def show_job(caller: Caller, job: ScopedJob) -> JobOut:
    """One job."""
    return JobOut.of(job, caller.role)


@router.post("/jobs/{job_id}/cancel")
def cancel_job(caller: Caller, job: ScopedJob, catalog: CatalogDep) -> JobOut:
    """End a job that waits, or ask for a running one to stop; what it has finished stays. 409 if it is over."""
    require_job_role(caller, job.kind)
    cancelled = catalog.cancel_job(job.id)
    catalog.append_audit(caller.name, "cancel", f"job {job.id}", {"kind": job.kind.value})
    return JobOut.of(cancelled, caller.role)


@router.post("/jobs/{job_id}/retry", status_code=201)
def retry_job(caller: Caller, job: ScopedJob, catalog: CatalogDep) -> JobOut:
    """Ask again for what a failed or cancelled job was to do, as a new job. 409 unless it ended so."""
    require_job_role(caller, job.kind)
    again = catalog.retry_job(job.id)
    catalog.append_audit(caller.name, "retry", f"job {job.id}", {"kind": job.kind.value, "job_id": again.id})
    return JobOut.of(again, caller.role)
