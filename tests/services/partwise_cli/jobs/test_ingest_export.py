"""The jobs `ingest` and `export`: from an upload or a prefix to shapes, and from labels to an archive."""

import io
import zipfile
from datetime import timedelta
from importlib import import_module

import numpy as np
import pytest

from partwise.errors import StoreError
from partwise.io.off import format_off
from partwise.store.large_objects import read_chunks
from partwise.store.records import JobKind, JobState
from partwise.store.sql_catalog import SqlCatalog
from partwise.testing.workspaces import publish_evaluation, save_model
from partwise.workspace import ingest as module
from partwise.workspace.export_archive import find_export
from partwise.workspace.ingest_prefixes import PREFIXES_VARIABLE
from partwise.workspace.shapes import load_mesh, shape_mesh
from partwise.workspace.uploads import begin_upload, uploads
from partwise_cli.jobs import ingest as job_module
from partwise_cli.jobs.handlers import HANDLERS
from partwise_cli.jobs.pulse import Pulse
from partwise_cli.jobs.stopping import JobStoppedError, StopReason


class Killed(BaseException):
    """Nothing is put right after it."""


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
    assert (job.state, "new.zip" in job.full_message) == (JobState.FAILED, True)
    assert len(uploads(workspace, collection_id)) == 1


def waits(workspace, collection_id: int) -> list[JobKind]:
    """Kinds of jobs that wait."""
    return [job.kind for job in workspace.catalog.jobs(collection_id, state=JobState.PENDING)]


class TestOneThatIsBegunAgain:
    """Whenever its worker is lost, an upload is taken in whole, and described."""

    @pytest.fixture
    def upload(self, workspace, collection_id, mesh, monkeypatch) -> str:
        monkeypatch.setattr(module, "BATCH", 1)
        files = {"new/a.off": mesh, "new/b.off": mesh, "new/c.off": mesh}
        return uploaded(workspace, collection_id, files)

    @pytest.fixture
    def begin(self, workspace, collection_id, worker, upload):
        """`begin()`: the job, after a worker that was not in the way."""

        def run():
            worker({JobKind.INGEST: HANDLERS[JobKind.INGEST]}).run(once=True)
            return workspace.catalog.jobs(collection_id, limit=500)[-1]

        workspace.catalog.enqueue_job(collection_id, JobKind.INGEST, {"upload_id": upload})
        return run

    @pytest.mark.parametrize(
        ("killed_in", "n_in", "before_it"),
        [
            ("partwise.workspace.ingest.Intake.report", 3, True),
            ("partwise.store.sql_catalog.SqlCatalog.enqueue_job", 3, True),
            ("partwise.store.sql_catalog.SqlCatalog.finish_job", 3, True),
            ("partwise.workspace.ingest.Intake._commit", 1, False),
        ],
    )
    def test_killed(self, workspace, collection_id, upload, begin, monkeypatch, killed_in, n_in, before_it) -> None:
        n_before = len(keys(workspace, collection_id))
        owner, name = killed_in.rsplit(".", 1)
        target = getattr(import_module(owner.rsplit(".", 1)[0]), owner.rsplit(".", 1)[1])
        original = getattr(target, name)

        def dies(*given, **named):
            if not before_it:
                original(*given, **named)
            raise Killed

        with monkeypatch.context() as deadly:
            deadly.setattr(target, name, dies)
            deadly.setattr(SqlCatalog, "release_jobs", lambda *_: [])
            if name != "enqueue_job":  # what is killed does not clean up
                deadly.setattr(SqlCatalog, "enqueue_job", lambda *_: None)
            with pytest.raises(Killed):
                begin()
        assert len(keys(workspace, collection_id)) == n_before + n_in
        assert JobKind.PREPROCESS not in waits(workspace, collection_id)
        workspace.catalog.requeue_lost_jobs(timedelta(hours=-1))
        assert begin().state is JobState.DONE
        assert len(keys(workspace, collection_id)) == n_before + 3
        assert waits(workspace, collection_id) == [JobKind.PREPROCESS]
        assert uploads(workspace, collection_id) == []

    def test_cancelled(self, workspace, collection_id, begin, monkeypatch) -> None:
        taken = []

        def stops(_pulse):
            taken.append(1)
            if len(taken) == 3:
                raise JobStoppedError(StopReason.CANCELLED, "cancelled")

        monkeypatch.setattr(Pulse, "raise_if_stopped", stops)
        assert begin().state is JobState.CANCELLED
        assert {"new/a.off", "new/b.off"} <= keys(workspace, collection_id)
        assert waits(workspace, collection_id) == [JobKind.PREPROCESS]

    def test_an_upload_that_cannot_be_deleted_stays(self, workspace, collection_id, upload, begin, monkeypatch) -> None:
        def refuses(*_):
            raise StoreError("the store is read-only")

        monkeypatch.setattr(job_module, "delete_upload", refuses)
        assert begin().state is JobState.DONE
        assert [each.name for each in uploads(workspace, collection_id)] == [upload]


def test_what_brings_nothing_new_asks_for_nothing(workspace, collection_id, done, mesh) -> None:
    for _ in range(2):
        workspace.catalog.claim_job("w")
        done(JobKind.INGEST, {"upload_id": uploaded(workspace, collection_id, {"a2.off": mesh})})
    assert workspace.catalog.claim_job("w") is None
    done(JobKind.INGEST, {"upload_id": uploaded(workspace, collection_id, {"a.off": b"no mesh"})})
    assert waits(workspace, collection_id) == []


def test_an_upload_that_is_gone_fails_the_job(done) -> None:
    job = done(JobKind.INGEST, {"upload_id": f"20260101T000000Z-{'0' * 32}"})
    assert (job.state, "send the file again" in job.full_message) == (JobState.FAILED, True)


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
        assert str(scans) not in job.full_message
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
    assert (job.state, "confirmed labels" in job.full_message) == (JobState.FAILED, True)
