"""Benchmarks: `partwise bench loo` and `partwise bench describe`."""

import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
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


@contextmanager
def _workspace_folder(chosen: Path | None) -> Iterator[Path]:
    if chosen is not None:
        yield chosen
        return
    with tempfile.TemporaryDirectory(prefix="partwise-bench-") as folder:
        yield Path(folder)
