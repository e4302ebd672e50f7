"""Exports: asked for as jobs, downloaded as archives by those who may."""

import io
import zipfile
from dataclasses import replace
from datetime import timedelta

import pytest

from partwise.store.records import JobKind, JobState, Role
from partwise.workspace import export_archive as exporting
from partwise.workspace.choices import ExportFormat, Segmentation
from partwise.workspace.export_archive import export_archive
from partwise_service.routes.exports import file_name


@pytest.fixture
def asked(operator, mugs) -> int:
    """The id of a job that waits."""
    wish = {"kind": "export", "parameters": {"segmentation": "predicted", "format": "seg"}}
    return operator.post(f"/collections/{mugs.collection_id}/jobs", json=wish).json()["id"]


@pytest.fixture
def done(asked, workspace, mugs) -> int:
    """As a worker would."""
    job = workspace.catalog.claim_job("worker", [JobKind.EXPORT])
    collection = next(each for each in workspace.catalog.list_collections() if each.id == mugs.collection_id)
    made, _ = export_archive(workspace, collection, Segmentation.PREDICTED, ExportFormat.SEG)
    workspace.catalog.finish_job(job.id, "worker", JobState.DONE, result={"download": made.name})
    return job.id


def test_what_is_asked_for_is_what_the_worker_gets(asked, workspace) -> None:
    job = workspace.catalog.claim_job("worker")
    assert (job.id, job.kind) == (asked, JobKind.EXPORT)
    assert job.parameters == {"segmentation": "predicted", "format": "seg", "on": "working"}


@pytest.mark.parametrize(
    "parameters", [{"format": "exe"}, {"on": "/etc"}, {"out": "/etc"}, {"segmentation": "draft"}, {"format": 1}]
)
def test_what_no_export_has_is_refused(operator, mugs, workspace, parameters) -> None:
    wish = {"kind": "export", "parameters": parameters}
    assert operator.post(f"/collections/{mugs.collection_id}/jobs", json=wish).status_code == 422
    assert workspace.catalog.jobs(mugs.collection_id) == []


def test_the_archive_is_downloaded(operator, done, mugs) -> None:
    answer = operator.get(f"/jobs/{done}/download")
    assert (answer.status_code, answer.headers["content-type"]) == (200, "application/zip")
    assert answer.headers["content-disposition"] == f'attachment; filename="mugs-{done}.zip"'
    assert int(answer.headers["content-length"]) == len(answer.content)
    assert answer.headers["x-content-type-options"] == "nosniff"
    names = zipfile.ZipFile(io.BytesIO(answer.content)).namelist()
    assert sorted(names) == ["a.seg", "b.seg", "manifest.json", "sub/c.seg"]


def test_one_that_is_not_done_is_not_there_yet(operator, asked) -> None:
    assert operator.get(f"/jobs/{asked}/download").status_code == 409


def test_one_that_has_expired_is_gone(operator, asked, workspace, mugs, monkeypatch) -> None:
    monkeypatch.setattr(exporting, "EXPORT_TTL", timedelta(seconds=-1))
    job = workspace.catalog.claim_job("worker")
    collection = next(each for each in workspace.catalog.list_collections() if each.id == mugs.collection_id)
    made, _ = export_archive(workspace, collection, Segmentation.PREDICTED, ExportFormat.SEG)
    workspace.catalog.finish_job(job.id, "worker", JobState.DONE, result={"download": made.name})
    assert operator.get(f"/jobs/{job.id}/download").status_code == 404


@pytest.mark.parametrize("result", [None, {}, {"download": "../../uploads/1/x"}, {"download": 7}])
def test_a_result_that_names_no_export_is_no_way_elsewhere(operator, asked, workspace, result) -> None:
    job = workspace.catalog.claim_job("worker")
    workspace.catalog.finish_job(job.id, "worker", JobState.DONE, result=result)
    assert operator.get(f"/jobs/{job.id}/download").status_code == 404


def test_other_jobs_have_nothing_to_download(operator, workspace, mugs) -> None:
    job = workspace.catalog.enqueue_job(mugs.collection_id, JobKind.TRAIN)
    assert operator.get(f"/jobs/{job.id}/download").status_code == 404


@pytest.mark.parametrize("role", [Role.ANNOTATOR, Role.REVIEWER])
def test_exports_are_for_operators(issue, mugs, done, role) -> None:
    caller = issue("ann", role, (mugs.collection_id,))
    assert caller.get(f"/jobs/{done}/download").status_code == 403
    assert caller.post(f"/collections/{mugs.collection_id}/jobs", json={"kind": "export"}).status_code == 403


def test_exports_of_foreign_collections_are_not_there(issue, mugs, done) -> None:
    assert issue("olga", Role.OPERATOR, (mugs.other_id,)).get(f"/jobs/{done}/download").status_code == 404


@pytest.mark.parametrize(
    ("name", "stem"),
    [
        ("mugs", "mugs"),
        ('a"; filename="b.exe', "a-filename-b-exe"),
        ("../../etc", "etc"),
        ("x\r\nSet-Cookie: y", "x-Set-Cookie-y"),
        ("Krüge", "Kr-ge"),
        ("壺", "collection"),
        ("x" * 200, "x" * 60),
    ],
)
def test_names_of_files_are_plain(workspace, asked, name, stem) -> None:
    collection = replace(workspace.catalog.list_collections()[0], name=name)
    assert file_name(collection, workspace.catalog.job(asked)) == f"{stem}-{asked}.zip"
