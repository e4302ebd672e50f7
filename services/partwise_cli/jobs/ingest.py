"""The job `ingest`: meshes of an upload, or of what is below a listed prefix, become shapes."""

import os
from pathlib import Path
from tempfile import TemporaryDirectory

from partwise.errors import NotFoundError, StoreError
from partwise.store.records import JobKind
from partwise.workspace.ingest import IngestReport, ingest_folder
from partwise.workspace.ingest_files import ingest_file
from partwise.workspace.ingest_prefixes import PREFIXES_VARIABLE, below_prefix, parse_prefixes
from partwise.workspace.progress import OnRunProgress, RunProgress
from partwise.workspace.uploads import delete_upload, fetch_upload, find_upload
from partwise_cli.jobs.work import Outcome, Work

MAX_REASONS = 100
"""Refused files that the job's result names."""


def ingest(work: Work) -> Outcome:
    """Takes in what there is, then asks for it to be described. An upload is deleted once it is taken in."""
    parameters = work.job.parameters
    report = _of_upload(work, str(parameters["upload_id"])) if "upload_id" in parameters else _below_prefix(work)
    if report.n_added or report.n_changed:
        work.workspace.catalog.enqueue_job(work.collection.id, JobKind.PREPROCESS)
    return _outcome(report)


def _of_upload(work: Work, upload_id: str) -> IngestReport:
    upload = find_upload(work.workspace, work.collection.id, upload_id)
    with TemporaryDirectory(prefix="partwise-ingest-") as place:
        try:
            path = fetch_upload(work.workspace, upload, Path(place))
        except StoreError:
            raise
        except OSError as error:
            why = error.strerror or error
            raise StoreError(f"an upload needs room on the worker's disk but: {why}; free some") from error
        report = ingest_file(work.workspace, work.collection, path, _telling(work))
    delete_upload(work.workspace, upload)
    return report


def _below_prefix(work: Work) -> IngestReport:
    prefixes = parse_prefixes(os.environ.get(PREFIXES_VARIABLE, ""))
    prefix, path = str(work.job.parameters["prefix"]), str(work.job.parameters["path"])
    target = below_prefix(prefixes, prefix, path)
    if not target.is_dir():
        return ingest_file(work.workspace, work.collection, target, _telling(work))
    try:
        return ingest_folder(work.workspace, work.collection, target, _telling(work))
    except NotFoundError as error:  # without where the prefix is, which is nobody's business
        raise NotFoundError(f"there are no mesh files at {path!a} below the prefix {prefix}; check the path") from error


def _telling(work: Work) -> OnRunProgress:
    """Says how far the job is, and stops it between two files when it should."""

    def on_progress(run: RunProgress) -> None:
        work.tell(run)
        work.pulse.raise_if_stopped()

    return on_progress


def _outcome(report: IngestReport) -> Outcome:
    shapes = "1 shape" if report.n_added == 1 else f"{report.n_added:,} shapes"
    message = f"{shapes} added, {report.n_unchanged:,} unchanged, {report.n_changed:,} changed, "
    result = {
        "n_added": report.n_added,
        "n_unchanged": report.n_unchanged,
        "n_changed": report.n_changed,
        "n_refused": len(report.refused),
        "refused": [{"source_key": each.source_key, "why": each.reason} for each in report.refused[:MAX_REASONS]],
    }
    return Outcome(f"{message}{len(report.refused):,} refused", result)
