"""Entry point: the command tree, logging, and errors as one line with an exit code that means something."""

import sys
import traceback
from typing import Annotated

import typer

from partwise import __version__
from partwise_cli.commands import bench, collect, demo, doctor, label, model, rank, segment, service, simulate, work
from partwise_cli.failures import EXIT_CODES, INTERRUPTED, ending_of
from partwise_cli.logs import configure_logging
from partwise_cli.terminal import error_line

app = typer.Typer(
    name="partwise",
    help="From a messy collection of 3D shapes to a verified part label on every face, with little human time.",
    epilog=EXIT_CODES,
    no_args_is_help=True,
    add_completion=False,
    pretty_exceptions_enable=False,
    rich_markup_mode="rich",
)
for module in (collect, label, segment, model, rank, service, work, simulate, demo, bench, doctor):
    module.register(app)


@app.callback()
def _options(
    verbose: Annotated[bool, typer.Option("--verbose", "-v", help="Log what is done, in detail.")] = False,
) -> None:
    configure_logging(verbose)


@app.command(rich_help_panel="Try it out")
def version() -> None:
    """Which version this is.  [dim]partwise version[/dim]"""
    typer.echo(__version__)


def main() -> None:
    """Runs the command; an error that can be foreseen is one line on stderr and a non-zero exit code."""
    try:
        app(standalone_mode=True)
    except SystemExit as stop:  # how every command ends; typer makes this of Ctrl-C, too
        if stop.code == INTERRUPTED:
            error_line("interrupted; what was finished is kept: run the same command again to go on")
        raise
    except Exception as error:  # noqa: BLE001 - the command's edge
        ending = ending_of(error)
        if ending.is_fault:
            traceback.print_exception(error)
        error_line(ending.message)
        sys.exit(ending.code)
