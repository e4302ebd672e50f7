"""/collections/{collection_id}/uploads, /ingest, /ingest-prefixes: how shapes get into a collection over HTTP.

A body is never held as a whole: it goes to the array store in chunks as it comes. Nothing is read from places that a
caller names, except below prefixes that the machine's operator has listed.
"""

from datetime import timedelta
from functools import partial
from typing import Annotated, Any

from anyio import CancelScope
from anyio.to_thread import run_sync
from fastapi import APIRouter, Path, Query, Request
from starlette.requests import ClientDisconnect

from partwise.store.large_objects import CHUNK_BYTES, EXPIRING_NAME
from partwise.store.records import JobKind
from partwise.workspace.ingest_prefixes import plain_relative
from partwise.workspace.uploads import UploadWriter, begin_upload, delete_upload, find_upload, uploads
from partwise_service.answering import AnswerRoute, waits_for_arrays
from partwise_service.array_places import in_array_place
from partwise_service.dependencies import (
    CatalogDep,
    Operator,
    ScopedCollection,
    ServiceDep,
    WorkspaceDep,
    require_all_scope,
)
from partwise_service.problems import ProblemError, ProblemKind
from partwise_service.schemas.base import NO_NUL
from partwise_service.schemas.jobs import JobOut
from partwise_service.schemas.uploads import IngestRequest, PrefixesOut, UploadOut, UploadsOut

MAX_NAME = 255
router = APIRouter(route_class=AnswerRoute, tags=["ingest"])
UploadName = Annotated[
    str, Query(min_length=1, max_length=MAX_NAME, description="The file's own name, such as scans.zip."), NO_NUL
]
UploadId = Annotated[str, Path(pattern=f"^{EXPIRING_NAME}$")]
_BINARY = {"application/octet-stream": {"schema": {"type": "string", "format": "binary"}}}
_BODY: dict[str, Any] = {"requestBody": {"required": True, "content": _BINARY}}


@router.get("/collections/{collection_id}/uploads")
@waits_for_arrays
def list_uploads(_caller: Operator, collection: ScopedCollection, workspace: WorkspaceDep) -> UploadsOut:
    """What waits to be ingested, those that expire first first."""
    return UploadsOut(items=[UploadOut.of(upload) for upload in uploads(workspace, collection.id)])


@router.post("/collections/{collection_id}/uploads", status_code=201, openapi_extra=_BODY)
async def send_upload(
    request: Request, caller: Operator, collection: ScopedCollection, open_service: ServiceDep, name: UploadName
) -> UploadOut:
    """Send a mesh, or a zip or tar.gz archive of meshes, as the body. It waits for /ingest until it expires.

    409 if too many wait already.
    """
    if request.headers.get("content-encoding", "identity").lower() != "identity":
        raise ProblemError(ProblemKind.MEDIA, "Send the file as it is, without a Content-Encoding.")
    settings, workspace = open_service.settings, open_service.workspace
    ttl = timedelta(hours=settings.upload_ttl_h)
    begin = partial(begin_upload, workspace, collection.id, name, caller.name, ttl, settings.max_uploads)
    writer = await in_array_place(begin)
    try:
        await _receive(request, writer)
        upload = await in_array_place(writer.finish)
    except BaseException:
        with CancelScope(shield=True):
            await in_array_place(writer.abandon)
        raise
    about = {"upload_id": upload.name, "name": name, "n_bytes": upload.n_bytes, "sha256": upload.sha256}
    audit = workspace.catalog.append_audit
    await run_sync(partial(audit, caller.name, "upload", f"collection {collection.id}", about))
    return UploadOut.of(upload)


@router.delete("/collections/{collection_id}/uploads/{upload_id}", status_code=204)
@waits_for_arrays
def remove_upload(caller: Operator, collection: ScopedCollection, workspace: WorkspaceDep, upload_id: UploadId) -> None:
    """Delete an upload. A job that is about to ingest it will fail."""
    delete_upload(workspace, find_upload(workspace, collection.id, upload_id))
    workspace.catalog.append_audit(
        caller.name, "delete upload", f"collection {collection.id}", {"upload_id": upload_id}
    )


@router.get("/ingest-prefixes")
def list_prefixes(caller: Operator, open_service: ServiceDep) -> PrefixesOut:
    """Folders of the machine below which the caller may ingest, by name: none without a token for all collections."""
    return PrefixesOut(items=sorted(open_service.settings.ingest_prefixes) if caller.sees_all else [])


@router.post("/collections/{collection_id}/ingest", status_code=201)
def ingest(
    caller: Operator,
    collection: ScopedCollection,
    open_service: ServiceDep,
    catalog: CatalogDep,
    wish: IngestRequest,
) -> JobOut:
    """Have a worker take the meshes of an upload, or of what is below a prefix, into the collection.

    Prefixes are for operators of all collections, as files of any may lie there.
    """
    if (wish.upload_id is None) == (wish.prefix is None) or (wish.path is not None and wish.prefix is None):
        raise ProblemError(ProblemKind.INVALID, "Give either `upload_id`, or `prefix` and perhaps a `path` below it.")
    if wish.upload_id is not None:
        upload = find_upload(open_service.workspace, collection.id, wish.upload_id)
        parameters = {"upload_id": upload.name, "name": upload.about["name"]}
    else:
        require_all_scope(caller)
        if wish.prefix not in open_service.settings.ingest_prefixes:
            raise ProblemError(ProblemKind.NOT_FOUND, "There is no such prefix; see /ingest-prefixes.")
        parameters = {"prefix": wish.prefix, "path": plain_relative(wish.path or "")}
    job = catalog.enqueue_job(collection.id, JobKind.INGEST, parameters)
    catalog.append_audit(caller.name, "enqueue", f"job {job.id}", {"kind": job.kind.value, **parameters})
    return JobOut.of(job, caller.role)


async def _receive(request: Request, writer: UploadWriter) -> None:
    """The body, a chunk at a time, no faster than the store takes it."""
    body, pending, n_bytes = request.stream(), bytearray(), 0
    try:
        while True:
            piece = await anext(body, None)
            if piece is None:
                break
            pending += piece
            n_bytes += len(piece)
            if len(pending) >= CHUNK_BYTES:
                await in_array_place(partial(writer.write, bytes(pending)))
                pending.clear()
    except ClientDisconnect as error:
        raise ProblemError(ProblemKind.MALFORMED, "The upload was broken off; send it again.") from error
    if not n_bytes:
        raise ProblemError(ProblemKind.INVALID, "An upload must have a body: the file's bytes, as they are.")
    await in_array_place(partial(writer.write, bytes(pending)))
