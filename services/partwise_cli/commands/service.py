"""Commands around the service: serve, token create, list and revoke, reviews list and accept."""

import getpass
import os
import socket
from contextlib import suppress
from datetime import UTC, datetime, timedelta
from typing import TYPE_CHECKING, Annotated, Literal

import typer

from partwise.errors import ConfigError
from partwise.store.reviews import ReviewReason
from partwise_cli.arguments import (
    CollectionOption,
    HostOption,
    JsonOption,
    LoginOption,
    PortOption,
    PublicUrlOption,
    WorkspaceArgument,
)
from partwise_cli.terminal import counted, print_json, print_table

if TYPE_CHECKING:
    from partwise.store.catalog import Catalog
    from partwise.store.records import Person, Token
    from partwise_service.settings import ServiceSettings

RoleName = Literal["annotator", "reviewer", "operator", "admin"]
"""As `Role`, which the command line does not load to start."""
SERVE_TOKEN_TTL = timedelta(days=1)
PAGE = 1000
_UNITS = {"m": timedelta(minutes=1), "h": timedelta(hours=1), "d": timedelta(days=1)}

token_app = typer.Typer(no_args_is_help=True, rich_markup_mode="rich")
reviews_app = typer.Typer(no_args_is_help=True, rich_markup_mode="rich")
PersonOption = Annotated[str, typer.Option(help="Whose it is, added if new.", show_default=False)]


def register(parent: typer.Typer) -> None:
    """Adds the commands of this module."""
    panel = "People at work"
    parent.command(rich_help_panel=panel)(serve)
    tokens = "Who may come in.  [dim]partwise token list ws[/dim]"
    parent.add_typer(token_app, name="token", help=tokens, rich_help_panel=panel)
    reviews = "Labels that wait for a look.  [dim]partwise reviews list ws[/dim]"
    parent.add_typer(reviews_app, name="reviews", help=reviews, rich_help_panel=panel)


def serve(
    ws: WorkspaceArgument,
    host: HostOption = None,
    port: PortOption = None,
    public_url: PublicUrlOption = None,
    person: LoginOption = None,
    login: Annotated[bool, typer.Option(help="Print an address that logs in.")] = True,
    processes: Annotated[int | None, typer.Option(help="Processes that serve.", show_default="1")] = None,
) -> None:
    """Let people work in a browser.  [dim]partwise serve ws --port 8000[/dim]"""
    from partwise_cli.serving import serve_on
    from partwise_service.settings import ServiceSettings

    settings = ServiceSettings.of(
        os.environ, workspace=ws, host=host, port=port, public_url=public_url, processes=processes
    )
    with _listening(settings) as listener:
        if login:
            code = _login_code(settings, person or getpass.getuser())
            typer.echo(f"{settings.origin}/#code={code}")
            typer.echo(f"opens the page once, within {settings.login_code_s / 60:g} minutes; Ctrl-C ends the service")
        with suppress(KeyboardInterrupt):  # how it is meant to end
            serve_on(settings, listener)


def _listening(settings: "ServiceSettings") -> socket.socket:
    family = socket.AF_INET6 if ":" in settings.host else socket.AF_INET
    try:
        return socket.create_server((settings.host, settings.port), family=family)
    except OSError as error:
        raise ConfigError(
            f"the service must be able to listen on {settings.host}, port {settings.port}, but: "
            f"{error.strerror or error}; choose others with --host and --port"
        ) from error


def _login_code(settings: "ServiceSettings", name: str) -> str:
    """A one-time code for whoever started the service, who may do everything here anyway: the database is theirs."""
    from partwise.store.records import NewToken, Role
    from partwise.workspace.workspace import open_workspace

    with open_workspace(settings.workspace) as workspace:
        person = _known_or_new(workspace.catalog, name)
        new = NewToken(person.id, Role.ADMIN, datetime.now(UTC) + SERVE_TOKEN_TTL, note="partwise serve")
        issued = workspace.catalog.issue_token(new, name)
        return workspace.catalog.issue_login_code(issued.token.id, settings.login_code_s).code


@token_app.command()
def create(
    ws: WorkspaceArgument,
    person: PersonOption,
    role: Annotated[RoleName, typer.Option(help="What it allows.")] = "annotator",
    ttl: Annotated[str, typer.Option(help="How long it is good: 30d, 12h, 45m.")] = "30d",
    collection: Annotated[
        list[str] | None, typer.Option("--collection", "-c", help="Only for this one; again for more.")
    ] = None,
    note: Annotated[str, typer.Option(help="What it is for.")] = "",
    as_json: JsonOption = False,
) -> None:
    """Make a token, shown once.  [dim]partwise token create ws --person ann[/dim]"""
    from partwise.store.records import NewToken, Role
    from partwise.workspace.workspace import open_workspace

    expires_at = datetime.now(UTC) + _duration(ttl)
    with open_workspace(ws) as workspace:
        catalog = workspace.catalog
        scope = tuple(catalog.get_collection(name).id for name in collection) if collection else None
        new = NewToken(_known_or_new(catalog, person).id, Role(role), expires_at, scope, note)
        issued = catalog.issue_token(new, getpass.getuser())
    if as_json:
        print_json({"secret": issued.secret, **_as_json(issued.token)})
        return
    typer.echo(issued.secret)
    until = issued.token.expires_at.isoformat(timespec="minutes")
    typer.echo(f"token {issued.token.id} for {person}, {role}, until {until}; it is not shown again", err=True)


@token_app.command("list")
def list_tokens(ws: WorkspaceArgument, as_json: JsonOption = False) -> None:
    """Tokens, without secrets.  [dim]partwise token list ws[/dim]"""
    from partwise.workspace.workspace import open_workspace

    with open_workspace(ws) as workspace:
        tokens = _all_tokens(workspace.catalog)
    if as_json:
        print_json([_as_json(token) for token in tokens])
        return
    columns = ("id", "person", "role", "collections", "until", "last used", "note")
    print_table("Tokens", columns, [_as_row(token) for token in tokens], (0,))


@token_app.command()
def revoke(
    ws: WorkspaceArgument,
    token: Annotated[int, typer.Argument(help="The token's number.", show_default=False)],
) -> None:
    """End a token and its sessions.  [dim]partwise token revoke ws 3[/dim]"""
    from partwise.workspace.workspace import open_workspace

    with open_workspace(ws) as workspace:
        ended = workspace.catalog.revoke_token(token, getpass.getuser())
    typer.echo(f"token {ended.id} of {ended.person_name} has ended")


@reviews_app.command("list")
def list_reviews(ws: WorkspaceArgument, collection: CollectionOption = None, as_json: JsonOption = False) -> None:
    """What waits, and why.  [dim]partwise reviews list ws[/dim]"""
    from partwise.store.reviews import Review
    from partwise.workspace.shapes import find_collection
    from partwise.workspace.workspace import open_workspace

    found: list[Review] = []
    with open_workspace(ws) as workspace:
        collection_id = find_collection(workspace, collection).id
        while page := workspace.catalog.open_reviews(collection_id, after=found[-1].id if found else 0, limit=PAGE):
            found += page
        shapes = workspace.catalog.shapes_by_id([review.shape_id for review in found])
    rows = [
        (r.id, shapes[r.shape_id].source_key, r.reason.value, r.created_at.isoformat(timespec="minutes")) for r in found
    ]
    if as_json:
        print_json([dict(zip(("id", "shape", "reason", "since"), row, strict=True)) for row in rows])
    else:
        columns = ("id", "shape", "reason", "since")
        print_table("Labels to review", columns, [tuple(map(str, row)) for row in rows], (0,))


@reviews_app.command()
def accept(
    ws: WorkspaceArgument,
    person: PersonOption,
    review: Annotated[int | None, typer.Argument(help="The review's number.", show_default=False)] = None,
    is_all: Annotated[bool, typer.Option("--all", help="All that wait for --reason.")] = False,
    reason: Annotated[ReviewReason | None, typer.Option(help="Why they wait.", show_default=False)] = None,
    collection: CollectionOption = None,
) -> None:
    """Labels are right as they are.  [dim]partwise reviews accept ws --all --reason schema --person ann[/dim]"""
    from partwise.workspace.reviewing import accept_all
    from partwise.workspace.shapes import find_collection
    from partwise.workspace.workspace import open_workspace

    if (review is None) != is_all or (reason is None) == is_all:
        raise typer.BadParameter("name one review by its number, or many with --all --reason")
    with open_workspace(ws) as workspace:
        person_id = _known_or_new(workspace.catalog, person).id
        if review is not None:
            workspace.catalog.accept_review(review, person_id)
            typer.echo(f"review {review} accepted by {person}")
        elif reason is not None:
            n_accepted = accept_all(workspace.catalog, find_collection(workspace, collection).id, reason, person_id)
            typer.echo(f"{counted(n_accepted, 'review')} of reason {reason} accepted by {person}")


def _known_or_new(catalog: "Catalog", name: str) -> "Person":
    known = {person.name: person for person in catalog.list_people()}
    return known.get(name) or catalog.add_person(name)


def _all_tokens(catalog: "Catalog") -> "list[Token]":
    found: list[Token] = []
    while page := catalog.tokens(after=found[-1].id if found else 0, limit=PAGE):
        found += page
    return [token for token in found if not token.is_session]


def _duration(text: str) -> timedelta:
    """`30d`, `12h` or `45m` as a time."""
    number, unit = text[:-1], text[-1:]
    if not number.isdecimal() or unit not in _UNITS or not 0 < int(number) <= 100_000:
        raise typer.BadParameter(f"--ttl must look like 30d, 12h or 45m but is {text!r}")
    return int(number) * _UNITS[unit]


def _as_json(token: "Token") -> dict[str, object]:
    return {
        "id": token.id,
        "person": token.person_name,
        "role": token.role.value,
        "collections": None if token.scope is None else list(token.scope),
        "expires_at": token.expires_at.isoformat(),
        "revoked_at": None if token.revoked_at is None else token.revoked_at.isoformat(),
        "last_used_at": None if token.last_used_at is None else token.last_used_at.isoformat(),
        "note": token.note,
    }


def _as_row(token: "Token") -> tuple[str, ...]:
    until = "ended" if token.revoked_at else token.expires_at.isoformat(timespec="minutes")
    used = token.last_used_at.isoformat(timespec="minutes") if token.last_used_at else "never"
    scope = "all" if token.scope is None else ", ".join(map(str, token.scope))
    return str(token.id), token.person_name, token.role.value, scope, until, used, token.note
