"""/people, /tokens, /audit: for those who run the service."""

from datetime import UTC, datetime, timedelta
from typing import Annotated

from fastapi import APIRouter, Query

from partwise.store.records import NewToken, Role
from partwise_service.answering import AnswerRoute
from partwise_service.dependencies import (
    Admin,
    Caller,
    CatalogDep,
    Operator,
    Reviewer,
    ServiceDep,
    require_all_scope,
    require_role,
)
from partwise_service.schemas.base import MAX_ROW_ID, Page, RowId, refuse_unprintable
from partwise_service.schemas.people import (
    AuditOut,
    IssuedTokenOut,
    NewPerson,
    NewTokenIn,
    PeopleOut,
    PersonOut,
    TokenOut,
)

MAX_PAGE = 500
router = APIRouter(route_class=AnswerRoute, tags=["people"])
AfterId = Annotated[int, Query(ge=0, le=MAX_ROW_ID, description="`next` of the page before.")]
BeforeId = Annotated[int | None, Query(ge=1, le=MAX_ROW_ID, description="`next` of the page before.")]
Limit = Annotated[int, Query(ge=1, le=MAX_PAGE)]


@router.get("/people")
def list_people(_caller: Reviewer, catalog: CatalogDep) -> PeopleOut:
    """Everybody, by name."""
    return PeopleOut(items=[PersonOut.model_validate(person) for person in catalog.list_people()])


@router.post("/people", status_code=201)
def add_person(caller: Operator, catalog: CatalogDep, new: NewPerson) -> PersonOut:
    """Add a person, to give them a token."""
    require_all_scope(caller)
    refuse_unprintable("a person's name", new.name)
    person = catalog.add_person(new.name)
    catalog.append_audit(caller.name, "add person", f"person {person.id}", {"name": person.name})
    return PersonOut.model_validate(person)


@router.get("/tokens")
def list_tokens(caller: Admin, catalog: CatalogDep, after: AfterId = 0, limit: Limit = 100) -> Page[TokenOut]:
    """Tokens by id, those that ended too. Secrets are not on record."""
    require_all_scope(caller)
    found = catalog.tokens(after=after, limit=limit)
    next_after = str(found[-1].id) if len(found) == limit else None
    return Page(items=[TokenOut.of(token) for token in found], next=next_after)


@router.post("/tokens", status_code=201)
def issue_token(caller: Admin, catalog: CatalogDep, new: NewTokenIn) -> IssuedTokenOut:
    """A new token for a person. Its secret is in this answer and nowhere else."""
    require_all_scope(caller)
    expires_at = datetime.now(UTC) + timedelta(days=new.days)
    scope = None if new.scope is None else tuple(sorted(set(new.scope)))
    issued = catalog.issue_token(NewToken(new.person_id, new.role, expires_at, scope, new.note), caller.name)
    return IssuedTokenOut(token=TokenOut.of(issued.token), secret=issued.secret)


@router.delete("/tokens/{token_id}")
def revoke_token(caller: Caller, service: ServiceDep, token_id: RowId) -> TokenOut:
    """End a token, with the sessions that came from it. One's own, or anybody's as an admin."""
    if caller.token.id != token_id:
        require_role(caller, Role.ADMIN)
        require_all_scope(caller)
    revoked = service.workspace.catalog.revoke_token(token_id, caller.name)
    service.recent.distrust_all()
    return TokenOut.of(revoked)


@router.get("/audit")
def list_audit(caller: Admin, catalog: CatalogDep, before: BeforeId = None, limit: Limit = 100) -> Page[AuditOut]:
    """Who did what, newest first."""
    require_all_scope(caller)
    found = catalog.latest_audit(before=before, limit=limit)
    next_before = str(found[-1].id) if len(found) == limit else None
    return Page(items=[AuditOut.model_validate(entry) for entry in found], next=next_before)
