"""Ingest of a file that nobody vouches for: a mesh, or an archive of meshes."""

from functools import partial
from pathlib import Path, PurePosixPath

from partwise.errors import FileFormatError
from partwise.io.archive_limits import ArchiveLimits
from partwise.io.archives import ArchivedFile, is_archive, read_archive
from partwise.io.limits import ReadLimits
from partwise.io.read import MESH_SUFFIXES, read_bytes, read_mesh
from partwise.store.records import Collection
from partwise.workspace.ingest import IngestReport, Intake
from partwise.workspace.progress import OnRunProgress
from partwise.workspace.workspace import Workspace


def ingest_file(
    workspace: Workspace, collection: Collection, path: Path, on_progress: OnRunProgress = lambda _: None
) -> IngestReport:
    """Ingests a mesh under its file's name, or an archive's meshes under theirs. Safe to repeat.

    Each must be a mesh that can be read, of at most `mesh.max_faces` faces. Members that are not are refused; so is the
    rest of an archive that turns out damaged or harmful, what came before stays.

    Raises
    ------
    FileFormatError : nothing of it could be taken.
    """
    intake = Intake(workspace, collection, on_progress)
    limits = ReadLimits(max_faces=workspace.config.mesh.max_faces)
    if is_archive(path.name):
        _take_archive(intake, path, ArchiveLimits(member=limits))
    else:
        intake.take(path.name, partial(_checked_file, path, limits))
    report = intake.report()
    if report.is_empty:
        raise FileFormatError(
            f"{path.name}: has no mesh files ({', '.join(sorted(MESH_SUFFIXES))}); was it the right one?"
        )
    if not (report.n_added or report.n_unchanged or report.n_changed):
        more = f", and {len(report.refused) - 1:,} more" if len(report.refused) > 1 else ""
        raise FileFormatError(f"nothing of {path.name} could be taken: {report.refused[0].reason}{more}")
    return report


def _take_archive(intake: Intake, path: Path, limits: ArchiveLimits) -> None:
    try:
        for member in read_archive(path, _is_mesh, limits):
            if isinstance(member, ArchivedFile):
                intake.take(member.name, partial(_checked, member.name, member.data, limits.member))
            else:
                intake.refuse(member.name, member.reason)
    except FileFormatError as error:
        intake.refuse(path.name, f"{path.name}: {error}")


def _is_mesh(name: str) -> bool:
    return PurePosixPath(name).suffix.lower() in MESH_SUFFIXES


def _checked_file(path: Path, limits: ReadLimits) -> bytes:
    return _checked(path.name, read_bytes(path, limits), limits)


def _checked(name: str, data: bytes, limits: ReadLimits) -> bytes:
    """The bytes, if they are a mesh."""
    try:
        read_mesh(name, data, limits)
    except FileFormatError as error:
        raise FileFormatError(str(error).removeprefix(f"{name}: ")) from error
    return data
