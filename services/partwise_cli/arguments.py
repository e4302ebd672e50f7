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
HostOption = Annotated[str | None, typer.Option(help="Address to listen on.", show_default="127.0.0.1")]
PortOption = Annotated[int | None, typer.Option(help="Port to listen on.", show_default="8000")]
PublicUrlOption = Annotated[str | None, typer.Option(help="How browsers reach it, if not so.", show_default=False)]
LoginOption = Annotated[str | None, typer.Option(help="Who the printed address logs in.", show_default="who starts it")]
