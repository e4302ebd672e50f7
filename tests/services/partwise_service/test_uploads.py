"""Uploads and ingest over HTTP: bounded, for operators, and from nowhere that a caller names."""

import asyncio
import json
import shutil

import pytest

from partwise.io.off import format_off
from partwise.store import large_objects
from partwise.store.records import JobKind, Role
from partwise.workspace.ingest_prefixes import PREFIXES_VARIABLE
from partwise_service.settings import ServiceSettings

MESH = b"OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n"
LIMIT = 50_000


@pytest.fixture
def mugs(mugs):
    """With arrays of their own, as uploads are counted."""
    arrays = mugs.path / "arrays"
    shared = arrays.resolve()
    arrays.unlink()
    shutil.copytree(shared, arrays)
    return mugs


@pytest.fixture
def settings(mugs, tmp_path) -> ServiceSettings:
    (tmp_path / "scans").mkdir()
    prefixes = {"scans": tmp_path / "scans"}
    return ServiceSettings(
        workspace=mugs.path, max_upload_bytes=LIMIT, max_body_bytes=2_000, max_uploads=2, ingest_prefixes=prefixes
    )


@pytest.fixture
def mug_operator(issue, mugs):
    """Of mugs only."""
    return issue("olga", Role.OPERATOR, (mugs.collection_id,))


def send(caller, collection_id: int, data=MESH, name: str = "a.off", **given):
    return caller.post(f"/collections/{collection_id}/uploads", params={"name": name}, content=data, **given)


def test_an_upload_becomes_a_job(operator, mugs, workspace) -> None:
    sent = send(operator, mugs.collection_id)
    assert sent.status_code == 201
    upload = sent.json()
    assert (upload["name"], upload["n_bytes"], upload["person"]) == ("a.off", len(MESH), "oscar")
    job = operator.post(f"/collections/{mugs.collection_id}/ingest", json={"upload_id": upload["upload_id"]})
    assert job.status_code == 201
    claimed = workspace.catalog.claim_job("worker", [JobKind.INGEST])
    assert (claimed.id, claimed.parameters["upload_id"]) == (job.json()["id"], upload["upload_id"])


def test_uploads_are_listed_and_deleted(operator, mugs) -> None:
    upload = send(operator, mugs.collection_id).json()
    path = f"/collections/{mugs.collection_id}/uploads"
    assert operator.get(path).json()["items"] == [upload]
    assert operator.delete(f"{path}/{upload['upload_id']}").status_code == 204
    assert operator.get(path).json()["items"] == []
    assert operator.delete(f"{path}/{upload['upload_id']}").status_code == 404


def test_who_sent_and_who_deleted_is_on_record(operator, issue, mugs) -> None:
    upload = send(operator, mugs.collection_id).json()
    operator.delete(f"/collections/{mugs.collection_id}/uploads/{upload['upload_id']}")
    trail = issue("ada", Role.ADMIN).get("/audit").json()["items"]
    assert {("oscar", "upload"), ("oscar", "delete upload")} <= {(each["actor"], each["action"]) for each in trail}


class TestLimits:
    def test_so_many_wait_at_most(self, operator, mugs) -> None:
        assert [send(operator, mugs.collection_id).status_code for _ in range(3)] == [201, 201, 409]

    def test_uploads_expire(self, operator, mugs, workspace, monkeypatch) -> None:
        upload = send(operator, mugs.collection_id).json()
        later = large_objects.expiry_of(upload["upload_id"]).replace(year=2100)

        class Later(large_objects.datetime):
            @classmethod
            def now(cls, tz=None):
                return later

        monkeypatch.setattr(large_objects, "datetime", Later)
        wish = {"upload_id": upload["upload_id"]}
        assert operator.post(f"/collections/{mugs.collection_id}/ingest", json=wish).status_code == 404

    def test_a_large_upload_is_refused_by_its_length(self, operator, mugs, workspace) -> None:
        assert send(operator, mugs.collection_id, b"x" * (LIMIT + 1)).status_code == 413
        assert workspace.arrays.list("uploads") == []

    def test_a_large_upload_without_a_length_leaves_nothing(self, operator, mugs, workspace, monkeypatch) -> None:
        monkeypatch.setattr("partwise_service.routes.uploads.CHUNK_BYTES", 1_000)
        monkeypatch.setattr(large_objects, "CHUNK_BYTES", 1_000)
        assert send(operator, mugs.collection_id, (b"x" * 1_000 for _ in range(100))).status_code == 413
        assert workspace.arrays.list("uploads") == []

    def test_one_that_fits_comes_in_chunks(self, operator, mugs, workspace, monkeypatch) -> None:
        monkeypatch.setattr("partwise_service.routes.uploads.CHUNK_BYTES", 1_000)
        monkeypatch.setattr(large_objects, "CHUNK_BYTES", 1_000)
        upload = send(operator, mugs.collection_id, (b"x" * 700 for _ in range(5))).json()
        assert upload["n_bytes"] == 3_500
        assert len(workspace.arrays.list("uploads")) == 4 + 2  # its chunks, its mark and its description

    def test_an_empty_upload_is_refused(self, operator, mugs, workspace) -> None:
        assert send(operator, mugs.collection_id, b"").status_code == 422
        assert workspace.arrays.list("uploads") == []

    def test_other_bodies_stay_small(self, operator, mugs) -> None:
        body = json.dumps({"upload_id": "x" * 3_000})
        assert operator.post(f"/collections/{mugs.collection_id}/ingest", content=body).status_code == 413

    def test_one_that_breaks_off_leaves_nothing(self, app, operator, mugs, workspace) -> None:
        messages = [{"type": "http.request", "body": MESH, "more_body": True}, {"type": "http.disconnect"}]
        assert _answered(app, operator, mugs, messages) == 400
        assert workspace.arrays.list("uploads") == []


class TestSlowly:
    @pytest.fixture
    def settings(self, mugs) -> ServiceSettings:
        return ServiceSettings(workspace=mugs.path, request_idle_s=0.01)

    def test_an_upload_that_falls_silent_is_given_up(self, app, operator, mugs, workspace) -> None:
        assert _answered(app, operator, mugs, [{"type": "http.request", "body": MESH, "more_body": True}]) == 408
        assert workspace.arrays.list("uploads") == []


def _answered(app, caller, mugs, messages: list[dict]) -> int:
    """The status of an upload whose messages are these, and then nothing."""
    statuses = []

    async def receive():
        if messages:
            return messages.pop(0)
        return await asyncio.Event().wait()

    async def send(message) -> None:
        statuses.append(message.get("status"))

    headers = [(b"authorization", caller.headers["Authorization"].encode())]
    path = f"/api/v1/collections/{mugs.collection_id}/uploads"
    scope = {"type": "http", "method": "POST", "path": path, "query_string": b"name=a.off", "headers": headers}
    scope |= {"client": ("testclient", 1), "server": ("127.0.0.1", 8000), "scheme": "http", "root_path": ""}
    asyncio.run(app(scope, receive, send))
    return statuses[0]


class TestRefusals:
    @pytest.mark.parametrize("name", ["../a.off", "/etc/a.off", "a.exe", "a.pkl", "x", "a.off\n", "C:\\a.off", "..off"])
    def test_names_that_lead_elsewhere_or_are_no_meshs(self, operator, mugs, workspace, name) -> None:
        assert send(operator, mugs.collection_id, name=name).status_code == 422
        assert workspace.arrays.list("uploads") == []

    def test_a_compressed_body(self, operator, mugs) -> None:
        assert send(operator, mugs.collection_id, headers={"Content-Encoding": "gzip"}).status_code == 415

    @pytest.mark.parametrize(
        "wish",
        [
            {},
            {"upload_id": "x", "prefix": "scans"},
            {"upload_id": "x", "path": "y"},
            {"url": "http://169.254.169.254/latest"},
            {"prefix": "scans", "path": "../secret"},
            {"prefix": "scans", "path": "/etc"},
            {"prefix": "scans", "path": "a/../../b"},
            {"prefix": "scans", "path": "a\\..\\b"},
            {"prefix": "scans", "path": ".ssh"},
        ],
    )
    def test_what_a_job_may_not_read(self, operator, mugs, workspace, wish) -> None:
        assert operator.post(f"/collections/{mugs.collection_id}/ingest", json=wish).status_code == 422
        assert workspace.catalog.jobs(mugs.collection_id) == []

    @pytest.mark.parametrize("wish", [{"upload_id": "../../catalog.sqlite"}, {"prefix": "/etc"}, {"prefix": "other"}])
    def test_what_is_not_there(self, operator, mugs, workspace, wish) -> None:
        assert operator.post(f"/collections/{mugs.collection_id}/ingest", json=wish).status_code == 404
        assert workspace.catalog.jobs(mugs.collection_id) == []

    def test_anothers_upload_is_not_there(self, operator, mug_operator, mugs) -> None:
        upload = send(operator, mugs.other_id).json()["upload_id"]
        path = f"/collections/{mugs.collection_id}"
        assert mug_operator.post(f"{path}/ingest", json={"upload_id": upload}).status_code == 404
        assert mug_operator.delete(f"{path}/uploads/{upload}").status_code == 404
        assert mug_operator.get(f"{path}/uploads").json()["items"] == []

    @pytest.mark.parametrize("role", [Role.ANNOTATOR, Role.REVIEWER])
    def test_callers_of_lesser_roles(self, issue, mugs, workspace, role) -> None:
        caller = issue("ann", role)
        path = f"/collections/{mugs.collection_id}"
        answers = [send(caller, mugs.collection_id), caller.get(f"{path}/uploads"), caller.get("/ingest-prefixes")]
        answers.append(caller.post(f"{path}/ingest", json={"prefix": "scans"}))
        assert [answer.status_code for answer in answers] == [403] * 4
        assert workspace.arrays.list("uploads") == []


class TestPrefixes:
    def test_one_that_is_listed_becomes_a_job(self, operator, mugs, workspace) -> None:
        assert operator.get("/ingest-prefixes").json()["items"] == ["scans"]
        wish = {"prefix": "scans", "path": "./mugs/"}
        assert operator.post(f"/collections/{mugs.collection_id}/ingest", json=wish).status_code == 201
        assert workspace.catalog.claim_job("worker").parameters == {"prefix": "scans", "path": "mugs"}

    def test_they_are_for_operators_of_all_collections(self, mug_operator, mugs) -> None:
        assert mug_operator.get("/ingest-prefixes").json()["items"] == []
        wish = {"prefix": "scans"}
        assert mug_operator.post(f"/collections/{mugs.collection_id}/ingest", json=wish).status_code == 403

    def test_where_they_are_is_not_told(self, operator, mugs, tmp_path) -> None:
        wish = {"prefix": "scans", "path": "mugs"}
        answer = operator.post(f"/collections/{mugs.collection_id}/ingest", json=wish)
        assert str(tmp_path) not in answer.text + operator.get("/ingest-prefixes").text

    def test_they_come_from_the_variable_that_workers_read(self, mugs) -> None:
        made = ServiceSettings.of({PREFIXES_VARIABLE: "scans=/data/scans"}, workspace=mugs.path)
        assert {name: str(folder) for name, folder in made.ingest_prefixes.items()} == {"scans": "/data/scans"}


def test_a_mesh_travels_whole(operator, mugs, workspace) -> None:
    data = format_off(mugs.meshes["b.off"])
    upload = send(operator, mugs.collection_id, data, "b.off").json()
    found = large_objects.find_large_object(workspace.arrays, f"uploads/{mugs.collection_id}/{upload['upload_id']}")
    assert b"".join(large_objects.read_chunks(workspace.arrays, found)) == data
