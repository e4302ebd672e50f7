"""`partwise demo`: the whole way of a collection, from nothing to ranked, refined, exported labels."""

from pathlib import Path
from typing import Annotated

import typer

from partwise_cli.arguments import JsonOption
from partwise_cli.terminal import print_json


def register(app: typer.Typer) -> None:
    """Adds the command of this module."""
    app.command(rich_help_panel="Try it out")(demo)


def demo(
    out: Annotated[Path, typer.Argument(help="An empty or new folder.", show_default=False)],
    count: Annotated[int, typer.Option(help="Simulated shapes.", min=12)] = 40,
    confirmed: Annotated[int, typer.Option(help="Shapes that the simulated annotator confirms.", min=2)] = 6,
    category: Annotated[str, typer.Option(help="chairs, tables, lamps, planes or mugs.")] = "chairs",
    seed: Annotated[int, typer.Option(help="Of everything random.", min=0)] = 1,
    iterations: Annotated[int, typer.Option(help="Training steps; the paper's number by default.", min=5)] = 5000,
    as_json: JsonOption = False,
) -> None:
    """Everything, once, on simulated shapes.  [dim]partwise demo demo/[/dim]"""
    from partwise_cli.demo import DemoRequest, run_demo
    from partwise_cli.demo_report import print_report, report_as_json

    report = run_demo(out, DemoRequest(category, count, confirmed, seed, iterations))
    if as_json:
        print_json(report_as_json(report))
    else:
        print_report(report)
