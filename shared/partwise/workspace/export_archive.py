"""An export as one zip archive in the array store, from where whoever asked for it downloads it until it expires."""

import zipfile
from datetime import UTC, datetime, timedelta
from pathlib import Path
from tempfile import TemporaryDirectory

from partwise.errors import NotFoundError
from partwise.store.large_objects import (
    LargeObject,
    LargeObjectWriter,
    delete_large_object,
    expiring_key,
    find_unexpired,
    sweep_expired,
)
from partwise.store.records import Collection, MeshRole
from partwise.workspace.choices import ExportFormat, PointSampling, Segmentation
from partwise.workspace.export import ExportReport, export_labels
from partwise.workspace.progress import OnRunProgress
from partwise.workspace.workspace import Workspace

EXPORTS = "exports"
EXPORT_TTL = timedelta(days=7)


def export_archive(
    workspace: Workspace,
    collection: Collection,
    segmentation: Segmentation,
    file_format: ExportFormat,
    role: MeshRole = MeshRole.WORKING,
    on_progress: OnRunProgress = lambda _: None,
    sampling: PointSampling | None = None,
) -> tuple[LargeObject, ExportReport]:
    """As `export_labels`, with its folder as an archive. Those of the collection that have expired are swept first."""
    now = datetime.now(UTC)
    folder = f"{EXPORTS}/{collection.id}"
    sweep_expired(workspace.arrays, folder, now)
    with TemporaryDirectory(prefix="partwise-export-") as place:
        out = Path(place) / "out"
        report = export_labels(
            workspace, collection, segmentation, file_format, out, role, on_progress, sampling or PointSampling()
        )
        key = expiring_key(folder, now + EXPORT_TTL)
        writer = LargeObjectWriter(workspace.arrays, key)
        try:
            _zip(out, writer)
            return writer.finish({"segmentation": segmentation.value, "format": file_format.value}), report
        except BaseException:
            delete_large_object(workspace.arrays, key)
            raise


def find_export(workspace: Workspace, collection_id: int, export_id: str) -> LargeObject:
    """An export of the collection.

    Raises
    ------
    NotFoundError : it has none of this id, or no longer.
    """
    try:
        return find_unexpired(workspace.arrays, f"{EXPORTS}/{collection_id}", export_id)
    except NotFoundError as error:
        raise NotFoundError(f"the export is gone after {EXPORT_TTL.days} days; export again") from error


def _zip(folder: Path, writer: LargeObjectWriter) -> None:
    """Writes all files of a folder, by their relative paths, as an archive that is never read back."""
    with zipfile.ZipFile(writer, "w", zipfile.ZIP_DEFLATED, strict_timestamps=False) as archive:  # type: ignore[call-overload] # it asks for no more
        for path in sorted(each for each in folder.rglob("*") if each.is_file()):
            archive.write(path, path.relative_to(folder).as_posix())
