"""Commands that make a workspace and fill it: init, settings, ingest, preprocess, retry, status, gc, migrate."""

from dataclasses import asdict
from datetime import timedelta
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Literal

import typer

from partwise_cli.arguments import CollectionOption, JsonOption, WorkspaceArgument
from partwise_cli.failures import SOME_FAILED
from partwise_cli.run_view import run_progress
from partwise_cli.terminal import counted, moved_line, print_json, print_table, shape_progress, warning_lines

if TYPE_CHECKING:
    from partwise.workspace.relabel import MoveReport
    from partwise.workspace.status import CollectionStatus

MAX_REASONS = 20
FailureReason = Literal["error", "deadline", "memory", "crash"]
"""As `FailureKind`, which the command line does not load to start."""
StageName = Literal["mesh", "remesh", "describe", "picture", "evaluate", "refine"]
"""As `STAGE_ORDER`, for the same reason."""
Axis = Literal["x", "y", "z"]
RemeshPolicy = Literal["auto", "never"]
UP = "Which axis points up in pictures."
FACES = "Faces of the meshes to label, where shapes are remeshed."
REMESH = "auto: remesh what is not clean; never: take every mesh as it is."
LABELS = "People who label each shape, independently of each other: 1 to 9."
AGREEMENT = "Share of the area on which their labels must agree to be taken."
HONEYPOTS = "Share of claims that get a shape whose true labels are known."
REVIEW = "Have a reviewer look at what is confirmed."
TRAIN_AFTER = "Confirmed shapes after which a training is asked for; 0: never by itself."
SETTING_NAMES = {"working_faces": "faces"}
"""Of those that are not called what their column is."""


def register(app: typer.Typer) -> None:
    """Adds the commands of this module."""
    panel = "Collect shapes"
    for command in (init, settings, ingest, preprocess, retry, status, gc, migrate):
        app.command(rich_help_panel=panel)(command)


def init(
    ws: WorkspaceArgument,
    collection: Annotated[str, typer.Option("--collection", "-c", help="Name of a new collection.")],
    parts: Annotated[str, typer.Option(help="Part names, comma-separated, in the order annotators see them.")],
    up: Annotated[Axis, typer.Option(help=UP)] = "y",
    faces: Annotated[int, typer.Option(help=FACES)] = 10_000,
    remesh: Annotated[RemeshPolicy, typer.Option(help=REMESH)] = "auto",
) -> None:
    """Make a workspace.  [dim]partwise init ws -c mugs --parts body,handle[/dim]"""
    from partwise.workspace.settings import CollectionSettings
    from partwise.workspace.workspace import init_collection

    names = [name.strip() for name in parts.split(",") if name.strip()]
    given = {"up": up, "working_faces": faces, "remesh": remesh}
    CollectionSettings(up=up, working_faces=faces, remesh=remesh)  # raises for what does not fit
    init_collection(ws, collection, names, given)
    typer.echo(f"{ws}: collection {collection!r} with {counted(len(names), 'part')}: {', '.join(names)}")


def settings(
    ws: WorkspaceArgument,
    collection: CollectionOption = None,
    up: Annotated[Axis | None, typer.Option(help=UP, show_default=False)] = None,
    faces: Annotated[int | None, typer.Option(help=FACES, show_default=False)] = None,
    remesh: Annotated[RemeshPolicy | None, typer.Option(help=REMESH, show_default=False)] = None,
    labels_per_shape: Annotated[int | None, typer.Option(help=LABELS, show_default=False)] = None,
    agreement: Annotated[float | None, typer.Option(help=AGREEMENT, show_default=False)] = None,
    honeypot_share: Annotated[float | None, typer.Option(help=HONEYPOTS, show_default=False)] = None,
    review: Annotated[bool | None, typer.Option(help=REVIEW, show_default=False)] = None,
    train_after: Annotated[int | None, typer.Option(help=TRAIN_AFTER, show_default=False)] = None,
    as_json: JsonOption = False,
) -> None:
    """Show or change settings.  [dim]partwise settings ws --faces 20000[/dim]"""
    from partwise.workspace.settings import change_settings, settings_of
    from partwise.workspace.shapes import find_collection
    from partwise.workspace.workspace import open_workspace

    given = {
        "up": up,
        "working_faces": faces,
        "remesh": remesh,
        "labels_per_shape": labels_per_shape,
        "agreement": agreement,
        "honeypot_share": honeypot_share,
        "review": review,
        "train_after": train_after,
    }
    changes = {name: value for name, value in given.items() if value is not None}
    with open_workspace(ws) as workspace:
        found = find_collection(workspace, collection)
        before = settings_of(found)
        after = settings_of(change_settings(workspace, found, changes)) if changes else before
    if as_json:
        print_json(asdict(after))
        return
    rows = [
        (SETTING_NAMES.get(name, name.replace("_", " ")), str(value), str(getattr(before, name)))
        for name, value in asdict(after).items()
    ]
    columns = ("setting", "value", "before") if changes else ("setting", "value")
    print_table(f"Settings of {found.name}", columns, [row[: len(columns)] for row in rows])
    if (before.working_faces, before.remesh) != (after.working_faces, after.remesh):
        typer.echo("Shapes get their new meshes, and labels move along, with the next `partwise preprocess`.")


def ingest(
    ws: WorkspaceArgument,
    source: Annotated[
        Path,
        typer.Argument(
            help="OFF, OBJ, PLY, STL or GLB; a folder, zip or tar.gz of such; folders of PartNet.", show_default=False
        ),
    ],
    collection: CollectionOption = None,
) -> None:
    """Copy mesh files into a collection.  [dim]partwise ingest ws meshes/[/dim]"""
    from partwise.workspace.ingest import ingest_folder
    from partwise.workspace.ingest_files import ingest_file
    from partwise.workspace.shapes import find_collection
    from partwise.workspace.workspace import open_workspace

    with open_workspace(ws) as workspace, shape_progress("ingest") as on_progress:
        take = ingest_file if source.is_file() else ingest_folder
        report = take(workspace, find_collection(workspace, collection), source, on_progress)
    warning_lines([file.reason for file in report.refused])
    typer.echo(
        f"{counted(report.n_added, 'shape')} added, {report.n_unchanged:,} unchanged, {report.n_changed:,} changed, "
        f"{counted(len(report.refused), 'file')} refused"
    )
    if report.refused:
        raise typer.Exit(SOME_FAILED)


def preprocess(ws: WorkspaceArgument, collection: CollectionOption = None) -> None:
    """Remesh and describe new shapes.  [dim]partwise preprocess ws[/dim]"""
    from partwise.workspace.ranking import bring_into_order
    from partwise.workspace.shapes import find_collection
    from partwise.workspace.status import collection_status
    from partwise.workspace.workspace import open_workspace
    from partwise_workers.passes import preprocess as run

    moves: list[MoveReport] = []
    with open_workspace(ws) as workspace:
        found = find_collection(workspace, collection)
        with run_progress("preprocess") as tally:
            result = run(workspace, found, tally.on_progress, tally.on_event, moves.append)
        bring_into_order(workspace, found)
        state = collection_status(workspace, found, MAX_REASONS)
    has_failed = result.n_failed > 0 or any(report.n_failed for report in moves)
    if has_failed:
        _report_failures(state)
    if result.n_total:
        typer.echo(f"{counted(result.n_done, 'shape')} preprocessed, {result.n_failed:,} failed")
    else:
        typer.echo(_nothing_to_do(state))
    for report in moves:
        moved_line(report)
    if has_failed:
        raise typer.Exit(SOME_FAILED)


def retry(
    ws: WorkspaceArgument,
    collection: CollectionOption = None,
    stage: Annotated[StageName | None, typer.Option(help="Only failures of this stage.", show_default=False)] = None,
    reason: Annotated[FailureReason | None, typer.Option(help="Only what this ended.", show_default=False)] = None,
    text: Annotated[str, typer.Option(help="Only failures whose reason has this text.", show_default=False)] = "",
    lost: Annotated[
        bool, typer.Option("--lost", help="Instead: check all stored arrays, give up those that are damaged.")
    ] = False,
) -> None:
    """Forget failures to retry.  [dim]partwise retry ws --reason memory[/dim]"""
    from partwise.store.records import FailureKind
    from partwise.workspace.recovery import give_up_lost_blocks
    from partwise.workspace.shapes import find_collection
    from partwise.workspace.workspace import open_workspace

    if lost:
        with open_workspace(ws) as workspace, shape_progress("check") as on_progress:
            names = give_up_lost_blocks(workspace, on_progress)
        again = "; run `partwise preprocess`, and `evaluate` and `refine` if a model exists" if names else ""
        typer.echo(f"{counted(len(names), 'block')} lost or damaged{again}")
        return
    with open_workspace(ws) as workspace:
        collection_id = find_collection(workspace, collection).id
        kind = None if reason is None else FailureKind(reason)
        n_cleared = workspace.catalog.clear_failures(collection_id, stage, kind=kind, reason_contains=text)
    if n_cleared:
        typer.echo(f"{counted(n_cleared, 'failure')} forgotten; run the command that failed again")
        return
    asked = [f"of stage {stage!r}" if stage else "", f"by {reason}" if reason else "", f"with {text!r}" if text else ""]
    typer.echo(" ".join(["no failures", *filter(None, asked), "on record"]))


def status(
    ws: WorkspaceArgument,
    collection: CollectionOption = None,
    shape: Annotated[
        str | None, typer.Option(help="Instead: how this shape came to be, by key or number.", show_default=False)
    ] = None,
    as_json: JsonOption = False,
) -> None:
    """How far a collection is, and what failed.  [dim]partwise status ws[/dim]"""
    from partwise.workspace.shapes import find_collection
    from partwise.workspace.status import collection_status
    from partwise.workspace.workspace import open_workspace

    if shape is not None:
        _shape_status(ws, collection, shape, as_json)
        return
    with open_workspace(ws) as workspace:
        state = collection_status(workspace, find_collection(workspace, collection), MAX_REASONS)
    if as_json:
        print_json(asdict(state))
        return
    print_table(f"Collection {state.collection}", ("state", "shapes"), [(s, f"{n:,}") for s, n in state.states], (1,))
    if state.stages:
        rows = [(stage.stage, f"{stage.n_done:,}", f"{stage.n_failed:,}") for stage in state.stages]
        print_table("Stages", ("stage", "done", "failed"), rows, (1, 2))
    else:
        next_command = "preprocess" if sum(n for _, n in state.states) else "ingest"
        typer.echo(f"No stage has run yet: go on with `partwise {next_command}`.")
    typer.echo(f"Model: {'none yet' if state.model_version is None else f'version {state.model_version}'}")
    _report_failures(state)


def _shape_status(ws: Path, collection: str | None, name: str, as_json: bool) -> None:
    from partwise.workspace.provenance import provenance
    from partwise.workspace.shapes import find_collection, find_shape
    from partwise.workspace.workspace import open_workspace
    from partwise_cli.provenance_card import print_card

    with open_workspace(ws) as workspace:
        card = provenance(workspace, find_shape(workspace, find_collection(workspace, collection), name))
    if as_json:
        print_json(asdict(card))
    else:
        print_card(card)


def gc(
    ws: WorkspaceArgument,
    older_than_h: Annotated[
        float, typer.Option(help="Leave blocks alone that no row names but are younger.", min=0)
    ] = 24,
) -> None:
    """Sweep arrays that nothing needs any more.  [dim]partwise gc ws[/dim]"""
    from partwise.workspace.garbage import collect_garbage
    from partwise.workspace.workspace import open_workspace

    with open_workspace(ws) as workspace:
        report = collect_garbage(workspace, timedelta(hours=older_than_h))
    typer.echo(
        f"{counted(report.n_unused_blocks, 'replaced block')} ({report.n_bytes / 1e6:.1f} MB), "
        f"{counted(report.n_orphan_blocks, 'block')} and {counted(report.n_unfinished, 'unfinished write')} "
        f"of crashed runs, {report.n_expired:,} expired uploads or exports swept"
    )


def migrate(ws: WorkspaceArgument) -> None:
    """Bring the catalog to this version's schema.  [dim]partwise migrate ws[/dim]"""
    from partwise.workspace.workspace import migrate_workspace

    migrate_workspace(ws)
    typer.echo(f"{ws}: the catalog is up to date")


def _n_failed(state: "CollectionStatus") -> int:
    return sum(stage.n_failed for stage in state.stages)


def _nothing_to_do(state: "CollectionStatus") -> str:
    if not sum(n for _, n in state.states):
        return f"nothing to do: collection {state.collection!r} has no shapes; add some with `partwise ingest`"
    if n_failed := _n_failed(state):
        return (
            f"nothing to do; {counted(n_failed, 'shape')} failed before: see `partwise status`, then `partwise retry`"
        )
    return "nothing to do"


def _report_failures(state: "CollectionStatus") -> None:
    lines = [
        f"{failure.source_key}: {failure.stage}: {failure.reason.removeprefix(f'{failure.source_key}: ')}"
        for failure in state.failures
    ]
    warning_lines(lines, _n_failed(state), MAX_REASONS)
