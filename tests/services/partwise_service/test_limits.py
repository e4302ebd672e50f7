"""Limits on bodies, the limiter by itself, and the headers that every answer has."""

import asyncio
from dataclasses import replace
from datetime import UTC, datetime

import pytest

from partwise.store.records import REVOKED, Event, Token
from partwise_service.app import UPLOAD_PATH
from partwise_service.problems import ProblemError
from partwise_service.security.at_once import AtOnce
from partwise_service.security.middleware import BodyLimitMiddleware
from partwise_service.security.rate_limit import FailureLimiter
from partwise_service.security.recent import ASSURED_S, TRUST_S, RecentlyGood
from partwise_service.settings import ServiceSettings

LIMIT = 2_000


class TestBodies:
    @pytest.fixture
    def settings(self, mugs) -> ServiceSettings:
        return ServiceSettings(workspace=mugs.path, max_body_bytes=LIMIT)

    def test_a_large_body_is_refused_by_its_length(self, reviewer, mugs) -> None:
        answer = reviewer.post(f"/collections/{mugs.collection_id}/parts", json={"name": "x" * LIMIT})
        assert (answer.status_code, answer.json()["type"]) == (413, "urn:partwise:problem:too-large")

    def test_a_large_body_without_a_length_is_refused_while_it_comes(self, reviewer, mugs) -> None:
        sent = []

        def chunks():
            for _ in range(1_000):
                sent.append(1)
                yield b"x" * 1_000

        headers = {"Content-Type": "application/json"}
        answer = reviewer.post(f"/collections/{mugs.collection_id}/parts", content=chunks(), headers=headers)
        assert answer.status_code == 413

    def test_a_large_body_is_refused_before_anybody_is_known(self, nobody) -> None:
        assert nobody.post("/login", json={"code": "x" * LIMIT}).status_code == 413

    @pytest.mark.parametrize("length", ["-1", "x", "1e3", ""])
    def test_a_length_that_is_no_number_is_refused(self, reviewer, length) -> None:
        assert reviewer.post("/login", content=b"{}", headers={"Content-Length": length}).status_code == 400


def test_reading_stops_at_the_limit() -> None:
    """However much a caller sends, no more than the limit and a chunk is taken in."""
    n_read = 0

    async def app(scope, receive, send) -> None:
        while (await receive())["more_body"]:
            pass

    async def receive():
        nonlocal n_read
        n_read += 1
        return {"type": "http.request", "body": b"x" * 1_000, "more_body": True}

    async def send(message) -> None:
        raise AssertionError(message)

    limited = BodyLimitMiddleware(app, LIMIT, LIMIT, UPLOAD_PATH)
    with pytest.raises(Exception, match="at most 2,000 bytes"):
        asyncio.run(limited({"type": "http", "path": "/", "headers": []}, receive, send))
    assert n_read == LIMIT // 1_000 + 1


@pytest.mark.parametrize(
    ("path", "is_refused"),
    [
        ("/api/v1/collections/1/uploads", False),
        ("/api/v1/collections/1/uploads/x", True),
        ("/api/v1/collections/1/jobs", True),
        ("/api/v1/jobs", True),
    ],
)
def test_uploads_may_be_larger(path: str, is_refused: bool) -> None:
    statuses = []

    async def app(scope, receive, send) -> None:
        await send({"type": "http.response.start", "status": 200})

    async def send(message) -> None:
        statuses.append(message.get("status"))

    limited = BodyLimitMiddleware(app, 10, 1_000, UPLOAD_PATH)
    scope = {"type": "http", "path": path, "headers": [(b"content-length", b"500")]}
    asyncio.run(limited(scope, None, send))
    assert statuses[0] == (413 if is_refused else 200)


def test_the_limiter_counts_each_key_by_itself() -> None:
    limiter = FailureLimiter(2, 10, lambda: 0.0)
    for _ in range(2):
        limiter.record("a")
    assert (limiter.wait_s("a"), limiter.wait_s("b")) == (10, 0)


def test_the_limiters_window_slides() -> None:
    now = [0.0]
    limiter = FailureLimiter(2, 10, lambda: now[0])
    for at in (0.0, 6.0):
        now[0] = at
        limiter.record("a")
    assert limiter.wait_s("a") == 4
    now[0] = 10
    assert limiter.wait_s("a") == 0
    limiter.record("a")
    assert limiter.wait_s("a") == 6


def test_the_limiter_forgets_the_oldest_key_when_it_is_full() -> None:
    limiter = FailureLimiter(1, 10, lambda: 0.0, max_keys=2)
    for key in "abc":
        limiter.record(key)
    assert [limiter.wait_s(key) > 0 for key in "abc"] == [False, True, True]


def test_what_has_ended_is_under_way_no_more_however_it_ended() -> None:
    at_once = AtOnce(1, "calls")
    for _ in range(2):
        with pytest.raises(ZeroDivisionError), at_once.one_more("a"):
            raise ZeroDivisionError
    with at_once.one_more("a"), at_once.one_more("b"):
        with pytest.raises(ProblemError, match="1 calls at once, as many as you may"), at_once.one_more("a"):
            pass
        with pytest.raises(ProblemError), at_once.one_more("a"):  # refused, it has left the first one's place alone
            pass


@pytest.fixture
def good_token(annotator, workspace) -> Token:
    return workspace.catalog.authenticate(annotator.secret)


class TestRecentSecrets:
    def test_they_are_bounded(self, good_token) -> None:
        recent = RecentlyGood(lambda: 0.0, max_secrets=2)
        for fingerprint in (b"a", b"b", b"c"):
            recent.remember(fingerprint, good_token, 0.0)
        assert [recent.holds(each) for each in (b"a", b"b", b"c")] == [False, True, True]

    def test_they_are_trusted_for_seconds(self, good_token) -> None:
        now = [7.0]
        recent = RecentlyGood(lambda: now[0])
        recent.remember(b"a", good_token, now[0])
        recent.hear([], now[0], is_all=True)
        assert recent.trusted(b"a") == good_token
        now[0] += TRUST_S
        recent.hear([], now[0], is_all=True)
        assert recent.trusted(b"a") is None
        assert recent.holds(b"a")

    @pytest.mark.parametrize("is_all", [True, False])
    def test_nobody_is_trusted_without_word_of_revocations(self, good_token, is_all) -> None:
        now = [7.0]
        recent = RecentlyGood(lambda: now[0])
        recent.remember(b"a", good_token, now[0])
        assert recent.trusted(b"a") is None
        recent.hear([], now[0], is_all=is_all)
        assert (recent.trusted(b"a") is not None) == is_all
        now[0] += ASSURED_S
        assert recent.trusted(b"a") is None

    def test_word_of_a_revocation_ends_all_trust(self, good_token) -> None:
        now = [7.0]
        recent = RecentlyGood(lambda: now[0])
        for fingerprint in (b"a", b"b"):
            recent.remember(fingerprint, good_token, now[0])
        revoked = Event(1, datetime.now(UTC), REVOKED.kind, None, dict(REVOKED.payload))
        recent.hear([revoked], now[0], is_all=True)
        assert recent.trusted(b"a") is recent.trusted(b"b") is None
        now[0] += 1
        recent.remember(b"a", good_token, now[0])
        assert recent.trusted(b"a") == good_token

    def test_a_revocation_ends_all_trust_also_in_what_was_being_looked_up(self, good_token) -> None:
        now = [7.0]
        recent = RecentlyGood(lambda: now[0])
        recent.remember(b"a", good_token, now[0])
        now[0] += 1
        recent.distrust_all()
        recent.remember(b"b", good_token, 7.5)
        recent.hear([], now[0], is_all=True)
        assert recent.trusted(b"a") is recent.trusted(b"b") is None

    def test_an_expired_token_is_not_trusted(self, good_token) -> None:
        recent = RecentlyGood(lambda: 7.0)
        recent.remember(b"a", replace(good_token, expires_at=datetime.now(UTC)), 7.0)
        recent.hear([], 7.0, is_all=True)
        assert recent.trusted(b"a") is None


@pytest.mark.parametrize("path", ["/me", "/nothing", "/openapi.json"])
def test_every_answer_has_the_security_headers(annotator, path) -> None:
    headers = annotator.get(path).headers
    assert headers["x-content-type-options"] == "nosniff"
    assert headers["referrer-policy"] == "no-referrer"
    assert headers["content-security-policy"] == "default-src 'none'; frame-ancestors 'none'"
    assert headers["cache-control"] == "no-store"


def test_pages_may_load_from_the_service_only(client) -> None:
    policy = client.get("/").headers["content-security-policy"]
    assert {"default-src 'self'", "frame-ancestors 'none'", "object-src 'none'"} <= set(policy.split("; "))
