"""Who gets in: by token, in which role, for how long; and how guessing is slowed down."""

from datetime import UTC, datetime, timedelta

import pytest
from sqlalchemy import text

from partwise.store.records import Role
from partwise_service.security.recent import TRUST_S
from partwise_service.settings import ServiceSettings

FORGED = "pw_" + "A" * 43


def _bearer(secret: str) -> dict[str, str]:
    return {"Authorization": f"Bearer {secret}"}


def test_without_credentials_nobody_gets_in(nobody) -> None:
    answer = nobody.get("/me")
    assert (answer.status_code, answer.headers["www-authenticate"]) == (401, "Bearer")
    assert answer.json()["type"] == "urn:partwise:problem:unauthenticated"


def test_a_token_tells_who_one_is(annotator, mugs) -> None:
    me = annotator.get("/me").json()
    assert (me["name"], me["role"], me["scope"], me["is_session"]) == ("ann", "annotator", [mugs.collection_id], False)


@pytest.mark.parametrize(
    "secret", [FORGED, "x", "", "pw_", "pw_" + "A" * 5_000, "pw_' OR 1=1 --", "pw_%00", "pw_\u00e9"]
)
def test_a_token_that_was_never_issued_is_refused(nobody, secret) -> None:
    headers = {b"Authorization": b"Bearer " + secret.encode()}
    assert nobody.get("/me", headers={k.decode(): v for k, v in headers.items()}).status_code == 401


@pytest.mark.parametrize("scheme", ["Basic", "Token", "bearer bearer"])
def test_other_schemes_are_refused(annotator, nobody, scheme) -> None:
    answer = nobody.get("/me", headers={"Authorization": f"{scheme} {annotator.secret}"})
    assert answer.status_code == 401


def test_an_expired_token_is_refused(issue, app, workspace) -> None:
    caller = issue("ann", Role.ANNOTATOR)
    _execute(workspace, "UPDATE token SET expires_at = :at", datetime.now(UTC) - timedelta(seconds=1))
    assert caller.get("/me").status_code == 401


def test_a_revoked_token_is_refused_at_once(issue, admin) -> None:
    caller = issue("ann", Role.ANNOTATOR)
    assert caller.get("/me").status_code == 200
    token_id = next(t["id"] for t in admin.get("/tokens").json()["items"] if t["person_name"] == "ann")
    assert admin.delete(f"/tokens/{token_id}").status_code == 200
    assert caller.get("/me").status_code == 401


def test_the_answer_does_not_say_why_a_token_is_refused(issue, nobody, workspace) -> None:
    caller = issue("ann", Role.ANNOTATOR)
    _execute(workspace, "UPDATE token SET expires_at = :at", datetime.now(UTC) - timedelta(seconds=1))
    assert caller.get("/me").json() == nobody.get("/me", headers=_bearer(FORGED)).json()


def test_secrets_are_not_in_the_catalog(annotator, workspace) -> None:
    with workspace.catalog._engine.connect() as connection:
        rows = connection.execute(text("SELECT * FROM token")).all()
    assert rows
    assert annotator.secret not in repr(rows)


def test_use_is_noted(annotator, workspace) -> None:
    annotator.get("/me")
    assert workspace.catalog.tokens()[0].last_used_at is not None


class TestLimits:
    @pytest.fixture
    def settings(self, mugs) -> ServiceSettings:
        return ServiceSettings(workspace=mugs.path, max_auth_failures=3, auth_window_s=60)

    def _guess(self, nobody, n: int, secret: str = FORGED) -> list[int]:
        return [nobody.get("/me", headers=_bearer(f"{secret}{i}")).status_code for i in range(n)]

    def test_guessing_is_limited(self, nobody) -> None:
        assert self._guess(nobody, 5) == [401, 401, 401, 429, 429]
        answer = nobody.get("/me", headers=_bearer(FORGED))
        assert 0 < int(answer.headers["retry-after"]) <= 60

    def test_time_lifts_the_limit(self, nobody, clock) -> None:
        self._guess(nobody, 4)
        clock.now_s += 61
        assert self._guess(nobody, 1) == [401]

    def test_guessing_codes_is_limited_as_well(self, nobody) -> None:
        codes = [nobody.post("/login", json={"code": f"{i}" * 20}).status_code for i in range(5)]
        assert codes == [401, 401, 401, 429, 429]

    def test_a_neighbour_who_worked_before_is_not_locked_out(self, nobody, annotator) -> None:
        assert annotator.get("/me").status_code == 200
        self._guess(nobody, 5)
        assert annotator.get("/me").status_code == 200

    def test_a_revoked_token_is_no_way_around_the_limit(self, nobody, annotator, workspace, clock) -> None:
        annotator.get("/me")
        workspace.catalog.revoke_token(workspace.catalog.tokens()[0].id, "test")
        clock.now_s += TRUST_S
        self._guess(nobody, 3)
        assert [annotator.get("/me").status_code for _ in range(2)] == [401, 429]

    def test_requests_without_credentials_do_not_count(self, nobody, issue) -> None:
        assert {nobody.get("/me").status_code for _ in range(6)} == {401}
        assert issue("ann", Role.ANNOTATOR).get("/me").status_code == 200


def _execute(workspace, statement: str, at: datetime) -> None:
    with workspace.catalog._engine.begin() as connection:
        connection.execute(text(statement), {"at": at.replace(tzinfo=None).isoformat(" ")})
