"""Every error answer is a problem document that gives nothing away."""

import asyncio
import logging

import pytest
from sqlalchemy.exc import IntegrityError

from partwise.errors import ConfigError, ConflictError, StoreError
from partwise_service.app import create_app
from partwise_service.problems import MEDIA_TYPE
from partwise_service.settings import ServiceSettings

PLACE = "/srv/secret/catalog.sqlite"


def _is_problem(answer, status: int) -> bool:
    document = answer.json()
    return (
        answer.status_code == document["status"] == status
        and answer.headers["content-type"] == MEDIA_TYPE
        and document["type"].startswith("urn:partwise:problem:")
        and {"title", "detail"} <= set(document)
    )


@pytest.fixture
def failing(annotator, workspace, monkeypatch):
    """Asks for something while the catalog fails in a way."""

    def ask(error: Exception):
        def fail(*_args, **_given):
            raise error

        monkeypatch.setattr(workspace.catalog, "list_collections", fail, raising=True)
        return annotator.get("/collections")

    return ask


@pytest.mark.parametrize("path", ["/nothing", "/collections/", "/collections/1/nothing"])
def test_unknown_paths(annotator, path) -> None:
    assert _is_problem(annotator.get(path), 404)


def test_a_wrong_method_names_the_right_ones(annotator) -> None:
    answer = annotator.delete("/collections")
    assert _is_problem(answer, 405)
    assert set(answer.headers["allow"].replace(" ", "").split(",")) & {"GET", "POST"}


@pytest.mark.parametrize(
    "collection_id", ["x", "0", "-1", "1.5", "99999999999999999999", "1%20OR%201=1", "%2e%2e", "1%00", "%0d%0aX-Evil:1"]
)
def test_ids_that_are_none(annotator, collection_id) -> None:
    answer = annotator.get(f"/collections/{collection_id}")
    assert _is_problem(answer, 422)
    assert "x-evil" not in answer.headers


@pytest.mark.parametrize("mesh_hash", ["abc", "g" * 64, "..%2f..%2fpartwise.toml", "A" * 64])
def test_hashes_that_are_none(annotator, mugs, mesh_hash) -> None:
    assert annotator.get(f"/meshes/{mesh_hash}", params={"shape_id": 1}).status_code in (404, 422)


def test_an_invalid_request_says_what_is_wrong_where(reviewer, mugs) -> None:
    answer = reviewer.post(f"/collections/{mugs.collection_id}/parts", json={"name": 7})
    assert _is_problem(answer, 422)
    assert answer.json()["errors"] == [{"in": "body", "at": "name", "why": "Input should be a valid string"}]


@pytest.mark.parametrize("body", [b"{", b"\xff\xfe", b'{"name": "a"', b"[" * 50_000, b""])
def test_bodies_that_are_no_json(reviewer, mugs, body) -> None:
    headers = {"Content-Type": "application/json"}
    answer = reviewer.post(f"/collections/{mugs.collection_id}/parts", content=body, headers=headers)
    assert _is_problem(answer, answer.status_code)
    assert answer.status_code in (400, 422)


@pytest.mark.parametrize("content_type", ["text/plain", "application/x-www-form-urlencoded", "application/pickle"])
def test_bodies_of_another_type_are_not_read(reviewer, mugs, content_type) -> None:
    headers = {"Content-Type": content_type}
    answer = reviewer.post(f"/collections/{mugs.collection_id}/parts", content=b'{"name": "lid"}', headers=headers)
    assert _is_problem(answer, 422)


def test_a_fault_has_an_id_that_is_in_the_log(failing, caplog) -> None:
    with caplog.at_level(logging.ERROR, "partwise_service"):
        answer = failing(RuntimeError(f"cannot read {PLACE}"))
    assert _is_problem(answer, 500)
    assert [record.fault_id for record in caplog.records if hasattr(record, "fault_id")] == [answer.json()["fault_id"]]
    assert PLACE in caplog.text
    assert "secret" not in answer.text
    assert "Traceback" not in answer.text


def test_a_fault_has_the_usual_headers(failing) -> None:
    answer = failing(RuntimeError("no"))
    assert (answer.headers["x-content-type-options"], answer.headers["cache-control"]) == ("nosniff", "no-store")


@pytest.mark.parametrize(
    ("error", "status"),
    [(StoreError(f"the catalog at {PLACE} is locked"), 503), (ConfigError(PLACE), 500)],
)
def test_places_on_the_server_are_not_told(failing, error, status) -> None:
    answer = failing(error)
    assert _is_problem(answer, status)
    assert "secret" not in answer.text


def test_the_databases_words_are_not_told(failing) -> None:
    error = ConflictError("refused a change: UNIQUE constraint failed: token.secret_sha256")
    error.__cause__ = IntegrityError("INSERT INTO token", {}, Exception("UNIQUE constraint failed"))
    answer = failing(error)
    assert _is_problem(answer, 409)
    assert "token" not in answer.text
    assert "UNIQUE" not in answer.text


def test_a_workspace_that_is_none_stops_the_start(tmp_path) -> None:
    app = create_app(ServiceSettings(workspace=tmp_path))

    async def start() -> None:
        async with app.router.lifespan_context(app):
            raise AssertionError("it started")

    with pytest.raises(ConfigError, match=r"partwise\.toml"):
        asyncio.run(start())
