"""The job `ingest`: meshes of an upload, or of what is below a listed prefix, become shapes."""

import logging
import os
from collections.abc import Callable
from functools import partial
from pathlib import Path
from tempfile import TemporaryDirectory

from partwise.errors import FileFormatError, NotFoundError, StoreError
from partwise.store.large_objects import LargeObject
from partwise.store.records import JobKind, JobState
from partwise.workspace.ingest import IngestReport, ingest_folder
from partwise.workspace.ingest_files import ingest_file
from partwise.workspace.ingest_prefixes import PREFIXES_VARIABLE, below_prefix, parse_prefixes
from partwise.workspace.progress import OnRunProgress, RunProgress
from partwise.workspace.uploads import delete_upload, fetch_upload, find_upload
from partwise_cli.jobs.work import Outcome, Work

logger = logging.getLogger(__name__)

MAX_REASONS = 100
"""Refused files that the job's result names."""


def ingest(work: Work) -> Outcome | None:
    """Takes in what there is, and asks for it to be described."""
    if "upload_id" in work.job.parameters:
        _of_upload(work, str(work.job.parameters["upload_id"]))
        return None
    return _outcome(_asking_for_descriptions(work, _below_prefix))


def _asking_for_descriptions(work: Work, take: Callable[[Work], IngestReport]) -> IngestReport:
    """However it ends: shapes are committed in batches, and an attempt that was cut short may have brought some."""
    is_again = work.job.attempts > 1
    may_be_new = True
    try:
        report = take(work)
        may_be_new = is_again or report.n_added + report.n_changed > 0
        return report
    except (FileFormatError, NotFoundError):  # it took nothing
        may_be_new = is_again
        raise
    finally:
        if may_be_new:
            work.workspace.catalog.enqueue_job(work.collection.id, JobKind.PREPROCESS)


def _of_upload(work: Work, upload_id: str) -> None:
    """Deletes the upload once it is on record that the job is done: until then it may have to be begun again."""
    upload = find_upload(work.workspace, work.collection.id, upload_id)
    outcome = _outcome(_asking_for_descriptions(work, partial(_take_upload, upload)))
    work.workspace.catalog.finish_job(
        work.job.id, work.owner, JobState.DONE, message=outcome.message, result=outcome.result
    )
    try:
        delete_upload(work.workspace, upload)
    except StoreError as error:
        logger.warning("an upload that was taken in stays until it expires: %s", error)


def _take_upload(upload: LargeObject, work: Work) -> IngestReport:
    with TemporaryDirectory(prefix="partwise-ingest-") as place:
        try:
            path = fetch_upload(work.workspace, upload, Path(place))
        except StoreError:
            raise
        except OSError as error:
            why = error.strerror or error
            raise StoreError(f"an upload needs room on the worker's disk but: {why}; free some") from error
        return ingest_file(work.workspace, work.collection, path, _telling(work))


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
