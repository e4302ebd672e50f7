"""Arguments and options that several commands share."""

from pathlib import Path
from typing import Annotated

import typer

WorkspaceArgument = Annotated[Path, typer.Argument(metavar="WS", help="The workspace folder.", show_default=False)]
CollectionOption = Annotated[
    str | None,
    typer.Option("--collection", "-c", help="Which collection; needed where there are several.", show_default=False),
]
JsonOption = Annotated[bool, typer.Option("--json", help="Print JSON, for scripts.")]
