"""Commands that make a workspace and fill it: init, ingest, preprocess, retry, status, gc, migrate."""

from dataclasses import asdict
from datetime import timedelta
from pathlib import Path
from typing import Annotated

import typer

from partwise.workspace.garbage import collect_garbage
from partwise.workspace.ingest import ingest_folder
from partwise.workspace.shapes import find_collection
from partwise.workspace.status import CollectionStatus, collection_status
from partwise.workspace.workspace import init_workspace, migrate_workspace, open_workspace
from partwise_cli.arguments import SOME_FAILED, CollectionOption, JsonOption, WorkspaceArgument
from partwise_cli.terminal import print_json, print_table, shape_progress, warning_lines

MAX_REASONS = 20


def register(app: typer.Typer) -> None:
    """Adds the commands of this module."""
    panel = "Collect shapes"
    for command in (init, ingest, preprocess, retry, status, gc, migrate):
        app.command(rich_help_panel=panel)(command)


def init(
    ws: WorkspaceArgument,
    collection: Annotated[str, typer.Option("--collection", "-c", help="Name of a new collection.")],
    parts: Annotated[str, typer.Option(help="Part names, comma-separated, in the order annotators see them.")],
    up: Annotated[str, typer.Option(help="Which axis points up in pictures: x, y or z.")] = "y",
) -> None:
    """Make a workspace, and a collection in it.  [dim]partwise init ws -c chairs --parts seat,back,leg,arm[/dim]"""
    if up not in ("x", "y", "z"):
        raise typer.BadParameter(f"must be x, y or z but is {up!r}", param_hint="--up")
    init_workspace(ws)
    names = [name.strip() for name in parts.split(",") if name.strip()]
    with open_workspace(ws) as workspace:
        workspace.catalog.create_collection(collection, names, {"up": up})
    typer.echo(f"{ws}: collection {collection!r} with parts {', '.join(names)}")


def ingest(
    ws: WorkspaceArgument,
    folder: Annotated[Path, typer.Argument(help="Folder of OFF, OBJ, PLY, STL or GLB files.", show_default=False)],
    collection: CollectionOption = None,
) -> None:
    """Copy mesh files into a collection; again, to add new ones.  [dim]partwise ingest ws meshes/[/dim]"""
    with open_workspace(ws) as workspace:
        report = ingest_folder(workspace, find_collection(workspace, collection), folder)
    warning_lines([file.reason for file in report.refused])
    typer.echo(
        f"{report.n_added} added, {report.n_unchanged} unchanged, {report.n_changed} changed, "
        f"{len(report.refused)} refused"
    )
    if report.refused:
        raise typer.Exit(SOME_FAILED)


def preprocess(ws: WorkspaceArgument, collection: CollectionOption = None) -> None:
    """Check and describe new shapes on all cores.  [dim]partwise preprocess ws[/dim]"""
    from partwise_workers.passes import preprocess as run

    with open_workspace(ws) as workspace:
        found = find_collection(workspace, collection)
        with shape_progress("preprocess") as on_progress:
            result = run(workspace, found, on_progress)
        state = collection_status(workspace, found, MAX_REASONS)
    _report_failures(state)
    typer.echo(f"{result.n_done} shapes preprocessed, {result.n_failed} failed" if result.n_total else "nothing to do")
    if result.n_failed:
        raise typer.Exit(SOME_FAILED)


def retry(
    ws: WorkspaceArgument,
    collection: CollectionOption = None,
    stage: Annotated[str | None, typer.Option(help="Only failures of this stage.", show_default=False)] = None,
) -> None:
    """Forget failures, so that the next preprocess tries again.  [dim]partwise retry ws --stage describe[/dim]"""
    with open_workspace(ws) as workspace:
        n_cleared = workspace.catalog.clear_failures(find_collection(workspace, collection).id, stage)
    typer.echo(f"{n_cleared} failures cleared; run `partwise preprocess` to try again")


def status(ws: WorkspaceArgument, collection: CollectionOption = None, as_json: JsonOption = False) -> None:
    """How far a collection is, and what failed and why.  [dim]partwise status ws[/dim]"""
    with open_workspace(ws) as workspace:
        state = collection_status(workspace, find_collection(workspace, collection), MAX_REASONS)
    if as_json:
        print_json(asdict(state))
        return
    print_table(f"Collection {state.collection}", ("state", "shapes"), [(s, f"{n:,}") for s, n in state.states], (1,))
    rows = [(stage.stage, f"{stage.n_done:,}", f"{stage.n_failed:,}") for stage in state.stages]
    print_table("Stages", ("stage", "done", "failed"), rows, (1, 2))
    typer.echo(f"model: {'none yet' if state.model_version is None else f'version {state.model_version}'}")
    _report_failures(state)


def gc(
    ws: WorkspaceArgument,
    older_than_h: Annotated[
        float, typer.Option(help="Leave blocks alone that no row names but are younger.", min=0)
    ] = 24,
) -> None:
    """Sweep arrays that nothing needs any more.  [dim]partwise gc ws[/dim]"""
    with open_workspace(ws) as workspace:
        report = collect_garbage(workspace, timedelta(hours=older_than_h))
    typer.echo(
        f"{report.n_unused_blocks} replaced blocks ({report.n_bytes / 1e6:.1f} MB) and "
        f"{report.n_orphan_blocks} blocks of crashed runs swept"
    )


def migrate(ws: WorkspaceArgument) -> None:
    """Bring the catalog to this version's schema.  [dim]partwise migrate ws[/dim]"""
    migrate_workspace(ws)
    typer.echo(f"{ws}: the catalog is up to date")


def _report_failures(state: CollectionStatus) -> None:
    warning_lines([f"{failure.source_key}: {failure.stage}: {failure.reason}" for failure in state.failures])
