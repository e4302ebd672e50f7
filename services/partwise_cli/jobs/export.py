"""The job `export`: labels become an archive that the service hands out."""

from partwise.store.records import MeshRole
from partwise.workspace.choices import ExportFormat, Segmentation
from partwise.workspace.export_archive import export_archive
from partwise.workspace.progress import RunProgress
from partwise_cli.jobs.work import Outcome, Work

MAX_REASONS = 100
"""Shapes that could not be written which the job's result names."""


def export(work: Work) -> Outcome:
    """Writes the archive; the result says under which name it is downloaded."""

    def on_progress(run: RunProgress) -> None:
        work.tell(run)
        work.pulse.raise_if_stopped()

    parameters = work.job.parameters
    made, report = export_archive(
        work.workspace,
        work.collection,
        Segmentation(parameters["segmentation"]),
        ExportFormat(parameters["format"]),
        MeshRole(parameters["on"]),
        on_progress,
    )
    shapes = "1 shape" if report.n_written == 1 else f"{report.n_written:,} shapes"
    result = {
        "download": made.name,
        "n_bytes": made.n_bytes,
        "sha256": made.sha256,
        "expires_at": made.expires_at.isoformat(),
        "n_written": report.n_written,
        "n_without": report.n_without,
        "n_refused": len(report.refused),
        "refused": list(report.refused[:MAX_REASONS]),
    }
    return Outcome(f"{shapes} exported, {len(report.refused):,} refused", result)
