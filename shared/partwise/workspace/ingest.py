"""Ingest: a row and a content hash per file, and a copy of the file in the array store."""

import hashlib
import logging
import os
from collections.abc import Iterator
from dataclasses import dataclass
from itertools import islice
from pathlib import Path

from partwise.errors import FileFormatError, NotFoundError
from partwise.io.read import MESH_SUFFIXES, read_bytes
from partwise.store.records import Collection, IngestOutcome, NewShape
from partwise.workspace.progress import OnRunProgress, RunProgress
from partwise.workspace.workspace import Workspace

logger = logging.getLogger(__name__)

BATCH = 256
"""Files whose rows are committed together."""


@dataclass(frozen=True, slots=True)
class RefusedFile:
    """A file that was not ingested, and why, in one line."""

    source_key: str
    reason: str


@dataclass(frozen=True, slots=True)
class IngestReport:
    """What became of a folder's mesh files."""

    n_added: int
    n_unchanged: int
    n_changed: int
    refused: tuple[RefusedFile, ...]


def source_object(source_hash: str, source_suffix: str) -> str:
    """Where the array store keeps an ingested file: by content, so that copies share one object."""
    return f"sources/{source_hash[:2]}/{source_hash}{source_suffix}"


def ingest_folder(
    workspace: Workspace, collection: Collection, folder: Path, on_progress: OnRunProgress = lambda _: None
) -> IngestReport:
    """Ingests every mesh file below the folder, by its relative path. Safe to repeat: what is known is left alone.

    A file that cannot be read, is empty, or would change under a confirmed shape is refused; the rest goes on.
    Progress is told after each file that was copied; a file counts as failed if it was refused.

    Raises
    ------
    NotFoundError : there is no such folder, or no mesh file in it.
    """
    if not folder.is_dir():
        raise NotFoundError(f"ingest needs a folder but {folder} is not one; check the path")
    counts = dict.fromkeys(IngestOutcome, 0)
    refused: list[RefusedFile] = []
    files = list(_outside(mesh_files(folder), workspace.array_url))
    n_seen = 0
    for paths in _batches(iter(files)):
        new_shapes: list[NewShape] = []
        for path in paths:
            key = path.relative_to(folder).as_posix()
            try:
                new_shapes.append(_copy(workspace, path, key))
            except FileFormatError as error:
                refused.append(RefusedFile(key, str(error)))
            n_seen += 1
            on_progress(RunProgress(n_seen - len(refused), len(refused), len(files)))
        for ingested in workspace.catalog.add_shapes(collection.id, new_shapes):
            counts[ingested.outcome] += 1
            if ingested.outcome is IngestOutcome.CONFLICT:
                why = "a labelled shape's file must stay as it is but has changed; ingest it under another name"
                refused.append(RefusedFile(ingested.source_key, f"{ingested.source_key}: {why}"))
    if not refused and not any(counts.values()):
        raise NotFoundError(f"ingest needs mesh files ({', '.join(sorted(MESH_SUFFIXES))}) but {folder} has none")
    return IngestReport(
        counts[IngestOutcome.ADDED], counts[IngestOutcome.UNCHANGED], counts[IngestOutcome.CHANGED], tuple(refused)
    )


def mesh_files(folder: Path) -> Iterator[Path]:
    """Mesh files below a folder, in order of path; links and what is hidden are passed over, unreadable folders too.

    One folder is listed at a time: collections come with many more files than meshes.
    """
    try:
        with os.scandir(folder) as entries:
            seen = sorted((entry for entry in entries if not entry.name.startswith(".")), key=lambda entry: entry.name)
    except PermissionError:
        logger.warning("a folder cannot be read", extra={"folder": str(folder)})
        return
    for entry in seen:
        if entry.is_dir(follow_symlinks=False):
            yield from mesh_files(folder / entry.name)
        elif entry.is_file(follow_symlinks=False) and Path(entry.name).suffix.lower() in MESH_SUFFIXES:
            yield folder / entry.name


def _outside(paths: Iterator[Path], array_url: str) -> Iterator[Path]:
    """Leaves out the array store's own copies, where the store lies in the folder that is being ingested."""
    root = array_url.removeprefix("file://")
    return (path for path in paths if "://" in root or not path.resolve().is_relative_to(root))


def _batches(paths: Iterator[Path]) -> Iterator[list[Path]]:
    while batch := list(islice(paths, BATCH)):
        yield batch


def _copy(workspace: Workspace, path: Path, key: str) -> NewShape:
    if not key.isprintable():  # also what is not UTF-8, which the catalog could not hold
        raise FileFormatError(f"{key!a}: a file's name must be printable UTF-8; rename the file")
    try:
        data = read_bytes(path)
    except FileFormatError as error:
        raise FileFormatError(f"{key}: {error}") from error
    if not data.strip():
        raise FileFormatError(f"{key}: a mesh file must have content but is empty; was the download cut off?")
    new_shape = NewShape(key, hashlib.sha256(data).hexdigest(), path.suffix.lower())
    target = source_object(new_shape.source_hash, new_shape.source_suffix)
    if not workspace.arrays.exists(target):
        workspace.arrays.put_bytes(target, data)
    return new_shape
