"""What measuring the page came to, as tables, with what was aimed at."""

import typer

from partwise_cli.bench.page import BrowserReport
from partwise_cli.bench.page_shape import Figures
from partwise_cli.terminal import counted, print_table

FIRST_PAINT_MS = 1_000
BRUSH_MS = 16


def print_page(report: BrowserReport) -> None:
    """The shape, then the table, then what is measured and what is inferred."""
    shape, table = report.shape, report.table
    times = [
        _times("first paint, nothing cached", shape.cold, f"≤ {FIRST_PAINT_MS}"),
        _times("first paint, again", shape.warm, f"≤ {FIRST_PAINT_MS}"),
        _times("  from asking for the shape", shape.asked_to_paint, ""),
        _times("  processor time, nothing cached", shape.cold_core, ""),
        _times("  processor time, again", shape.warm_core, ""),
        _times("brush: from event to drawing commands", shape.brush.to_command, f"≤ {BRUSH_MS}"),
        _times("brush: from event to drawn frame", shape.brush.to_frame, ""),
        _times("new colours: script", shape.recolour.script, f"≤ {BRUSH_MS}"),
        _times("new colours: to drawn frame", shape.recolour.to_frame, ""),
        _times("table: from a jump to rows", table.to_rows, ""),
        _times("table: from a jump to pictures", table.to_pictures, ""),
    ]
    title = f"{report.n_faces:,} faces, {counted(table.n_shapes, 'shape')}: milliseconds"
    print_table(title, ("what", "n", "median", "p99", "most", "aim"), times, (1, 2, 3, 4))
    brush, recolour = shape.brush, shape.recolour
    spent = [
        ("brush, a pointer move", f"{brush.script_ms:.2f}", f"{brush.thread_ms:.2f}", f"{brush.graphics_ms:.2f}"),
        ("new colours, a change", f"{recolour.script_ms:.2f}", "", f"{recolour.graphics_ms:.2f}"),
    ]
    print_table("Processor milliseconds", ("what", "scripts", "page's thread", "drawing in software"), spent, (1, 2, 3))
    weights = [
        (name, f"{each.elements:,}", f"{each.nodes:,}", f"{each.heap_mb:.1f}")
        for name, each in (("as opened", table.before), ("at most", table.at_most), ("at the top again", table.after))
    ]
    print_table("The table holds", ("when", "elements", "nodes", "heap MB"), weights, (1, 2, 3))
    typer.echo(report.measured)
    typer.echo(report.inferred)
    before, after = report.load_average
    typer.echo(
        f"Chromium {report.chromium}; load average {before:.2f} before, {after:.2f} after, "
        f"on {counted(report.n_cpus, 'processor')}"
    )


def _times(what: str, figures: Figures, aim: str) -> tuple[str, ...]:
    return what, str(figures.n), f"{figures.median:.1f}", f"{figures.p99:.1f}", f"{figures.most:.1f}", aim
