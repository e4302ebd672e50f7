"""The jobs `ingest` and `export`: from an upload or a prefix to shapes, and from labels to an archive."""

import io
import zipfile
from datetime import timedelta

import numpy as np
import pytest

from partwise.io.off import format_off
from partwise.store.large_objects import read_chunks
from partwise.store.records import JobKind, JobState
from partwise.testing.workspaces import publish_evaluation, save_model
from partwise.workspace.export_archive import find_export
from partwise.workspace.ingest_prefixes import PREFIXES_VARIABLE
from partwise.workspace.shapes import load_mesh, shape_mesh
from partwise.workspace.uploads import begin_upload, uploads
from partwise_cli.jobs.handlers import HANDLERS

KINDS = (JobKind.INGEST, JobKind.EXPORT)


@pytest.fixture
def mesh(workspace, collection_id) -> bytes:
    shape = workspace.catalog.shapes(collection_id)[0]
    return format_off(load_mesh(workspace, shape_mesh(workspace, shape)))


@pytest.fixture
def done(workspace, collection_id, worker):
    """`done(kind, parameters)`: the job, after a worker has been at it."""

    def run(kind: JobKind, parameters: dict):
        job = workspace.catalog.enqueue_job(collection_id, kind, parameters)
        worker({each: HANDLERS[each] for each in KINDS}).run(once=True)
        return workspace.catalog.job(job.id)

    return run


def uploaded(workspace, collection_id: int, files: dict[str, bytes]) -> str:
    data = io.BytesIO()
    with zipfile.ZipFile(data, "w") as made:
        for name, content in files.items():
            made.writestr(name, content)
    writer = begin_upload(workspace, collection_id, "new.zip", "oscar", timedelta(days=1), 8)
    writer.write(data.getvalue())
    return writer.finish().name


def keys(workspace, collection_id: int) -> set[str]:
    return {shape.source_key for shape in workspace.catalog.shapes(collection_id)}


def test_an_upload_becomes_shapes_that_wait_to_be_described(workspace, collection_id, done, mesh) -> None:
    upload = uploaded(workspace, collection_id, {"new/a.off": mesh, "../b.off": mesh})
    job = done(JobKind.INGEST, {"upload_id": upload})
    assert (job.state, job.result["n_added"], job.result["n_refused"]) == (JobState.DONE, 1, 1)
    assert job.result["refused"][0]["source_key"] == "../b.off"
    assert "new/a.off" in keys(workspace, collection_id)
    assert uploads(workspace, collection_id) == []
    assert workspace.catalog.claim_job("w").kind is JobKind.PREPROCESS


def test_an_upload_of_which_nothing_can_be_taken_stays(workspace, collection_id, done) -> None:
    job = done(JobKind.INGEST, {"upload_id": uploaded(workspace, collection_id, {"a.off": b"no mesh"})})
    assert (job.state, "new.zip" in job.progress.message) == (JobState.FAILED, True)
    assert len(uploads(workspace, collection_id)) == 1


def test_an_upload_that_is_gone_fails_the_job(done) -> None:
    job = done(JobKind.INGEST, {"upload_id": f"20260101T000000Z-{'0' * 32}"})
    assert (job.state, "send the file again" in job.progress.message) == (JobState.FAILED, True)


class TestPrefixes:
    @pytest.fixture
    def scans(self, tmp_path, monkeypatch, mesh):
        folder = tmp_path / "scans"
        (folder / "mugs").mkdir(parents=True)
        (folder / "empty").mkdir()
        (folder / "mugs" / "x.off").write_bytes(mesh)
        (tmp_path / "secret.off").write_bytes(mesh)
        (folder / "link").symlink_to(tmp_path)
        monkeypatch.setenv(PREFIXES_VARIABLE, f"scans={folder}")
        return folder

    @pytest.mark.parametrize(("path", "key"), [("mugs", "x.off"), ("", "mugs/x.off"), ("mugs/x.off", "x.off")])
    def test_what_is_below_becomes_shapes(self, scans, workspace, collection_id, done, path, key) -> None:
        job = done(JobKind.INGEST, {"prefix": "scans", "path": path})
        assert (job.state, job.result["n_added"]) == (JobState.DONE, 1)
        assert key in keys(workspace, collection_id)

    @pytest.mark.parametrize("path", ["link", "../", "/etc", "empty", "nothing"])
    def test_nothing_else_does_and_no_place_is_told(self, scans, workspace, collection_id, done, path) -> None:
        before = keys(workspace, collection_id)
        job = done(JobKind.INGEST, {"prefix": "scans", "path": path})
        assert job.state is JobState.FAILED
        assert str(scans) not in job.progress.message
        assert keys(workspace, collection_id) == before

    def test_a_worker_that_lists_no_prefix_takes_nothing(self, scans, monkeypatch, done) -> None:
        monkeypatch.delenv(PREFIXES_VARIABLE)
        assert done(JobKind.INGEST, {"prefix": "scans", "path": ""}).state is JobState.FAILED


def test_an_export_becomes_an_archive(workspace, collection_id, done) -> None:
    collection = workspace.catalog.get_collection("mugs")
    shape = workspace.catalog.shapes(collection_id)[0]
    n_faces = shape_mesh(workspace, shape).n_faces
    publish_evaluation(
        workspace, save_model(workspace, collection), (1, 2), {shape.id: np.tile([0.9, 0.1], (n_faces, 1))}
    )
    job = done(JobKind.EXPORT, {"segmentation": "predicted", "format": "seg", "on": "working"})
    assert (job.state, job.result["n_written"]) == (JobState.DONE, 1)
    found = find_export(workspace, collection_id, job.result["download"])
    archive = zipfile.ZipFile(io.BytesIO(b"".join(read_chunks(workspace.arrays, found))))
    assert "manifest.json" in archive.namelist()


def test_an_export_of_labels_that_are_not_there_fails(done) -> None:
    job = done(JobKind.EXPORT, {"segmentation": "confirmed", "format": "seg", "on": "working"})
    assert (job.state, "confirmed labels" in job.progress.message) == (JobState.FAILED, True)
