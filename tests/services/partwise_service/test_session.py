"""Sessions in a browser: the cookie, one-time codes, and pages of foreign origins."""

from datetime import UTC, datetime, timedelta

import pytest

from partwise.store.records import NewToken, Role
from partwise_service.security.authentication import SESSION_COOKIE
from partwise_service.security.recent import TRUST_S
from partwise_service.settings import ServiceSettings

ORIGIN = {"Origin": "http://127.0.0.1:8000"}
FOREIGN = {"Origin": "https://evil.example"}


@pytest.fixture
def code(reviewer, workspace) -> str:
    """A login code of rita's token."""
    token = next(each for each in workspace.catalog.tokens() if each.person_name == "rita")
    return workspace.catalog.issue_login_code(token.id).code


@pytest.fixture
def browser(nobody, code):
    """Logged in by the code."""
    assert nobody.post("/login", json={"code": code}, headers=ORIGIN).status_code == 200
    return nobody


def test_a_code_begins_a_session(nobody, code) -> None:
    answer = nobody.post("/login", json={"code": code}, headers=ORIGIN)
    assert (answer.json()["name"], answer.json()["is_session"]) == ("rita", True)
    assert nobody.get("/me").json()["role"] == "reviewer"


def test_the_cookie_is_out_of_reach_of_scripts_and_other_sites(nobody, code) -> None:
    cookie = nobody.post("/login", json={"code": code}).headers["set-cookie"]
    assert {"HttpOnly", "SameSite=strict", "Path=/"} <= set(cookie.split("; "))
    assert "Secure" not in cookie


def test_a_code_works_once(nobody, code) -> None:
    assert [nobody.post("/login", json={"code": code}).status_code for _ in range(2)] == [200, 401]


def test_a_token_begins_a_session_too(nobody, reviewer) -> None:
    assert nobody.post("/login", json={"token": reviewer.secret}).status_code == 200
    assert nobody.get("/me").json()["is_session"]


def test_a_neighbours_attempts_keep_nobody_out_whose_token_worked_lately(nobody, reviewer, settings) -> None:
    assert reviewer.get("/me").status_code == 200
    for n in range(settings.max_auth_failures):
        nobody.post("/login", json={"code": f"{n}-guessed"})
    assert nobody.post("/login", json={"code": "another"}).status_code == 429
    assert nobody.post("/login", json={"token": reviewer.secret}).status_code == 200


@pytest.mark.parametrize("body", [{}, {"code": "a", "token": "b"}, {"code": ""}, {"code": 7}, {"code": "a" * 201}, "a"])
def test_what_is_no_login_is_refused(nobody, body) -> None:
    assert nobody.post("/login", json=body).status_code == 422


def test_a_forged_code_is_refused(nobody) -> None:
    assert nobody.post("/login", json={"code": "A" * 43}).status_code == 401


def test_a_session_reads_without_an_origin(browser, mugs) -> None:
    assert browser.get(f"/collections/{mugs.collection_id}").status_code == 200


@pytest.mark.parametrize("headers", [{}, FOREIGN, {"Origin": "null"}, {"Origin": "http://127.0.0.1:8001"}])
def test_a_session_changes_nothing_from_a_foreign_page(browser, mugs, headers) -> None:
    answer = browser.post(f"/collections/{mugs.collection_id}/parts", json={"name": "lid"}, headers=headers)
    assert (answer.status_code, answer.json()["type"]) == (403, "urn:partwise:problem:foreign-origin")


def test_a_session_changes_things_from_the_services_own_page(browser, mugs) -> None:
    answer = browser.post(f"/collections/{mugs.collection_id}/parts", json={"name": "lid"}, headers=ORIGIN)
    assert answer.status_code == 201


def test_a_foreign_page_cannot_log_anybody_in(nobody, code) -> None:
    assert nobody.post("/login", json={"code": code}, headers=FOREIGN).status_code == 403


def test_logging_out_ends_the_session(browser, client) -> None:
    secret = client.cookies[SESSION_COOKIE]
    assert browser.post("/logout", headers=ORIGIN).status_code == 204
    assert SESSION_COOKIE not in client.cookies
    client.cookies.set(SESSION_COOKIE, secret)
    assert browser.get("/me").status_code == 401


def test_a_session_ends_with_the_token_it_came_from(browser, workspace, clock) -> None:
    token = next(each for each in workspace.catalog.tokens() if each.person_name == "rita" and not each.is_session)
    workspace.catalog.revoke_token(token.id, "test")
    clock.now_s += TRUST_S
    assert browser.get("/me").status_code == 401


def test_a_session_is_good_as_a_cookie_only(browser, client) -> None:
    secret = client.cookies[SESSION_COOKIE]
    client.cookies.clear()
    assert browser.get("/me", headers={"Authorization": f"Bearer {secret}"}).status_code == 401


def test_a_token_is_no_cookie(client, nobody, reviewer) -> None:
    client.cookies.set(SESSION_COOKIE, reviewer.secret)
    assert nobody.get("/me").status_code == 401


class TestHttps:
    @pytest.fixture
    def settings(self, mugs) -> ServiceSettings:
        return ServiceSettings(workspace=mugs.path, public_url="https://labels.example.org")

    def test_the_cookie_is_for_https_only(self, nobody, code) -> None:
        answer = nobody.post("/login", json={"code": code}, headers={"Origin": "https://labels.example.org"})
        assert "Secure" in answer.headers["set-cookie"]
        assert answer.headers["strict-transport-security"].startswith("max-age=")

    def test_the_address_it_listens_on_is_no_origin(self, nobody, code) -> None:
        assert nobody.post("/login", json={"code": code}, headers=ORIGIN).status_code == 403


class TestCrossOrigin:
    @pytest.fixture
    def settings(self, mugs) -> ServiceSettings:
        return ServiceSettings(workspace=mugs.path, cors_origins="https://lab.example.org")

    def test_a_named_origin_may_call(self, nobody) -> None:
        asked = {"Origin": "https://lab.example.org", "Access-Control-Request-Method": "GET"}
        answer = nobody.request("OPTIONS", "/me", headers=asked)
        assert answer.headers["access-control-allow-origin"] == "https://lab.example.org"

    @pytest.mark.parametrize("header", ["Authorization", "Content-Type", "If-Match", "If-None-Match", "Last-Event-ID"])
    def test_it_may_send_every_header_that_the_service_reads(self, nobody, header) -> None:
        asked = {"Origin": "https://lab.example.org", "Access-Control-Request-Method": "POST"}
        wished = {**asked, "Access-Control-Request-Headers": header.lower()}
        answer = nobody.request("OPTIONS", "/drafts/1/confirm", headers=wished)
        assert answer.status_code == 200
        assert header.lower() in answer.headers["access-control-allow-headers"].lower()

    @pytest.mark.parametrize(
        "origin", ["https://evil.example", "https://lab.example.org.evil.example", "http://lab.example.org", "null"]
    )
    def test_no_other_origin_may(self, nobody, origin) -> None:
        answer = nobody.request("OPTIONS", "/me", headers={"Origin": origin, "Access-Control-Request-Method": "GET"})
        assert "access-control-allow-origin" not in answer.headers


def test_by_default_no_other_origin_may_call(annotator) -> None:
    assert "access-control-allow-origin" not in annotator.get("/me", headers=FOREIGN).headers


def test_sessions_do_not_outlive_their_time(nobody, code, settings) -> None:
    cookie = nobody.post("/login", json={"code": code}).headers["set-cookie"]
    max_age_s = next(int(part.partition("=")[2]) for part in cookie.split("; ") if part.startswith("Max-Age"))
    assert 0 < max_age_s <= settings.session_h * 3600


def test_a_session_is_no_longer_good_than_its_token(nobody, workspace) -> None:
    person = workspace.catalog.add_person("bob")
    issued = workspace.catalog.issue_token(
        NewToken(person.id, Role.ANNOTATOR, datetime.now(UTC) + timedelta(minutes=5)), "test"
    )
    cookie = nobody.post("/login", json={"token": issued.secret}).headers["set-cookie"]
    assert int(cookie.partition("Max-Age=")[2].partition(";")[0]) <= 300
