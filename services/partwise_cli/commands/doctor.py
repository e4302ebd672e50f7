"""`partwise doctor`: what this machine has and lacks, and how to get it."""

import os
import shutil
from dataclasses import asdict, dataclass
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path
from typing import Annotated

import typer

from partwise.errors import PartwiseError
from partwise_cli.arguments import JsonOption
from partwise_cli.failures import SOME_FAILED
from partwise_cli.terminal import counted, print_json, print_table

PACKAGES = ("numpy", "torch", "ray", "numba", "embreex", "opencv-contrib-python-headless", "pyrender", "PyMaxflow")
WORKERS = "pip install 'partwise[workers]'"
MIN_FREE_GB = 5


@dataclass(frozen=True, slots=True)
class Finding:
    """One thing looked at. `remedy` is empty where nothing needs to be done."""

    what: str
    is_fine: bool
    found: str
    remedy: str = ""


def register(app: typer.Typer) -> None:
    """Adds the command of this module."""
    app.command(rich_help_panel="Try it out")(doctor)


def doctor(
    ws: Annotated[
        Path | None, typer.Argument(metavar="[WS]", help="Also look at this workspace.", show_default=False)
    ] = None,
    as_json: JsonOption = False,
) -> None:
    """What is missing on this machine, and a remedy.  [dim]partwise doctor[/dim]"""
    findings = [*_packages(), _renderer(), _graphics_card(), _disk(ws or Path.cwd()), _ray()]
    if ws is not None:
        findings.append(_stores(ws))
    if as_json:
        print_json([asdict(finding) for finding in findings])
    else:
        rows = [(("ok" if f.is_fine else "wrong"), f.what, f.found, f.remedy) for f in findings]
        print_table("This machine", ("", "what", "found", "remedy"), rows)
    if not all(finding.is_fine for finding in findings):
        raise typer.Exit(SOME_FAILED)


def _packages() -> list[Finding]:
    findings = []
    for package in PACKAGES:
        try:
            findings.append(Finding(package, True, version(package)))
        except PackageNotFoundError:
            findings.append(Finding(package, False, "not installed", WORKERS))
    return findings


def _renderer() -> Finding:
    try:
        from partwise.render.probe import open_depth_renderer

        renderer = open_depth_renderer("auto")
    except (PartwiseError, ImportError) as error:
        return Finding("depth views", False, str(error), WORKERS)
    name = renderer.name
    renderer.close()
    if name == "gl":
        return Finding("depth views", True, "OpenGL through EGL")
    return Finding("depth views", True, "ray casting", "for OpenGL, as fast: install libegl1 and a graphics driver")


def _graphics_card() -> Finding:
    try:
        import torch
    except ImportError as error:
        return Finding("training on", False, str(error), WORKERS)
    found = (
        f"CUDA: {torch.cuda.get_device_name()}"
        if torch.cuda.is_available()
        else f"CPU, {counted(os.cpu_count() or 1, 'core')}"
    )
    return Finding("training on", True, found)


def _disk(folder: Path) -> Finding:
    existing = next(path for path in (folder, *folder.resolve().parents) if path.exists())
    free_gb = shutil.disk_usage(existing).free / 1e9
    remedy = "" if free_gb >= MIN_FREE_GB else f"free at least {MIN_FREE_GB} GB, or point array_url elsewhere"
    return Finding("free disk", free_gb >= MIN_FREE_GB, f"{free_gb:.0f} GB at {existing}", remedy)


def _ray() -> Finding:
    try:
        from partwise_workers.cluster import connected, n_cores

        with connected():
            where = os.environ.get("RAY_ADDRESS") or "local"
            return Finding("Ray", True, f"{where}, {counted(n_cores(), 'core')}")
    except ImportError as error:
        return Finding("Ray", False, str(error), WORKERS)
    except PartwiseError as error:
        return Finding("Ray", False, str(error), "start the cluster, or unset RAY_ADDRESS")


def _stores(ws: Path) -> Finding:
    from partwise.workspace.workspace import open_workspace

    try:
        with open_workspace(ws) as workspace:
            n_collections = len(workspace.catalog.list_collections())
            workspace.arrays.put_bytes("doctor/probe", b"partwise")
            workspace.arrays.delete("doctor/probe")
        return Finding("stores", True, f"{counted(n_collections, 'collection')}, arrays can be written")
    except PartwiseError as error:
        return Finding("stores", False, str(error), "see [stores] in partwise.toml")
