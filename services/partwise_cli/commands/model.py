"""Commands that train models and let them work: train, evaluate, refine."""

import typer

from partwise_cli.arguments import CollectionOption, WorkspaceArgument
from partwise_cli.failures import SOME_FAILED
from partwise_cli.run_view import run_progress
from partwise_cli.terminal import counted, progress


def register(app: typer.Typer) -> None:
    """Adds the commands of this module."""
    for command in (train, evaluate, refine):
        app.command(rich_help_panel="Models")(command)


def train(ws: WorkspaceArgument, collection: CollectionOption = None) -> None:
    """Train a model on all labelled shapes.  [dim]partwise train ws[/dim]"""
    from partwise.workspace.shapes import find_collection
    from partwise.workspace.workspace import open_workspace
    from partwise_workers.training import train_collection

    with open_workspace(ws) as workspace, progress("train") as on_progress:
        model = train_collection(workspace, find_collection(workspace, collection), on_progress)
    shapes = counted(model.n_shapes, "shape")
    typer.echo(f"model version {model.version}, trained on {shapes} in {model.recipe['train_s']:.0f} s")


def evaluate(ws: WorkspaceArgument, collection: CollectionOption = None) -> None:
    """Predict and score every described shape.  [dim]partwise evaluate ws[/dim]"""
    from partwise.workspace.ranking import bring_into_order
    from partwise.workspace.shapes import find_collection
    from partwise.workspace.workspace import open_workspace
    from partwise_workers.passes import evaluate as run

    with open_workspace(ws) as workspace:
        found = find_collection(workspace, collection)
        with run_progress("evaluate") as tally:
            result = run(workspace, found, tally.on_progress, tally.on_event)
        bring_into_order(workspace, found)
    _finish("evaluated", result.n_done, result.n_failed)


def refine(ws: WorkspaceArgument, collection: CollectionOption = None) -> None:
    """Cut predictions along creases.  [dim]partwise refine ws[/dim]"""
    from partwise.workspace.shapes import find_collection
    from partwise.workspace.workspace import open_workspace
    from partwise_workers.passes import refine as run

    with open_workspace(ws) as workspace, run_progress("refine") as tally:
        result = run(workspace, find_collection(workspace, collection), tally.on_progress, tally.on_event)
    _finish("refined", result.n_done, result.n_failed)


def _finish(what: str, n_done: int, n_failed: int) -> None:
    if n_done + n_failed:
        typer.echo(f"{counted(n_done, 'shape')} {what}, {n_failed:,} failed")
    else:
        typer.echo("nothing to do: every shape that is ready for it has been " + what)
    if n_failed:
        typer.echo("`partwise status` says why")
        raise typer.Exit(SOME_FAILED)
