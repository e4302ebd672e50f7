"""Commands that train models and let them work: train, evaluate, refine."""

import typer

from partwise.workspace.shapes import find_collection
from partwise.workspace.workspace import open_workspace
from partwise_cli.arguments import SOME_FAILED, CollectionOption, WorkspaceArgument
from partwise_cli.terminal import progress, shape_progress


def register(app: typer.Typer) -> None:
    """Adds the commands of this module."""
    for command in (train, evaluate, refine):
        app.command(rich_help_panel="Models")(command)


def train(ws: WorkspaceArgument, collection: CollectionOption = None) -> None:
    """Train a model on all labelled shapes.  [dim]partwise train ws[/dim]"""
    from partwise_workers.training import train_collection

    with open_workspace(ws) as workspace, progress("train") as on_progress:
        model = train_collection(workspace, find_collection(workspace, collection), on_progress)
    typer.echo(f"model version {model.version}, trained on {model.n_shapes} shapes in {model.recipe['train_s']:.0f} s")


def evaluate(ws: WorkspaceArgument, collection: CollectionOption = None) -> None:
    """Predict and score every described shape.  [dim]partwise evaluate ws[/dim]"""
    from partwise_workers.passes import evaluate as run

    with open_workspace(ws) as workspace, shape_progress("evaluate") as on_progress:
        result = run(workspace, find_collection(workspace, collection), on_progress)
    _finish("evaluated", result.n_done, result.n_failed)


def refine(ws: WorkspaceArgument, collection: CollectionOption = None) -> None:
    """Cut predictions along creases by graph cut.  [dim]partwise refine ws[/dim]"""
    from partwise_workers.passes import refine as run

    with open_workspace(ws) as workspace, shape_progress("refine") as on_progress:
        result = run(workspace, find_collection(workspace, collection), on_progress)
    _finish("refined", result.n_done, result.n_failed)


def _finish(what: str, n_done: int, n_failed: int) -> None:
    typer.echo(f"{n_done} shapes {what}, {n_failed} failed" if n_done + n_failed else "nothing to do")
    if n_failed:
        raise typer.Exit(SOME_FAILED)
