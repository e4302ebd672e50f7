"""The command that makes collections with ground truth out of nothing."""

from pathlib import Path
from typing import Annotated

import typer

from partwise_cli.terminal import counted, progress


def register(app: typer.Typer) -> None:
    """Adds the command of this module."""
    app.command(rich_help_panel="Try it out")(simulate)


def simulate(
    category: Annotated[str, typer.Argument(help="chairs, tables, lamps, planes or mugs.", show_default=False)],
    out: Annotated[Path, typer.Argument(help="Folder for <shape>.off and <shape>_labels.txt.", show_default=False)],
    count: Annotated[int, typer.Option(help="How many shapes.", min=1)] = 40,
    seed: Annotated[int, typer.Option(help="The same seed makes the same shapes.", min=0)] = 1,
    dirty: Annotated[bool, typer.Option("--dirty", help="Open, non-manifold soups of many components.")] = False,
    faces: Annotated[int | None, typer.Option(help="Faces of each; else 2k to 20k.", show_default=False)] = None,
) -> None:
    """Make labelled shapes.  [dim]partwise simulate chairs shapes/[/dim]"""
    from partwise_cli.simulated import SimulationRequest, write_collection

    request = SimulationRequest(category, count, seed, dirty, faces)
    with progress("simulate") as on_progress:
        write_collection(request, out, on_progress)
    typer.echo(f"{counted(count, category.removesuffix('s'))} in {out}, with parts {','.join(request.part_names)}")
