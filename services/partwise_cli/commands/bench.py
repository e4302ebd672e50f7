"""Benchmarks: `partwise bench loo`, `partwise bench describe` and `partwise bench toolbox`."""

import tempfile
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager
from dataclasses import asdict
from pathlib import Path
from typing import Annotated

import typer

from partwise_cli.arguments import JsonOption
from partwise_cli.terminal import print_json, print_table, progress, shape_progress, warning_lines

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
            if not as_json:
                print_measured(each)
    if as_json:
        print_json(toolbox_json(request, measured))


@contextmanager
def _workspace_folder(chosen: Path | None) -> Iterator[Path]:
    if chosen is not None:
        yield chosen
        return
    with tempfile.TemporaryDirectory(prefix="partwise-bench-") as folder:
        yield Path(folder)
