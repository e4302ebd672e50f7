"""Every operation of the document, tried with tokens that should not open it: no operation is forgotten."""

import re
from pathlib import Path

import numpy as np
import pytest

from partwise.store.records import JobKind, Role
from partwise.testing.workspaces import publish_features
from partwise_service.app import create_app
from partwise_service.settings import ServiceSettings

OPEN_TO_ALL = {("POST", "/login")}
OWN = {
    ("POST", "/logout"),
    ("GET", "/me"),
    ("GET", "/events"),
    ("GET", "/collections"),
    ("GET", "/leases"),
    ("GET", "/drafts"),
}
"""What anybody may ask, as it shows what is theirs."""
PATH_LIKE = ("..%2f..%2fcatalog.sqlite", "%2e%2e", "%00", "1%20or%201=1", "-1", "0", "99999999999999999999", "\u0661")
DOCUMENT = create_app(ServiceSettings(workspace=Path("none"))).openapi()
PREFIX = "/api/v1"


def operations() -> list[tuple[str, str]]:
    return [
        (method.upper(), path.removeprefix(PREFIX))
        for path, methods in DOCUMENT["paths"].items()
        for method in methods
        if (method.upper(), path.removeprefix(PREFIX)) not in OPEN_TO_ALL
    ]


@pytest.fixture
def foreign(mugs, operator, workspace) -> dict[str, str]:
    """Ids of things of the collection of vases, by the name that paths have for them."""
    publish_features(workspace, [mugs.other_shape_id], np.random.default_rng(0))
    body = {"collection_id": mugs.other_id, "shape_ids": [mugs.other_shape_id]}
    claimed = operator.post("/queue/claim", json=body)
    assert claimed.status_code == 200, claimed.text
    lease = claimed.json()["items"][0]
    draft = operator.post(f"/leases/{lease['id']}/draft", json={}).json()
    job = workspace.catalog.enqueue_job(mugs.other_id, JobKind.TRAIN)
    return {
        "collection_id": str(mugs.other_id),
        "shape_id": str(mugs.other_shape_id),
        "lease_id": str(lease["id"]),
        "draft_id": str(draft["id"]),
        "job_id": str(job.id),
        "mesh_hash": mugs.meshes["a.off"].content_hash(),
        "upload_id": f"20990101T000000Z-{'0' * 32}",
    }


def concrete(path: str, ids: dict[str, str]) -> str:
    return re.sub(r"\{(\w+)\}", lambda name: ids.get(name[1], "999"), path)


def sample(method: str, path: str, ids: dict[str, str]) -> dict:
    """A body that the operation takes, more or less: what it asks for by name, of the foreign collection."""
    if "requestBody" not in DOCUMENT["paths"][f"{PREFIX}{path}"][method.lower()]:
        return {}
    return {"json": {"collection_id": int(ids["collection_id"]), "shape_ids": [int(ids["shape_id"])]}}


def asked(caller, method: str, path: str, ids: dict[str, str]):
    query = {"shape_id": ids["shape_id"], "collection": ids["collection_id"], "name": "a.off"}
    headers = {"If-Match": '"0"'}
    return caller.request(method, concrete(path, ids), params=query, headers=headers, **sample(method, path, ids))


class TestOfAnotherCollection:
    """An admin of mugs is nobody among vases: whatever their token names there is not found, or not theirs to ask."""

    def test_no_operation_on_a_foreign_thing_succeeds(self, issue, mugs, foreign) -> None:
        caller = issue("olga", Role.ADMIN, (mugs.collection_id,))
        on_things = [each for each in operations() if "{" in each[1]]
        answers = {each: asked(caller, *each, foreign) for each in on_things}
        opened = {each: answer.text for each, answer in answers.items() if answer.status_code not in (403, 404, 422)}
        assert opened == {}
        assert sum(answer.status_code == 404 for answer in answers.values()) > len(answers) / 2

    def test_nothing_of_it_is_told(self, issue, mugs, foreign) -> None:
        caller = issue("olga", Role.ADMIN, (mugs.collection_id,))
        for method, path in operations():
            if (method, path) != ("GET", "/events"):  # which goes on until it is closed
                text = asked(caller, method, path, foreign).text
                assert "vases" not in text, (method, path)
                assert "v.off" not in text, (method, path)

    def test_nothing_of_it_changes(self, issue, mugs, foreign, workspace) -> None:
        caller = issue("olga", Role.ADMIN, (mugs.collection_id,))
        before = _state(workspace, mugs.other_id)
        for method, path in operations():
            if "{" in path and method != "GET":
                asked(caller, method, path, foreign)
        assert _state(workspace, mugs.other_id) == before


class TestWithoutAGoodToken:
    @pytest.mark.parametrize("kind", ["missing", "forged", "revoked"])
    def test_no_operation_answers(self, issue, nobody, workspace, foreign, kind) -> None:
        caller = nobody if kind == "missing" else issue("bob", Role.ADMIN)
        if kind == "forged":
            caller.headers = {"Authorization": f"Bearer pw_{'A' * 43}"}
        elif kind == "revoked":
            workspace.catalog.revoke_token(workspace.catalog.authenticate(caller.secret).id, "test")
        for method, path in operations():
            assert asked(caller, method, path, foreign).status_code in (401, 429), (method, path)


class TestOfAnnotators:
    @pytest.fixture
    def allowed(self) -> set[str]:
        """First steps of paths on which annotators may change something: their own work, and tools."""
        return {"leases", "queue", "drafts", "logout", "patches", "refine-boundaries", "refine-model"}

    def test_they_change_their_own_work_only(self, issue, mugs, workspace, allowed) -> None:
        caller = issue("ann", Role.ANNOTATOR)
        ids = {"collection_id": str(mugs.collection_id), "shape_id": str(mugs.ids["a.off"])}
        opened = set()
        for method, path in operations():
            steps = path.strip("/").split("/")
            if method == "GET" or steps[0] in allowed or steps[-1] in allowed:
                continue
            answer = asked(caller, method, path, ids)
            if answer.status_code not in (403, 404, 422):
                opened.add((method, path, answer.text))
        assert opened == set()


@pytest.mark.parametrize("wrong", PATH_LIKE)
def test_ids_that_are_none_lead_nowhere(operator, mugs, foreign, wrong) -> None:
    for method, path in operations():
        if method == "GET" and "{" in path:
            answer = asked(operator, method, path, dict.fromkeys(foreign, wrong) | {"collection_id": wrong})
            assert answer.status_code in (404, 405, 422), (path, answer.status_code)
            assert str(mugs.path) not in answer.text


def test_a_mesh_that_is_text_for_browsers_is_bytes_to_them(operator, mugs) -> None:
    """What was uploaded is never handed out; what is made of it has types of the service's own."""
    sniffed = b"<html><script>alert(1)</script>"
    path = f"/collections/{mugs.collection_id}/uploads"
    answer = operator.post(path, params={"name": "a.off"}, content=sniffed, headers={"Content-Type": "text/html"})
    upload = answer.json()["upload_id"]
    for headers in ({}, {"Accept": "text/html"}):
        back = operator.get(path, headers=headers)
        assert back.headers["content-type"] == "application/json"
        assert back.headers["x-content-type-options"] == "nosniff"
        assert "<script" not in back.text
    assert operator.get(f"{path}/{upload}").status_code == 405
    operator.delete(f"{path}/{upload}")


def _state(workspace, collection_id: int) -> tuple:
    catalog = workspace.catalog
    return (
        catalog.state_counts(collection_id),
        [job.state for job in catalog.jobs(collection_id)],
        catalog.parts(collection_id),
        [each.settings for each in catalog.list_collections() if each.id == collection_id],
    )
