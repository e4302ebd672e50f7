"""Uploads: files that people send for ingest. They wait in the array store, in chunks, until they expire."""

from collections.abc import Sequence
from datetime import UTC, datetime, timedelta
from pathlib import Path, PurePosixPath

from partwise.errors import ConflictError, FileFormatError, NotFoundError, ParameterError
from partwise.io.archives import ARCHIVE_SUFFIXES, is_archive, plain_name
from partwise.io.read import MESH_SUFFIXES
from partwise.store.large_objects import (
    LargeObject,
    LargeObjectWriter,
    delete_large_object,
    expiring_key,
    find_large_object,
    find_unexpired,
    large_object_keys,
    read_chunks,
    sweep_expired,
)
from partwise.workspace.workspace import Workspace

UPLOADS = "uploads"


class UploadWriter:
    """An upload that is on its way. `finish` or `abandon` it."""

    def __init__(self, workspace: Workspace, key: str, name: str, person: str) -> None:
        self._arrays = workspace.arrays
        self._key = key
        self._writer = LargeObjectWriter(workspace.arrays, key)
        self._about = {"name": name, "person": person, "created_at": datetime.now(UTC).isoformat()}

    def write(self, data: bytes) -> None:
        """Appends."""
        self._writer.write(data)

    def finish(self) -> LargeObject:
        """The upload, whole."""
        return self._writer.finish(self._about)

    def abandon(self) -> None:
        """Leaves nothing of it."""
        delete_large_object(self._arrays, self._key)


def begin_upload(
    workspace: Workspace, collection_id: int, name: str, person: str, ttl: timedelta, max_open: int
) -> UploadWriter:
    """A place for a file that is about to come. Those that have expired are swept first.

    Parameters
    ----------
    name : of the file, which says what it is. ttl : how long it may wait to be ingested.
    max_open : uploads that a collection may have, those on their way among them.

    Raises
    ------
    ParameterError : the name is no plain one, or neither a mesh's nor an archive's.
    ConflictError : the collection has that many.
    """
    checked_upload_name(name)
    now = datetime.now(UTC)
    folder = _folder(collection_id)
    sweep_expired(workspace.arrays, folder, now)
    key = expiring_key(folder, now + ttl)
    workspace.arrays.put_bytes(f"{key}/begun", b"")  # counted from here on, so that many at once do not slip through
    n_open = len(large_object_keys(workspace.arrays, folder))
    if n_open > max_open:
        delete_large_object(workspace.arrays, key)
        raise ConflictError(
            f"a collection may have {max_open} uploads but has {n_open - 1}; ingest or delete one first"
        )
    return UploadWriter(workspace, key, name, person)


def uploads(workspace: Workspace, collection_id: int) -> Sequence[LargeObject]:
    """The collection's uploads that are whole and have not expired, those that expire first first."""
    now = datetime.now(UTC)
    found = []
    for key in large_object_keys(workspace.arrays, _folder(collection_id)):
        try:
            upload = find_large_object(workspace.arrays, key)
        except NotFoundError:  # on its way, or deleted meanwhile
            continue
        if upload.expires_at > now:
            found.append(upload)
    return found


def find_upload(workspace: Workspace, collection_id: int, upload_id: str) -> LargeObject:
    """An upload of the collection.

    Raises
    ------
    NotFoundError : it has none of this id, or no longer.
    """
    try:
        return find_unexpired(workspace.arrays, _folder(collection_id), upload_id)
    except NotFoundError as error:
        raise NotFoundError(
            f"there is no upload {upload_id[:80]!a} in this collection, or no longer; send the file again"
        ) from error


def fetch_upload(workspace: Workspace, upload: LargeObject, folder: Path) -> Path:
    """A copy of the upload in a folder, under its own name.

    Raises
    ------
    NotFoundError : it is gone. StoreError : it is damaged, or the store cannot be reached.
    """
    path = folder / checked_upload_name(upload.about["name"])
    with path.open("xb") as file:
        for chunk in read_chunks(workspace.arrays, upload):
            file.write(chunk)
    return path


def delete_upload(workspace: Workspace, upload: LargeObject) -> None:
    """Deletes it."""
    delete_large_object(workspace.arrays, upload.key)


def checked_upload_name(name: str) -> str:
    """The name itself if it is one step, and a mesh's or an archive's.

    Raises
    ------
    ParameterError : it is not.
    """
    try:
        is_plain = plain_name(name) == name and "/" not in name and not name.startswith(".")
    except FileFormatError as error:
        raise ParameterError(f"an upload's name is wrong: {error}") from error
    if not is_plain:
        raise ParameterError(
            f"an upload's name must be a file's without its folder but is {name!a:.80}; leave that out"
        )
    if not is_archive(name) and PurePosixPath(name).suffix.lower() not in MESH_SUFFIXES:
        known = ", ".join([*sorted(MESH_SUFFIXES), *ARCHIVE_SUFFIXES])
        raise ParameterError(f"an upload's name must end in one of {known} but is {name!a:.80}; convert the file")
    return name


def _folder(collection_id: int) -> str:
    return f"{UPLOADS}/{collection_id}"
