"""Commands about labels: import, confirm, export."""

from pathlib import Path
from typing import Annotated

import typer

from partwise.store.records import RevisionKind
from partwise.workspace.export import ExportFormat, export_labels
from partwise.workspace.labelling import commit_labels, import_labels, read_labels
from partwise.workspace.segmentations import Segmentation
from partwise.workspace.shapes import find_collection, find_shape, shape_mesh
from partwise.workspace.workspace import open_workspace
from partwise_cli.arguments import SOME_FAILED, CollectionOption, WorkspaceArgument
from partwise_cli.terminal import warning_lines

AuthorOption = Annotated[str, typer.Option(help="Whose work the labels are.")]


def register(app: typer.Typer) -> None:
    """Adds the commands of this module."""
    panel = "Labels"
    app.command("import", rich_help_panel=panel)(import_)
    for command in (confirm, export):
        app.command(rich_help_panel=panel)(command)


def import_(
    ws: WorkspaceArgument,
    folder: Annotated[Path, typer.Argument(help="Folder of <shape>_labels.txt or <shape>.seg.", show_default=False)],
    collection: CollectionOption = None,
    kind: Annotated[
        RevisionKind, typer.Option("--as", help="reference labels are ground truth: never trained on, never shown.")
    ] = RevisionKind.IMPORTED,
    author: AuthorOption = "import",
) -> None:
    """Read labels for preprocessed shapes.  [dim]partwise import ws labels/ --as reference[/dim]"""
    with open_workspace(ws) as workspace:
        report = import_labels(workspace, find_collection(workspace, collection), folder, kind, author)
    warning_lines([refused.reason for refused in report.refused])
    typer.echo(
        f"labels of {report.n_imported} shapes imported as {kind.value}, {len(report.refused)} refused, "
        f"{report.n_unlabelled} shapes have none"
    )
    if report.refused:
        raise typer.Exit(SOME_FAILED)


def confirm(
    ws: WorkspaceArgument,
    shape: Annotated[str, typer.Argument(help="The shape's file name as ingested, or its number.", show_default=False)],
    labels: Annotated[Path, typer.Argument(help="A _labels.txt or .seg file of its faces.", show_default=False)],
    collection: CollectionOption = None,
    author: AuthorOption = "command line",
) -> None:
    """Put a person's labels of one shape on record.  [dim]partwise confirm ws chair-0007.off chair-0007.seg[/dim]"""
    with open_workspace(ws) as workspace:
        found = find_collection(workspace, collection)
        target = find_shape(workspace, found, shape)
        ids = read_labels(labels, shape_mesh(workspace, target).n_faces, workspace.catalog.parts(found.id))
        revision = commit_labels(workspace, found, target, ids, RevisionKind.HUMAN, author)
    typer.echo(f"{target.source_key}: revision {revision.id} by {author}")


def export(
    ws: WorkspaceArgument,
    out: Annotated[Path, typer.Argument(help="Folder for the files and manifest.json.", show_default=False)],
    segmentation: Annotated[Segmentation, typer.Option(help="Which labels.")] = Segmentation.CONFIRMED,
    file_format: Annotated[
        ExportFormat, typer.Option("--format", help="seg: part ids as text. ply: coloured mesh.")
    ] = (ExportFormat.SEG),
    collection: CollectionOption = None,
) -> None:
    """Write labels out, with a manifest.  [dim]partwise export ws out/ --segmentation refined --format ply[/dim]"""
    with open_workspace(ws) as workspace:
        found = find_collection(workspace, collection)
        report = export_labels(workspace, found, segmentation, file_format, out)
    typer.echo(f"{report.n_written} shapes written, {report.n_without} have no {segmentation.value} labels")
    typer.echo(f"manifest: {report.manifest}")
