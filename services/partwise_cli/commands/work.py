"""Commands that keep a workspace going: work, up."""

from contextlib import suppress
from typing import TYPE_CHECKING, Annotated

import typer

from partwise.errors import ParameterError
from partwise_cli.arguments import (
    CollectionOption,
    HostOption,
    LoginOption,
    PortOption,
    PublicUrlOption,
    WorkspaceArgument,
)
from partwise_cli.signals import interrupt_on_sigterm

if TYPE_CHECKING:
    from partwise.store.records import Job, JobKind


def register(app: typer.Typer) -> None:
    """Adds the commands of this module."""
    for command in (up, work):
        app.command(rich_help_panel="People at work")(command)


def up(
    ws: WorkspaceArgument,
    host: HostOption = None,
    port: PortOption = None,
    public_url: PublicUrlOption = None,
    person: LoginOption = None,
) -> None:
    """Service and worker on this machine.  [dim]partwise up ws[/dim]"""
    from partwise_cli.supervisor import Command, CommandEndedError, Supervisor

    given = {"--host": host, "--port": port, "--public-url": public_url, "--person": person}
    options = [text for name, value in given.items() if value is not None for text in (name, str(value))]
    serve = ["serve", str(ws), *options]
    commands = [
        Command("service", serve, [*serve, "--no-login"]),
        Command("worker", ["work", str(ws)], ["work", str(ws)]),
    ]
    interrupt_on_sigterm()
    try:
        with suppress(KeyboardInterrupt):  # how it is meant to end
            Supervisor(commands, typer.echo).run()
    except CommandEndedError as ended:  # it has said why
        raise typer.Exit(ended.code) from ended


def work(
    ws: WorkspaceArgument,
    collection: CollectionOption = None,
    kinds: Annotated[
        str | None, typer.Option(help="Only jobs of these kinds, comma-separated.", show_default="all")
    ] = None,
    once: Annotated[bool, typer.Option("--once", help="End when no job waits.")] = False,
) -> None:
    """Do the jobs that wait, as they come.  [dim]partwise work ws[/dim]"""
    from partwise.workspace.workspace import open_workspace
    from partwise_cli.jobs.cluster import Cluster
    from partwise_cli.jobs.figures import Figures
    from partwise_cli.jobs.handlers import HANDLERS
    from partwise_cli.jobs.worker import Worker

    chosen = None if kinds is None else _kinds(kinds)
    interrupt_on_sigterm()
    with open_workspace(ws) as workspace:
        collection_id = None if collection is None else workspace.catalog.get_collection(collection).id
        cluster = Cluster(interrupt_on_sigterm)
        worker = Worker(workspace, HANDLERS, cluster, kinds=chosen, collection_id=collection_id, on_job=_tell)
        ends_well: tuple[type[BaseException], ...] = () if once else (KeyboardInterrupt,)  # how it is meant to end
        with suppress(*ends_well), Figures(workspace, cluster):
            typer.echo(f"worker {worker.owner} waits for jobs; Ctrl-C ends it", err=True)
            worker.run(once=once)


def _kinds(text: str) -> "list[JobKind]":
    from partwise.store.records import JobKind

    names = [name.strip() for name in text.split(",")]
    for name in names:
        if name not in list(JobKind):
            raise ParameterError(f"a kind of job must be one of {', '.join(JobKind)} but is {name!r}; correct --kinds")
    return [JobKind(name) for name in names]


def _tell(job: "Job") -> None:
    message = f": {job.full_message}" if job.full_message else ""
    typer.echo(f"job {job.id}, {job.kind} of collection {job.collection_id}: {job.state}{message}", err=True)
