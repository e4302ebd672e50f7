"""Commands about labels: import, confirm, export."""

from functools import partial
from pathlib import Path
from typing import Annotated

import typer

from partwise.store.records import MeshRole, RevisionKind
from partwise.workspace.choices import ExportFormat, PointSampling, Segmentation
from partwise_cli.arguments import CollectionOption, WorkspaceArgument
from partwise_cli.failures import SOME_FAILED
from partwise_cli.terminal import counted, moved_line, shape_progress, warning_lines

AuthorOption = Annotated[str, typer.Option(help="Whose work the labels are.")]


def register(app: typer.Typer) -> None:
    """Adds the commands of this module."""
    panel = "Labels"
    app.command("import", rich_help_panel=panel)(import_)
    for command in (confirm, export):
        app.command(rich_help_panel=panel)(command)


def import_(
    ws: WorkspaceArgument,
    folder: Annotated[
        Path,
        typer.Argument(
            help="Folder of <shape>_labels.txt or <shape>.seg: of the files' own faces, moved to the working meshes. "
            "Of the working meshes' faces where their number says so; of the files' where both are as many.",
            show_default=False,
        ),
    ],
    collection: CollectionOption = None,
    kind: Annotated[
        RevisionKind, typer.Option("--as", help="reference labels are ground truth: never trained on, never shown.")
    ] = RevisionKind.IMPORTED,
    author: AuthorOption = "import",
) -> None:
    """Read labels of shapes.  [dim]partwise import ws labels/[/dim]"""
    from partwise.workspace.labelling import import_labels
    from partwise.workspace.shapes import find_collection
    from partwise.workspace.workspace import open_workspace
    from partwise_workers.relabelling import move_labels

    with open_workspace(ws) as workspace, shape_progress("move labels") as on_progress:
        found = find_collection(workspace, collection)
        report = import_labels(workspace, found, folder, kind, author, partial(move_labels, on_progress=on_progress))
    warning_lines([refused.reason for refused in report.refused])
    typer.echo(
        f"labels of {counted(report.n_imported, 'shape')} put on record as {kind.value}, "
        f"{report.n_unchanged:,} unchanged, {counted(len(report.refused), 'file')} refused, "
        f"{counted(report.n_unlabelled, 'shape')} without a file"
    )
    moved_line(report.moves)
    if report.refused or report.moves.n_failed:
        raise typer.Exit(SOME_FAILED)


def confirm(
    ws: WorkspaceArgument,
    shape: Annotated[str, typer.Argument(help="The shape's file name as ingested, or its number.", show_default=False)],
    labels: Annotated[Path, typer.Argument(help="A _labels.txt or .seg file of its faces.", show_default=False)],
    collection: CollectionOption = None,
    author: AuthorOption = "command line",
) -> None:
    """Put labels on record.  [dim]partwise confirm ws mug.off mug.seg[/dim]"""
    from partwise.workspace.labelling import commit_labels, read_labels
    from partwise.workspace.shapes import find_collection, find_shape, shape_mesh
    from partwise.workspace.workspace import open_workspace

    with open_workspace(ws) as workspace:
        found = find_collection(workspace, collection)
        target = find_shape(workspace, found, shape)
        ids = read_labels(labels, shape_mesh(workspace, target).n_faces, workspace.catalog.parts(found.id))
        before = workspace.catalog.head_revision(target.id)
        revision = commit_labels(workspace, found, target, ids, RevisionKind.HUMAN, author)
    if before is not None and before.id == revision.id:
        typer.echo(f"{target.source_key}: these labels are on record already, as revision {revision.id}")
    else:
        typer.echo(f"{target.source_key}: revision {revision.id} by {author}")


def export(
    ws: WorkspaceArgument,
    out: Annotated[Path, typer.Argument(help="Folder for the files and manifest.json.", show_default=False)],
    segmentation: Annotated[Segmentation, typer.Option(help="Which labels.")] = Segmentation.CONFIRMED,
    file_format: Annotated[
        ExportFormat,
        typer.Option(
            "--format",
            help="seg: part ids as text. ply: coloured mesh. glb: a node for each part. npz: arrays. "
            "shapenetpart: points. coco: one JSON for all.",
        ),
    ] = ExportFormat.SEG,
    on: Annotated[MeshRole, typer.Option(help="original: on the faces of the files as they came.")] = MeshRole.WORKING,
    points: Annotated[int, typer.Option(help="Points a shape, for shapenetpart.", min=1)] = 2_500,
    seed: Annotated[int, typer.Option(help="What draws the points.", min=0)] = 0,
    collection: CollectionOption = None,
) -> None:
    """Write labels out.  [dim]partwise export ws out/ --format ply[/dim]"""
    from partwise.workspace.export import export_labels
    from partwise.workspace.shapes import find_collection
    from partwise.workspace.workspace import open_workspace

    sampling = PointSampling(points, seed)
    with open_workspace(ws) as workspace, shape_progress("export") as on_progress:
        found = find_collection(workspace, collection)
        report = export_labels(workspace, found, segmentation, file_format, out, on, on_progress, sampling)
    without = f"; {counted(report.n_without, 'shape')} without {segmentation.value} labels" if report.n_without else ""
    typer.echo(f"{segmentation.value} labels of {counted(report.n_written, 'shape')} written{without}")
    typer.echo(f"manifest: {report.manifest}")
    warning_lines(report.refused)
    if report.refused:
        raise typer.Exit(SOME_FAILED)
