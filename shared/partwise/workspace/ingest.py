"""Ingest: a row and a content hash per file, and a copy of the file in the array store."""

import hashlib
import logging
import os
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from functools import partial
from pathlib import Path, PurePosixPath

from partwise.errors import FileFormatError, NotFoundError
from partwise.io.read import MESH_SUFFIXES, read_bytes
from partwise.store.records import Collection, IngestOutcome, NewShape
from partwise.workspace.partnet_folders import folder_bytes, folder_key, with_folders
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

    @property
    def is_empty(self) -> bool:
        """Whether no mesh file came at all."""
        return not (self.n_added or self.n_unchanged or self.n_changed or self.refused)


def source_object(source_hash: str, source_suffix: str) -> str:
    """Where the array store keeps an ingested file: by content, so that copies share one object."""
    return f"sources/{source_hash[:2]}/{source_hash}{source_suffix}"


def ingest_folder(
    workspace: Workspace, collection: Collection, folder: Path, on_progress: OnRunProgress = lambda _: None
) -> IngestReport:
    """Ingests every mesh file below the folder, by its relative path. Safe to repeat: what is known is left alone.

    A folder of PartNet is one shape, of the mesh of all its pieces.

    A file that cannot be read, is empty, or would change under a confirmed shape is refused; the rest goes on.
    Progress is told after each file that was copied; a file counts as failed if it was refused.

    Raises
    ------
    NotFoundError : there is no such folder, or no mesh file in it.
    """
    if not folder.is_dir():
        raise NotFoundError(f"ingest needs a file or a folder but {folder} is neither; check the path")
    files = list(with_folders(_outside(mesh_files(folder), workspace.array_url), folder))
    intake = Intake(workspace, collection, on_progress, len(files))
    for path in files:
        if path.is_dir():
            intake.take(folder_key(path, folder), partial(folder_bytes, path))
        else:
            intake.take(path.relative_to(folder).as_posix(), partial(read_bytes, path))
    report = intake.report()
    if report.is_empty:
        raise NotFoundError(f"ingest needs mesh files ({', '.join(sorted(MESH_SUFFIXES))}) but {folder} has none")
    return report


@dataclass(slots=True)
class Intake:
    """Takes files one after the other, and commits their rows in batches.

    n_planned : files that will come, 0 if nobody knows.
    """

    workspace: Workspace
    collection: Collection
    on_progress: OnRunProgress = lambda _: None
    n_planned: int = 0
    _counts: dict[IngestOutcome, int] = field(default_factory=lambda: dict.fromkeys(IngestOutcome, 0))
    _refused: list[RefusedFile] = field(default_factory=list)
    _batch: list[NewShape] = field(default_factory=list)
    _n_seen: int = 0
    _n_bad: int = 0

    def take(self, key: str, read: Callable[[], bytes]) -> None:
        """Copies a file, unless reading it, or its content or name, is refused."""
        try:
            self._batch.append(_copy(self.workspace, key, read))
        except FileFormatError as error:
            self.refuse(key, str(error))
            return
        self._tell()
        if len(self._batch) >= BATCH:
            self._commit()

    def refuse(self, key: str, reason: str) -> None:
        """Puts a file on the list of those that were not taken."""
        self._refused.append(RefusedFile(key, reason))
        self._n_bad += 1
        self._tell()

    def report(self) -> IngestReport:
        """What became of all files, once the last is committed."""
        self._commit()
        counts = self._counts
        return IngestReport(
            counts[IngestOutcome.ADDED],
            counts[IngestOutcome.UNCHANGED],
            counts[IngestOutcome.CHANGED],
            tuple(self._refused),
        )

    def _tell(self) -> None:
        self._n_seen += 1
        n_total = max(self.n_planned, self._n_seen)
        self.on_progress(RunProgress(self._n_seen - self._n_bad, self._n_bad, n_total))

    def _commit(self) -> None:
        for ingested in self.workspace.catalog.add_shapes(self.collection.id, self._batch):
            self._counts[ingested.outcome] += 1
            if ingested.outcome is IngestOutcome.CONFLICT:
                why = "a labelled shape's file must stay as it is but has changed; ingest it under another name"
                self._refused.append(RefusedFile(ingested.source_key, f"{ingested.source_key}: {why}"))
        self._batch = []


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


def _copy(workspace: Workspace, key: str, read: Callable[[], bytes]) -> NewShape:
    if not key.isprintable():  # also what is not UTF-8, which the catalog could not hold
        raise FileFormatError(f"{key!a}: a file's name must be printable UTF-8; rename the file")
    try:
        data = read()
    except FileFormatError as error:
        raise FileFormatError(f"{key}: {error}") from error
    if not data.strip():
        raise FileFormatError(f"{key}: a mesh file must have content but is empty; was the download cut off?")
    new_shape = NewShape(key, hashlib.sha256(data).hexdigest(), PurePosixPath(key).suffix.lower())
    target = source_object(new_shape.source_hash, new_shape.source_suffix)
    if not workspace.arrays.exists(target):
        workspace.arrays.put_bytes(target, data)
    return new_shape
