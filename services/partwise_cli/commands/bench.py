"""Benchmarks: describe, loo, remeshing, calibration, scheduling, throughput, toolbox, service-tools, load, page."""

import tempfile
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager
from dataclasses import asdict
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from partwise_cli.arguments import CollectionOption, JsonOption, WorkspaceArgument
from partwise_cli.run_view import run_progress
from partwise_cli.terminal import counted, print_json, print_table, progress, shape_progress, warning_lines

if TYPE_CHECKING:
    from partwise_cli.bench.remeshing import RemeshOutcome
    from partwise_cli.bench.scheduling import SchedulingCost

app = typer.Typer(no_args_is_help=True, rich_markup_mode="rich")

ACCURACIES = ("accuracy_raw", "accuracy_refined", "accuracy_raw_by_area", "accuracy_refined_by_area")


def register(parent: typer.Typer) -> None:
    """Adds the group of commands of this module."""
    summary = "Measure on your own files.  [dim]partwise bench describe mug.off[/dim]"
    parent.add_typer(app, name="bench", help=summary, rich_help_panel="Try it out")


@app.command()
def describe(
    files: Annotated[list[Path], typer.Argument(help="Mesh files.", show_default=False)], as_json: JsonOption = False
) -> None:
    """Core-seconds and memory.  [dim]partwise bench describe chair.off --json[/dim]"""
    from partwise_cli.bench.describing import time_descriptions

    rows = []
    for timing in time_descriptions(files):
        if as_json:
            print_json(asdict(timing))
        else:
            seconds = [f"{value:.2f}" for value in timing.core_s.values()]
            rows.append((Path(timing.file).name, f"{timing.n_faces:,}", *seconds, f"{timing.peak_mb:.0f}"))
            names = tuple(name.replace("_", " ") for name in timing.core_s)
    if rows:
        print_table("Core-seconds", ("file", "faces", *names, "peak MB"), rows, tuple(range(1, len(rows[0]))))


@app.command()
def loo(
    folder: Annotated[Path, typer.Argument(help="Folder with a folder a category.", show_default=False)],
    category: Annotated[str, typer.Option(help="Folder of <id>.off and <id>_labels.txt files.", show_default=False)],
    preset: Annotated[str, typer.Option(help="How to train: paper.")] = "paper",
    limit: Annotated[
        int | None, typer.Option(help="Hold out only so many, evenly spaced.", min=1, show_default=False)
    ] = None,
    iterations: Annotated[int, typer.Option(help="Training steps.", min=5)] = 5000,
    seed: Annotated[int, typer.Option(help="Of training.", min=0)] = 0,
    workspace: Annotated[
        Path | None, typer.Option(help="Keep the described shapes here, for the next time.", show_default=False)
    ] = None,
    as_json: JsonOption = False,
) -> None:
    """Leave one out.  [dim]partwise bench loo lpsb --category Airplane --limit 4[/dim]"""
    from partwise.learning.recipe import Recipe
    from partwise.workspace.workspace import open_workspace
    from partwise_cli.bench.leave_one_out import leave_one_out, prepare, summarise

    recipe = Recipe(preset=preset, n_iterations=iterations, seed=seed)
    with _workspace_folder(workspace) as path:
        with shape_progress("describe") as on_run:
            prepared = prepare(folder / category, path, on_run)
        warning_lines(prepared.refused)
        results = []
        with open_workspace(path) as opened, progress("train") as on_progress:
            for result in leave_one_out(opened, prepared.collection, recipe, limit, on_progress):
                results.append(result)
                if as_json:
                    print_json(asdict(result))
    summary = summarise(results, category, preset, prepared.n_shapes)
    if as_json:
        print_json(asdict(summary))
        return
    columns = ("shape", "faces", "raw", "refined", "raw, by area", "refined, by area", "smoothness", "train s")
    rows = [
        (
            r.shape,
            f"{r.n_faces:,}",
            *(f"{getattr(r, name):.2%}" for name in ACCURACIES),
            f"{r.smoothness:g}",
            f"{r.train_s:.0f}",
        )
        for r in results
    ]
    means = (f"{getattr(summary, name):.2%}" for name in ACCURACIES)
    rows.append(("mean", "", *means, "", f"{summary.train_s:.0f}"))
    print_table(f"Leave one out: {category}, {preset}", columns, rows, tuple(range(1, len(columns))))


@app.command()
def remeshing(
    folder: Annotated[Path, typer.Argument(help="Folder of mesh files.", show_default=False)],
    levels: Annotated[
        str, typer.Option(help="Face counts, descending. What one costs by itself takes a run with it alone.")
    ] = "50000,20000,10000,5000",
    deadline_s: Annotated[float, typer.Option(help="Seconds after which a shape is given up.", min=1)] = 600,
    pictures: Annotated[
        Path | None, typer.Option(help="Draw all before and after into this PNG file.", show_default=False)
    ] = None,
    as_json: JsonOption = False,
) -> None:
    """Remesh a folder.  [dim]partwise bench remeshing dirty/ --levels 10000[/dim]"""
    from partwise.workspace.ingest import mesh_files
    from partwise_cli.bench.remeshing import measure_remeshing, summarise, write_pictures

    outcomes: list[RemeshOutcome] = []
    n_files = sum(1 for _ in mesh_files(folder)) if folder.is_dir() else 0
    with tempfile.TemporaryDirectory(prefix="partwise-bench-") as kept, progress("remesh") as on_progress:
        for outcome in measure_remeshing(folder, _numbers(levels), deadline_s, Path(kept) if pictures else None):
            outcomes.append(outcome)
            on_progress(len(outcomes), n_files, outcome.file)
            if as_json:
                print_json(asdict(outcome))
        if pictures is not None:
            write_pictures(outcomes, Path(kept), pictures)
    summary = summarise(outcomes)
    if as_json:
        print_json(asdict(summary))
        return
    _print_remeshing(outcomes)
    title = f"{summary.n_accepted} of {summary.n_shapes} accepted, {summary.n_as_is} of them as they are; medians"
    rows = [
        (f"{n:,} faces", f"{reached} reached", f"{summary.core_s_to[n]:.1f} core-s" if n in summary.core_s_to else "")
        for n, reached in summary.n_reached.items()
    ]
    print_table(title, ("level", "shapes", "attempts and level"), rows, (1, 2))
    warning_lines(summary.refused)


def _print_remeshing(outcomes: "list[RemeshOutcome]") -> None:
    rows = [
        (
            outcome.file,
            f"{outcome.n_faces:,}",
            str(len(outcome.attempts) - 1),
            outcome.attempts[-1].partition(":")[0] if outcome.refused is None else "refused",
            "" if outcome.distance is None else f"{outcome.distance:.3f}",
            " ".join("–" if level.reached is None else f"{level.reached:,}" for level in outcome.levels),
            f"{outcome.core_s:.1f}",
        )
        for outcome in outcomes
    ]
    columns = ("shape", "faces", "attempts", "by", "distance", "levels", "core-s")
    print_table("Remeshing", columns, rows, (1, 2, 4, 6))


@app.command()
def calibration(
    per_category: Annotated[int, typer.Option(help="Shapes of each category.", min=2)] = 5,
    faces: Annotated[int, typer.Option(help="Of the working meshes.", min=100)] = 10_000,
    seed: Annotated[int, typer.Option(help="Of the simulated collections.", min=0)] = 11,
) -> None:
    """The threshold's experiment.  [dim]partwise bench calibration[/dim]"""
    from partwise.remesh.calibration import table
    from partwise_cli.bench.calibrating import calibrated

    found = calibrated(per_category, faces, seed)
    typer.echo(table(found))
    typer.echo(f"good pairs end at {found.greatest_good:.3f}, wrong pairs begin at {found.least_wrong:.3f}")
    typer.echo(f"suggested max_distance: {found.suggested_distance:.3f}")
    warning_lines([f"not remeshed: {name}" for name in found.not_remeshed])


@app.command()
def scheduling(
    shapes: Annotated[int, typer.Option(help="Rows in the catalog, without files.", min=2)] = 10_000,
    actors: Annotated[int, typer.Option(help="Processes that do nothing.", min=1)] = 2,
    stages: Annotated[int, typer.Option(help="Stages of the chain.", min=1)] = 1,
    as_json: JsonOption = False,
) -> None:
    """What a shape costs besides its work.  [dim]partwise bench scheduling --shapes 300000[/dim]"""
    from partwise_cli.bench.scheduling import measure_scheduling

    with tempfile.TemporaryDirectory(prefix="partwise-bench-") as folder, run_progress("no-op") as tally:
        cost = measure_scheduling(Path(folder) / "workspace", shapes, actors, stages, tally.on_progress)
    if as_json:
        print_json(asdict(cost))
    else:
        _print_scheduling(cost)


def _print_scheduling(cost: "SchedulingCost") -> None:
    title = f"{counted(cost.n_shapes, 'shape')}, {counted(cost.n_stages, 'stage')}: milliseconds a shape"
    rows = [("all of it", f"{cost.wall_ms:.3f}", f"{cost.core_ms['total']:.3f}")]
    rows += [(role, "", f"{ms:.3f}") for role, ms in cost.core_ms.items() if role != "total"]
    rows += [
        (f"driver: {part}", f"{cost.parts_wall_ms[part]:.3f}" if part in cost.parts_wall_ms else "", f"{ms:.3f}")
        for part, ms in cost.parts_core_ms.items()
    ]
    rows += [(f"once: {step}", f"{ms:.3f}", "") for step, ms in cost.once_ms.items()]
    print_table(title, ("what", "wall", "core"), rows, (1, 2))
    typer.echo("before: " + ", ".join(f"{name} {seconds:g} s" for name, seconds in cost.before_s.items()))
    chosen = {round(share * (len(cost.memory) - 1)) for share in (0, 0.1, 0.5, 1)}
    samples = [cost.memory[index] for index in sorted(chosen)]
    typer.echo("driver's memory: " + ", ".join(f"{each.driver_mb:g} MB at {each.n_done:,}" for each in samples))


@app.command()
def throughput(
    folder: Annotated[Path, typer.Argument(help="Folder for simulated shapes and workspaces.", show_default=False)],
    shapes: Annotated[int, typer.Option(help="Shapes that count, half of them soups.", min=1)] = 100,
    actors: Annotated[str, typer.Option(help="Numbers of actors to compare, of one thread each.")] = "1,2",
    faces: Annotated[int, typer.Option(help="Of the clean shapes.", min=100)] = 4_000,
    levels: Annotated[str, typer.Option(help="Face counts of remeshed shapes.")] = "10000,5000",
    as_json: JsonOption = False,
) -> None:
    """How preprocessing scales.  [dim]partwise bench throughput /tmp/t --shapes 100[/dim]"""
    from partwise_cli.bench.throughput import ThroughputRequest, measure_throughput

    request = ThroughputRequest(shapes, _numbers(actors), faces, _numbers(levels))
    with progress("simulate") as on_simulated:
        report = measure_throughput(folder, request, on_simulated, run_progress)
    if as_json:
        print_json(asdict(report))
        return
    rows = [
        (
            str(run.n_actors),
            f"{run.rate_per_min:.1f}",
            f"{ratio:.2f}",
            f"{run.wall_s:.0f}",
            f"{run.stage_s:.0f}",
            f"{run.warm_up_s:.0f}",
            str(run.n_failed),
        )
        for run, ratio in zip(report.runs, report.ratios, strict=True)
    ]
    columns = ("actors", "shapes/min", "ratio", "wall s", "in stages s", "start and warm-up s", "failed")
    print_table(f"Preprocessing {counted(shapes, 'shape')}", columns, rows, tuple(range(7)))


def _numbers(text: str) -> tuple[int, ...]:
    try:
        return tuple(int(number) for number in text.split(",") if number.strip())
    except ValueError as error:
        raise typer.BadParameter(f"needs whole numbers with commas between them but is {text!r}") from error


@app.command()
def toolbox(
    folder: Annotated[
        Path, typer.Argument(help="Folder, or folder of folders, of <id>.off and <id>_labels.txt.", show_default=False)
    ],
    limit: Annotated[
        int | None,
        typer.Option(
            help="Shapes a category, evenly spaced. Without: all for patches and boundaries, 2 for model, 3 for "
            "annotator.",
            min=1,
            show_default=False,
        ),
    ] = None,
    seed: Annotated[int, typer.Option(help="Of all that is random.", min=0)] = 0,
    only: Annotated[
        str | None,
        typer.Option(help="Some of patches,boundaries,model,annotator, with commas.", show_default=False),
    ] = None,
    target: Annotated[
        list[float] | None,
        typer.Option(
            help="Share of area right that annotators work to; again for more. 0.95 and 0.97.", show_default=False
        ),
    ] = None,
    predictions: Annotated[
        Path | None,
        typer.Option(
            help="Folder with predicted/ and refined/ of [<category>/]<id>.seg to start from; simulated without.",
            show_default=False,
        ),
    ] = None,
    as_json: JsonOption = False,
) -> None:
    """What the annotator's tools give and save.  [dim]partwise bench toolbox lpsb --limit 2 --json[/dim]"""
    from partwise_cli.bench.annotating import TARGETS
    from partwise_cli.bench.toolbox import ToolboxRequest, parse_subjects, run_toolbox, toolbox_json
    from partwise_cli.bench.toolbox_tables import print_measured

    subjects, targets = parse_subjects(only), tuple(sorted(target)) if target else TARGETS
    request = ToolboxRequest(folder, subjects, limit, seed, targets, predictions)
    measured = []
    with ExitStack() as bars:
        for each in run_toolbox(request, lambda title: bars.enter_context(progress(title))):
            measured.append(each)
            bars.close()  # a bar must be gone before its tables come
            warning_lines(each.refused)
            if not as_json:
                print_measured(each)
    if as_json:
        print_json(toolbox_json(request, measured))


@app.command()
def service_tools(
    ws: WorkspaceArgument,
    collection: CollectionOption = None,
    shapes: Annotated[int, typer.Option(help="Shapes to ask for, after two that start it all.", min=1)] = 8,
    as_json: JsonOption = False,
) -> None:
    """How long tools take over HTTP.  [dim]partwise bench service-tools ws --shapes 8[/dim]"""
    from partwise.workspace.shapes import find_collection
    from partwise.workspace.workspace import open_workspace
    from partwise_cli.bench.service_tools import medians, time_service_tools

    with open_workspace(ws) as workspace, progress("tools") as advance:
        timings = time_service_tools(workspace, find_collection(workspace, collection), shapes, advance)
    if as_json:
        for timing in timings:
            print_json(asdict(timing))
        return
    rows = [
        (each.source_key, each.tool, f"{each.n_faces:,}", *(f"{ms:.0f}" for ms in each.milliseconds))
        for each in [*timings, *medians(timings)]
    ]
    print_table("Milliseconds", ("shape", "tool", "faces", "first", "again", "other setting"), rows, (2, 3, 4, 5))


@app.command()
def load(
    database: Annotated[
        str, typer.Option(help="sqlite, postgres for a server of its own, or the URL of an empty database.")
    ] = "sqlite",
    shapes: Annotated[int, typer.Option(help="Rows in the catalog.", min=1)] = 300_000,
    people: Annotated[int, typer.Option(help="Who work at once.", min=1)] = 200,
    minutes: Annotated[float, typer.Option(help="For which they work; 0 for the table alone.", min=0)] = 3,
    pages: Annotated[int, typer.Option(help="Requests for each order and filter; 0 for the people alone.", min=0)] = 60,
    seed: Annotated[int, typer.Option(help="Of the rows and of what people do.", min=0)] = 0,
    processes: Annotated[int, typer.Option(help="That serve.", min=1)] = 1,
    as_json: JsonOption = False,
) -> None:
    """The service under load.  [dim]partwise bench load --database postgres[/dim]"""
    from partwise_cli.bench.load import LoadRequest, run_load
    from partwise_cli.bench.load_report import print_load

    request = LoadRequest(database, shapes, people, minutes, pages, seed, processes)
    with progress("load") as advance:
        report = run_load(request, lambda what, n_done, n_total: advance(n_done, n_total, what))
    if as_json:
        print_json(asdict(report))
    else:
        print_load(report)
    if not report.is_sound:
        raise typer.Exit(1)


@app.command()
def page(
    out: Annotated[Path, typer.Argument(help="New folder, for the workspace and page.json.", show_default=False)],
    faces: Annotated[int, typer.Option(help="Of the shape that is opened and painted.", min=1_000)] = 50_000,
    shapes: Annotated[int, typer.Option(help="Rows of the table.", min=100)] = 300_000,
    repeats: Annotated[int, typer.Option(help="Navigations, with an empty cache and again.", min=1)] = 5,
    jumps: Annotated[int, typer.Option(help="Places of the table that are looked at.", min=2)] = 60,
    seed: Annotated[int, typer.Option(help="Of the shape and the rows.", min=0)] = 0,
    as_json: JsonOption = False,
) -> None:
    """The page in a browser.  [dim]partwise bench page build/page --json[/dim]"""
    from partwise_cli.bench.page import PageRequest, run_page
    from partwise_cli.bench.page_report import print_page

    request = PageRequest(faces, shapes, repeats, jumps, seed)
    with progress("page") as advance:
        report = run_page(out, request, lambda what, n_done, n_total: advance(n_done, n_total, what))
    if as_json:
        print_json(asdict(report))
    else:
        print_page(report)


@contextmanager
def _workspace_folder(chosen: Path | None) -> Iterator[Path]:
    if chosen is not None:
        yield chosen
        return
    with tempfile.TemporaryDirectory(prefix="partwise-bench-") as folder:
        yield Path(folder)
