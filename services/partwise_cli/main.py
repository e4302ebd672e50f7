"""Entry point: the command tree, logging, and errors as one line with an exit code that means something."""

import logging
import sys
from typing import Annotated

import typer

from partwise import __version__
from partwise.errors import PartwiseError, StoreError
from partwise_cli.commands import bench, collect, demo, doctor, label, model, rank, simulate
from partwise_cli.terminal import error_line

INPUT_ERROR = 3
STORE_ERROR = 4
INTERRUPTED = 130

EPILOG = (
    "Exit codes: 0 done · 1 done, but some shapes or files failed · 2 wrong usage · 3 wrong input or configuration · "
    "4 a store cannot be reached or written · 130 interrupted"
)

app = typer.Typer(
    name="partwise",
    help="From a messy collection of 3D shapes to a verified part label on every face, with little human time.",
    epilog=EPILOG,
    no_args_is_help=True,
    add_completion=False,
    pretty_exceptions_enable=False,
    rich_markup_mode="rich",
)
for module in (collect, label, model, rank, simulate, demo, doctor):
    module.register(app)
app.add_typer(bench.app, name="bench")


@app.callback()
def _options(
    verbose: Annotated[bool, typer.Option("--verbose", "-v", help="Log what is done, in detail.")] = False,
) -> None:
    logging.basicConfig(
        level=logging.INFO if verbose else logging.WARNING, format="%(levelname)s %(name)s: %(message)s"
    )


@app.command()
def version() -> None:
    """Which version this is.  [dim]partwise version[/dim]"""
    typer.echo(__version__)


def main() -> None:
    """Runs the command; an error that Partwise foresees is one line on stderr and a non-zero exit code."""
    try:
        app(standalone_mode=True)
    except StoreError as error:
        error_line(str(error))
        sys.exit(STORE_ERROR)
    except PartwiseError as error:
        error_line(str(error))
        sys.exit(INPUT_ERROR)
    except KeyboardInterrupt:
        error_line("interrupted; what was finished is kept: run the same command again to go on")
        sys.exit(INTERRUPTED)
