"""What handlers ask for: the open workspace, who calls, in which role, and what of a path they may know of.

A handler names the least role that may call it (`Annotator` < `Reviewer` < `Operator` < `Admin`). Collections and
shapes outside the caller's scope do not exist for them: 404, the same as for ids that were never given.
"""

from collections.abc import Awaitable, Callable, Sequence
from typing import Annotated

from fastapi import Depends, Request, Security
from fastapi.concurrency import run_in_threadpool
from fastapi.security import APIKeyCookie, HTTPAuthorizationCredentials, HTTPBearer

from partwise.errors import NotFoundError
from partwise.store.catalog import Catalog
from partwise.store.records import Collection, Role, Shape
from partwise.workspace.workspace import Workspace
from partwise_service.problems import ProblemError, ProblemKind
from partwise_service.schemas.base import RowId
from partwise_service.security.authentication import SESSION_COOKIE, Credential, authenticate, recognise
from partwise_service.security.identity import Identity
from partwise_service.service import Service

_bearer = HTTPBearer(auto_error=False, description="A token that `partwise token create` has shown.")
_cookie = APIKeyCookie(name=SESSION_COOKIE, auto_error=False, description="The session that /login has begun.")


# What waits for nothing is `async`: it needs no thread, and a thread costs more than all that these do. None asks for
# another where it can do without: each costs as much as all that it does, every time that it is asked for.


async def service(request: Request) -> Service:
    """What is open while the application runs."""
    return _open(request)


async def workspace(request: Request) -> Workspace:
    """The workspace that is served."""
    return _open(request).workspace


async def catalog(request: Request) -> Catalog:
    """The workspace's catalog."""
    return _open(request).workspace.catalog


def _open(request: Request) -> Service:
    found: Service = request.app.state.service
    return found


ServiceDep = Annotated[Service, Depends(service)]
WorkspaceDep = Annotated[Workspace, Depends(workspace)]
CatalogDep = Annotated[Catalog, Depends(catalog)]
Bearer = Annotated[HTTPAuthorizationCredentials | None, Security(_bearer)]
Cookie = Annotated[str | None, Security(_cookie)]


async def current_identity(request: Request, bearer: Bearer, cookie: Cookie) -> Identity:
    """Who calls, by token or by session. Problems: 401, 403 for a session from a foreign page, 429."""
    open_service, address = _open(request), client_address(request)
    if bearer is not None:
        return await _identity(open_service, Credential(bearer.credentials, is_session=False), address)
    if cookie is None:
        raise ProblemError(
            ProblemKind.UNAUTHENTICATED,
            "Send `Authorization: Bearer <token>`, or log in.",
            headers={"WWW-Authenticate": "Bearer"},
        )
    refuse_foreign_origin(request, open_service)
    return await _identity(open_service, Credential(cookie, is_session=True), address)


async def _identity(open_service: Service, credential: Credential, address: str) -> Identity:
    known = recognise(open_service, credential)
    return await run_in_threadpool(authenticate, open_service, credential, address) if known is None else known


Caller = Annotated[Identity, Depends(current_identity)]
_UNSAFE = frozenset({"POST", "PUT", "PATCH", "DELETE"})


def refuse_foreign_origin(request: Request, open_service: Service) -> None:
    """A session may change something only from the service's own pages and those of named origins."""
    if request.method in _UNSAFE and request.headers.get("origin") not in open_service.settings.page_origins:
        raise ProblemError(
            ProblemKind.FOREIGN_ORIGIN,
            "With a session, the Origin header must be that of the service's own page; scripts use a token.",
        )


def refuse_foreign_page(request: Request, open_service: Service) -> None:
    """Logging in needs no session, so that scripts may do it, which send no Origin; pages of other origins may not."""
    if "origin" in request.headers:
        refuse_foreign_origin(request, open_service)


def client_address(request: Request) -> str:
    """The caller's address, as the server sees it or a trusted proxy says it."""
    return request.client.host if request.client is not None else "unknown"


def require(role: Role) -> Callable[[Request, Bearer, Cookie], Awaitable[Identity]]:
    """A dependency that lets callers of at least this role pass."""

    async def at_least(request: Request, bearer: Bearer, cookie: Cookie) -> Identity:
        caller = await current_identity(request, bearer, cookie)
        require_role(caller, role)
        return caller

    return at_least


Annotator = Annotated[Identity, Depends(require(Role.ANNOTATOR))]
Reviewer = Annotated[Identity, Depends(require(Role.REVIEWER))]
Operator = Annotated[Identity, Depends(require(Role.OPERATOR))]
Admin = Annotated[Identity, Depends(require(Role.ADMIN))]


def require_role(caller: Identity, role: Role) -> None:
    """403 unless the caller has at least this role."""
    if not caller.role.includes(role):
        raise ProblemError(ProblemKind.FORBIDDEN, f"This takes the role {role.value} but yours is {caller.role.value}.")


def require_all_scope(caller: Identity) -> None:
    """For what concerns no single collection: people, tokens, the audit trail."""
    if not caller.sees_all:
        raise ProblemError(ProblemKind.FORBIDDEN, "This takes a token for all collections but yours is for some.")


def visible_collection(served: Catalog, caller: Identity, collection_id: int) -> Collection:
    """The collection of this id if the caller may know of it.

    Raises
    ------
    NotFoundError : it is not there, or not for them.
    """
    if caller.may_see(collection_id):
        for found in served.list_collections():
            if found.id == collection_id:
                return found
    raise NotFoundError(f"there is no collection {collection_id}; see /collections for those you work on")


def visible_shape(served: Catalog, caller: Identity, shape_id: int) -> Shape:
    """The shape of this id if the caller may know of it.

    Raises
    ------
    NotFoundError : it is not there, or not for them.
    """
    found = served.shapes_by_id([shape_id]).get(shape_id)
    if found is None or not caller.may_see(found.collection_id):
        raise NotFoundError(f"there is no shape {shape_id}; see /collections/…/shapes for those you work on")
    return found


def shapes_of(served: Catalog, collection: Collection, shape_ids: Sequence[int]) -> list[Shape]:
    """The shapes of these ids, each once, all of the collection.

    Raises
    ------
    NotFoundError : one is not there.
    """
    found = served.shapes_by_id(shape_ids)
    for shape_id in shape_ids:
        if shape_id not in found or found[shape_id].collection_id != collection.id:
            raise NotFoundError(f"there is no shape {shape_id} in collection {collection.id}")
    return [found[shape_id] for shape_id in dict.fromkeys(shape_ids)]


def scoped_collection(collection_id: RowId, caller: Caller, served: CatalogDep) -> Collection:
    """The collection in the path."""
    return visible_collection(served, caller, collection_id)


def scoped_shape(shape_id: RowId, caller: Caller, served: CatalogDep) -> Shape:
    """The shape in the path."""
    return visible_shape(served, caller, shape_id)


ScopedCollection = Annotated[Collection, Depends(scoped_collection)]
ScopedShape = Annotated[Shape, Depends(scoped_shape)]
