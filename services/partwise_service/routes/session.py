"""/login, /logout, /me: a browser's session, and who one is."""

from datetime import UTC, datetime

from fastapi import APIRouter, Request, Response

from partwise.store.records import IssuedToken
from partwise_service.answering import AnswerRoute
from partwise_service.dependencies import Caller, CatalogDep, ServiceDep, client_address, refuse_foreign_page
from partwise_service.schemas.session import Login, Me, TokenLogin
from partwise_service.security.authentication import (
    SESSION_COOKIE,
    Credential,
    authenticate,
    record_failure,
    refuse_too_many,
    refused,
)
from partwise_service.security.identity import Identity
from partwise_service.service import Service

HOUR_S = 3600.0
router = APIRouter(route_class=AnswerRoute, tags=["session"])


@router.post("/login")
def log_in(request: Request, response: Response, open_service: ServiceDep, login: Login) -> Me:
    """Begin a session for a one-time code or a token: the answer sets a cookie that scripts cannot read."""
    refuse_foreign_page(request, open_service)
    session = _session(open_service, login, client_address(request))
    max_age_s = int((session.token.expires_at - datetime.now(UTC)).total_seconds())
    _set_cookie(response, open_service, session.secret, max_age_s)
    return Me.of(Identity(session.token))


@router.post("/logout", status_code=204)
def log_out(response: Response, caller: Caller, open_service: ServiceDep, catalog: CatalogDep) -> None:
    """End the session. A token that was sent as such stays good."""
    if caller.token.is_session:
        catalog.revoke_token(caller.token.id, caller.name)
        open_service.recent.distrust_all()
    _set_cookie(response, open_service, "", 0)


@router.get("/me")
def show_me(caller: Caller) -> Me:
    """Who one is, in which role, and for how long."""
    return Me.of(caller)


def _session(open_service: Service, login: Login, address: str) -> IssuedToken:
    catalog, settings = open_service.workspace.catalog, open_service.settings
    if isinstance(login, TokenLogin):
        identity = authenticate(open_service, Credential(login.token, is_session=False), address)
        code = catalog.issue_login_code(identity.token.id, settings.login_code_s).code
    else:
        code = login.code
        refuse_too_many(open_service, address, code)
    session = catalog.exchange_login_code(code, settings.session_h * HOUR_S)
    if session is None:
        record_failure(open_service, address, code)
        raise refused()
    return session


def _set_cookie(response: Response, open_service: Service, secret: str, max_age_s: int) -> None:
    response.set_cookie(
        SESSION_COOKIE,
        secret,
        max_age=max_age_s,
        path="/",
        secure=open_service.settings.is_https,
        httponly=True,
        samesite="strict",
    )
