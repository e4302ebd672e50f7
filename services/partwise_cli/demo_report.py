"""What the demo shows at its end."""

from collections.abc import Sequence

import numpy as np
import typer
from rich.markup import escape

from partwise.workspace.assessment import ShapeAccuracy
from partwise_cli.demo import DemoReport, Remeshing
from partwise_cli.terminal import console, counted, print_table


def print_report(report: DemoReport) -> None:
    """Accuracy, how well the ranking tells good from bad, times, and where the files are."""
    rows = [
        (name, *(f"{value:.1%}" for value in row.values())) for name, row in report_as_json(report)["accuracy"].items()
    ]
    title = (
        f"{len(report.refined)} {report.request.category} nobody labelled, after {report.request.n_confirmed} confirmed"
    )
    print_table(
        title,
        ("share of labels right", "predicted", "refined", "predicted, by area", "refined, by area"),
        rows,
        (1, 2, 3, 4),
    )
    times = ", ".join(f"{step} {seconds:.0f} s" for step, seconds in report.seconds.items())
    lines = {
        "Remeshing": _remeshing(report.remeshing),
        "Not judged": f"{counted(report.n_unjudged, 'shape')} whose ground truth did not come to the new mesh whole",
        "Time": f"{sum(report.seconds.values()):.0f} s: {times}",
        "Shapes": str(report.shapes),
        "Workspace": str(report.workspace),
        "Labels": str(report.exported),
        "Picture": str(report.picture),
    }
    for label, value in lines.items():
        console().print(f"[bold]{label:<10}[/bold] {escape(value)}", soft_wrap=True)
    typer.echo(f"\nLook at the queue:   partwise queue {report.workspace}")
    typer.echo(f"Work in the browser: partwise up {report.workspace}")


def _remeshing(made: Remeshing) -> str:
    refused = f", {made.n_refused} could not be" if made.n_refused else ""
    core_s = f" at a median of {made.median_core_s:.1f} core-seconds" if made.n_remeshed else ""
    return f"{counted(made.n_as_is, 'shape')} taken as they are, {made.n_remeshed} soups remeshed{core_s}{refused}"


def report_as_json(report: DemoReport) -> dict[str, dict[str, dict[str, float]]]:
    """The table as numbers, shares in [0, 1]."""
    quarter = max(1, len(report.refined) // 4)
    groups = {
        "all": slice(None),
        "most certain quarter": slice(-quarter, None),
        "least certain quarter": slice(None, quarter),
    }
    return {"accuracy": {name: _means(report, rows) for name, rows in groups.items()}}


def _means(report: DemoReport, rows: slice) -> dict[str, float]:
    def mean(assessed: Sequence[ShapeAccuracy], by_area: bool) -> float:
        return float(np.mean([a.by_area if by_area else a.by_face for a in assessed[rows]]))

    return {
        "predicted": mean(report.predicted, by_area=False),
        "refined": mean(report.refined, by_area=False),
        "predicted_by_area": mean(report.predicted, by_area=True),
        "refined_by_area": mean(report.refined, by_area=True),
    }
