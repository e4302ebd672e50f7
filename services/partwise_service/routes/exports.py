"""/jobs/{job_id}/download: the archive that a job of kind `export` has made."""

import re
from typing import Any

from fastapi import APIRouter
from fastapi.responses import StreamingResponse

from partwise.errors import ConflictError, NotFoundError
from partwise.store.large_objects import read_chunks
from partwise.store.records import Collection, Job, JobKind, JobState
from partwise.workspace.export_archive import find_export
from partwise_service.answering import AnswerRoute, waits_for_arrays
from partwise_service.array_places import in_array_places
from partwise_service.dependencies import Operator, WorkspaceDep, visible_collection
from partwise_service.routes.jobs import ScopedJob

ZIP = "application/zip"
DOWNLOAD = "download"
"""In a job's result: which export it made."""
_RESPONSES: dict[int | str, dict[str, Any]] = {
    200: {"content": {ZIP: {"schema": {"type": "string", "format": "binary"}}}, "description": "The archive."}
}
_UNUSUAL = re.compile(r"[^A-Za-z0-9_-]+")
_MAX_STEM = 60
router = APIRouter(route_class=AnswerRoute, tags=["jobs"])


@router.get("/jobs/{job_id}/download", responses=_RESPONSES, response_class=StreamingResponse)
@waits_for_arrays
def download_export(caller: Operator, workspace: WorkspaceDep, job: ScopedJob) -> StreamingResponse:
    """The archive of an export. 409 unless the job is done; 404 once the archive has expired."""
    if job.kind is not JobKind.EXPORT:
        raise NotFoundError(f"job {job.id} makes nothing to download; exports do")
    if job.state is not JobState.DONE:
        raise ConflictError(f"an export is downloaded when it is done but job {job.id} is {job.state}; wait for it")
    found = find_export(workspace, job.collection_id, str((job.result or {}).get(DOWNLOAD, "")))
    collection = visible_collection(workspace.catalog, caller, job.collection_id)
    headers = {
        "Content-Disposition": f'attachment; filename="{file_name(collection, job)}"',
        "Content-Length": str(found.n_bytes),
    }
    return StreamingResponse(in_array_places(read_chunks(workspace.arrays, found)), media_type=ZIP, headers=headers)


def file_name(collection: Collection, job: Job) -> str:
    """A name of letters, digits, - and _, whatever the collection is called, so that no header or shell trips on it."""
    stem = _UNUSUAL.sub("-", collection.name).strip("-")[:_MAX_STEM] or "collection"
    return f"{stem}-{job.id}.zip"
