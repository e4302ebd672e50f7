"""Commands that work on the labels of one mesh, from file to file: patches, refine, replay."""

from dataclasses import asdict
from enum import StrEnum
from pathlib import Path
from typing import Annotated

import typer

from partwise_cli.arguments import JsonOption
from partwise_cli.terminal import counted, print_json

app = typer.Typer(no_args_is_help=True, rich_markup_mode="rich")

MeshArgument = Annotated[Path, typer.Argument(help="OFF, OBJ, PLY, STL or GLB.", show_default=False)]
OutOption = Annotated[
    Path,
    typer.Option("--out", "-o", help="File to write: .seg, _labels.txt or .ply, with colours.", show_default=False),
]


class Method(StrEnum):
    """Ways of over-segmentation, as `partwise.segmentation.patch_parameters.PatchMethod` names them."""

    RANDOM_WALKS = "random_walks"
    K_MEANS = "k_means"


def register(parent: typer.Typer) -> None:
    """Adds the group of commands of this module."""
    summary = "Label one mesh.  [dim]partwise segment patches a.off -o a.seg[/dim]"
    parent.add_typer(app, name="segment", help=summary, rich_help_panel="Labels")


@app.command()
def patches(
    mesh: MeshArgument,
    out: OutOption,
    count: Annotated[int, typer.Option("--count", "-n", help="How many; at least one a component.")] = 40,
    method: Annotated[Method, typer.Option(help="Along creases, or compact.")] = Method.RANDOM_WALKS,
) -> None:
    """Cut into patches.  [dim]partwise segment patches a.off -n 20 -o a.ply[/dim]"""
    from partwise_cli.segmenting import cut_patches

    n_made = cut_patches(mesh, method.value, count, out)
    typer.echo(f"{n_made:,} {'patch' if n_made == 1 else 'patches'} in {out}, numbered from 1")


@app.command()
def refine(
    mesh: MeshArgument,
    labels: Annotated[
        Path, typer.Argument(help="A .seg, where 0 and −1 are unlabelled, or _labels.txt.", show_default=False)
    ],
    out: OutOption,
    preset: Annotated[str | None, typer.Option(help="default or paper.", show_default="default")] = None,
    omega: Annotated[
        float | None,
        typer.Option(help="Weight of angles against shape diameter, 0 to 1.", show_default="the preset's"),
    ] = None,
    config: Annotated[
        Path | None, typer.Option(help="A partwise.toml: its [boundary], in place of a preset.", show_default=False)
    ] = None,
    anchor: Annotated[
        Path | None, typer.Option(help="Labels to stay near; else those given.", show_default=False)
    ] = None,
) -> None:
    """Move boundaries onto creases.  [dim]partwise segment refine a.off a.seg -o b.seg[/dim]"""
    from partwise_cli.segmenting import RefineRequest, refine_labels

    report = refine_labels(mesh, labels, RefineRequest(preset, config, omega), out, anchor)
    typer.echo(
        f"{report.n_changed:,} of {counted(report.n_faces, 'face')} changed, {report.n_filled:,} unlabelled ones "
        f"filled, in {out}"
    )


@app.command()
def replay(
    mesh: MeshArgument,
    log: Annotated[Path, typer.Argument(help="A stroke log, JSON.", show_default=False)],
    out: OutOption,
    base: Annotated[
        Path | None, typer.Option(help="Labels that the log starts from; else all unlabelled.", show_default=False)
    ] = None,
    as_json: JsonOption = False,
) -> None:
    """Do strokes again.  [dim]partwise segment replay a.off log.json -o a.seg[/dim]"""
    from partwise_cli.segmenting import replay_log

    report = replay_log(mesh, log, out, base)
    if as_json:
        cost = {**asdict(report.cost), "clicks": report.cost.clicks, "undo_share": report.cost.undo_share}
        print_json({**asdict(report), "cost": cost})
        return
    typer.echo(
        f"{counted(report.n_events, 'event')} replayed: {report.n_labelled:,} of {counted(report.n_faces, 'face')} "
        f"labelled, in {out}"
    )
    typer.echo(
        f"cost: {counted(report.cost.strokes, 'stroke')}, {counted(report.cost.clicks, 'click')}, "
        f"{report.cost.active_s:.0f} s"
    )
    typer.echo(f"checksum: {report.sha256}")
