"""Conformance: tokens and login codes."""
# ruff: noqa: S101 # a test suite asserts

from datetime import UTC, datetime, timedelta

from partwise.errors import ConflictError, NotFoundError, ParameterError
from partwise.store.catalog import Catalog
from partwise.store.records import IssuedToken, NewToken, Role
from partwise.testing.catalog.samples import add_collection
from partwise.testing.expect import raises


def _in(hours: float) -> datetime:
    return datetime.now(UTC) + timedelta(hours=hours)


def _issued(catalog: Catalog, role: Role = Role.ANNOTATOR, scope: tuple[int, ...] | None = None) -> IssuedToken:
    """A token of a new person."""
    ann = catalog.add_person("ann")
    return catalog.issue_token(NewToken(ann.id, role, _in(24), scope, "laptop"), "operator")


class TokenConformance:
    def test_a_secret_is_who_it_was_issued_to(self, catalog: Catalog) -> None:
        collection, _ = add_collection(catalog, 0)
        issued = _issued(catalog, Role.REVIEWER, (collection.id,))
        token = catalog.authenticate(issued.secret)
        assert token == issued.token == catalog.token(issued.token.id)
        assert (token.person_name, token.role, token.note) == ("ann", Role.REVIEWER, "laptop")
        assert token.opens(collection.id)
        assert not token.opens(collection.id + 1)
        assert catalog.tokens() == [token]

    def test_secrets_are_long_random_and_not_printed(self, catalog: Catalog) -> None:
        issued = _issued(catalog)
        assert issued.secret.startswith("pw_")
        assert len(issued.secret) == len("pw_") + 43
        assert issued.secret not in repr(issued)
        other = catalog.issue_token(NewToken(issued.token.person_id, Role.ADMIN, _in(1)), "operator")
        assert other.secret != issued.secret

    def test_other_secrets_are_nobodys(self, catalog: Catalog) -> None:
        issued = _issued(catalog)
        for secret in ("", "pw_", issued.secret[:-1], issued.secret.upper(), issued.secret.removeprefix("pw_")):
            assert catalog.authenticate(secret) is None

    def test_a_revoked_token_opens_nothing(self, catalog: Catalog) -> None:
        issued = _issued(catalog)
        revoked = catalog.revoke_token(issued.token.id, "operator")
        assert revoked.revoked_at is not None
        assert catalog.revoke_token(issued.token.id, "operator") == revoked
        assert catalog.authenticate(issued.secret) is None

    def test_issuing_and_revoking_are_on_the_audit_trail_without_the_secret(self, catalog: Catalog) -> None:
        issued = _issued(catalog)
        catalog.revoke_token(issued.token.id, "rita")
        entries = catalog.audit()
        assert [(entry.actor, entry.action) for entry in entries] == [
            ("operator", "issue token"),
            ("rita", "revoke token"),
        ]
        assert issued.secret not in str(entries)

    def test_whoever_trusts_tokens_hears_that_one_was_revoked(self, catalog: Catalog) -> None:
        issued = _issued(catalog)
        assert catalog.events(after=0) == []
        for _ in range(2):
            catalog.revoke_token(issued.token.id, "rita")
        assert [event.is_revocation for event in catalog.events(after=0)] == [True]

    def test_a_token_must_make_sense(self, catalog: Catalog) -> None:
        ann = catalog.add_person("ann")
        with raises(ParameterError, "future"):
            catalog.issue_token(NewToken(ann.id, Role.ADMIN, _in(-1)), "operator")
        with raises(NotFoundError, "99"):
            catalog.issue_token(NewToken(99, Role.ADMIN, _in(1)), "operator")
        with raises(NotFoundError, "99"):
            catalog.issue_token(NewToken(ann.id, Role.ADMIN, _in(1), (99,)), "operator")
        with raises(ParameterError, "scope"):
            NewToken(ann.id, Role.ADMIN, _in(1), ())

    def test_roles_include_those_before_them(self, catalog: Catalog) -> None:  # noqa: ARG002 # the suite's signature
        assert Role.ADMIN.includes(Role.ANNOTATOR)
        assert Role.REVIEWER.includes(Role.REVIEWER)
        assert not Role.REVIEWER.includes(Role.OPERATOR)

    def test_use_is_noted(self, catalog: Catalog) -> None:
        issued = _issued(catalog)
        assert issued.token.last_used_at is None
        catalog.note_token_use(issued.token.id)
        used = catalog.token(issued.token.id).last_used_at
        assert used is not None
        catalog.note_token_use(issued.token.id)
        assert catalog.token(issued.token.id).last_used_at == used

    def test_a_login_code_is_exchanged_once_for_a_session(self, catalog: Catalog) -> None:
        issued = _issued(catalog, Role.OPERATOR)
        code = catalog.issue_login_code(issued.token.id)
        session = catalog.exchange_login_code(code.code, 3600)
        assert session is not None
        assert (session.token.is_session, session.token.parent_id) == (True, issued.token.id)
        assert (session.token.person_id, session.token.role) == (issued.token.person_id, Role.OPERATOR)
        assert catalog.authenticate(session.secret) == session.token
        assert catalog.exchange_login_code(code.code, 3600) is None
        assert code.code not in repr(code)

    def test_a_session_does_not_outlive_its_token(self, catalog: Catalog) -> None:
        issued = _issued(catalog)
        session = catalog.exchange_login_code(catalog.issue_login_code(issued.token.id).code, 1e9)
        assert session is not None
        assert session.token.expires_at == issued.token.expires_at
        catalog.revoke_token(issued.token.id, "operator")
        assert catalog.authenticate(session.secret) is None

    def test_codes_of_ended_tokens_and_unknown_codes_open_nothing(self, catalog: Catalog) -> None:
        issued = _issued(catalog)
        code = catalog.issue_login_code(issued.token.id)
        catalog.revoke_token(issued.token.id, "operator")
        assert catalog.exchange_login_code(code.code, 3600) is None
        assert catalog.exchange_login_code("x", 3600) is None
        with raises(ConflictError, "ended"):
            catalog.issue_login_code(issued.token.id)
        with raises(NotFoundError, "99"):
            catalog.issue_login_code(99)

    def test_times_of_codes_and_sessions_have_limits(self, catalog: Catalog) -> None:
        issued = _issued(catalog)
        for valid_s in (0.0, 3601.0):
            with raises(ParameterError, "login code"):
                catalog.issue_login_code(issued.token.id, valid_s)
        with raises(ParameterError, "session"):
            catalog.exchange_login_code("x", 0)

    def test_tokens_are_listed_by_person_a_page_at_a_time(self, catalog: Catalog) -> None:
        first = _issued(catalog).token
        bob = catalog.add_person("bob")
        second = catalog.issue_token(NewToken(bob.id, Role.ADMIN, _in(1)), "operator").token
        assert catalog.tokens(person_id=bob.id) == [second]
        assert catalog.tokens(limit=1) == [first]
        assert catalog.tokens(after=first.id) == [second]
