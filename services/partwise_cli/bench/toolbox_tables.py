"""The toolbox's measurements as tables for people."""

from collections.abc import Sequence

from partwise_cli.bench.annotating import AnnotatingMeasurement
from partwise_cli.bench.patches import PatchMeasurement
from partwise_cli.bench.refinement import VARIANTS, BoundaryMeasurement
from partwise_cli.bench.toolbox import Measured
from partwise_cli.terminal import print_table

Rows = Sequence[Sequence[str]]


def print_measured(measured: Measured) -> None:
    """One subject's tables."""
    of = f"{measured.n_shapes:,} shapes, {measured.core_s:.0f} core-seconds"
    result = measured.result
    if isinstance(result, PatchMeasurement):
        _print_patches(result, of)
    elif isinstance(result, BoundaryMeasurement):
        _print_boundaries(result, of)
    elif isinstance(result, AnnotatingMeasurement):
        _print_annotating(result, of)
    else:
        times = result.as_json()["core_ms_at_10k_faces"]
        rows = [(n, f"{ms['first_core_ms']:.0f}", f"{ms['solve_core_ms']:.0f}") for n, ms in times.items()]
        _table(f"Model refinement, core-ms at 10,000 faces ({of})", ("labels", "first", "another λ"), rows)


def _print_patches(result: PatchMeasurement, of: str) -> None:
    walks, k_means = result.mean_accuracy("random_walks"), result.mean_accuracy("k_means")
    rows = [
        (str(n), f"{first:.2%}", f"{second:.2%}", f"{100 * (first - second):.1f}")
        for n, first, second in zip(result.n_patches, walks, k_means, strict=True)
    ]
    columns = ("patches", "random walks", "k-means", "points ahead")
    _table(f"Area right where each patch takes its majority part ({of})", columns, rows)


def _print_boundaries(result: BoundaryMeasurement, of: str) -> None:
    rows: list[tuple[str, ...]] = []
    for variant in VARIANTS:
        mean = result.mean(variant)
        moved, true = mean["displaced_distance"], mean["true_distance"]
        rows.append(
            (
                variant.replace("_", " "),
                *(f"{mean['gain'][n]:.2f}" for n in (0, -1)),
                *(f"{mean['loss'][n]:.2f}" for n in (0, -1)),
                f"{moved[0]:.2f} → {moved[1]:.2f}",
                f"{true[1]:.2f}",
                f"{mean['half_of_patches_filled']:.1f} → {mean['half_of_patches_refined']:.1f}",
                f"{mean['pass_core_ms_at_10k_faces']:.0f}",
            )
        )
    n = len(result.mean("default")["gain"])
    columns = (
        "form",
        "gain",
        f"after {n}",
        "loss",
        f"after {n}",
        "distance",
        "from truth",
        "half of patches",
        "core-ms",
    )
    _table(f"Boundary refinement, points of area and % of the diagonal ({of})", columns, rows)


def _print_annotating(result: AnnotatingMeasurement, of: str) -> None:
    costs = [
        (
            row["start"],
            "yes" if row["refinement"] else "no",
            f"{row['target']:.0%}",
            f"{row['median_start_right']:.1%}",
            *(f"{row[f'median_{name}']:.1f} ({row[f'mean_{name}']:.1f})" for name in ("strokes", "clicks", "active_s")),
            str(row["n_unreached"]),
        )
        for row in result.summary()
    ]
    columns = ("start", "refinement", "target", "right at start", "strokes", "clicks", "seconds", "not reached")
    _table(f"Simulated annotator, median (mean) a shape ({of})", columns, costs)
    pairs = [
        (
            what,
            f"{target:.0%}",
            f"{pair.median:g}",
            f"{pair.mean:.1f}",
            f"{pair.interval[0]:.1f} … {pair.interval[1]:.1f}",
            f"{pair.less} / {pair.equal} / {pair.more}",
        )
        for what, target, pair in result.comparisons()
    ]
    of_pairs = ("difference", "target", "median", "mean", "95 %", "fewer / same / more")
    _table("Strokes, paired by shape", of_pairs, pairs)
    _print_agreements(result)


def _print_agreements(result: AnnotatingMeasurement) -> None:
    made = {"start": "begun with", "plain": "made", "refinement": "made with refinement"}
    rows = [
        (
            start.value,
            made[which],
            f"{value.accuracy:.2%}",
            f"{value.accuracy_by_area:.2%}",
            f"{value.mean_iou:.3f}",
            "{} {:.3f}".format(*min(value.iou.items(), key=lambda item: item[1])),
            f"{100 * value.boundary_distance:.2f}",
        )
        for (start, which), value in result.agreements.items()
    ]
    columns = ("start", "labels", "faces right", "area right", "mean IoU", "worst part", "boundary, % of diagonal")
    _table("Agreement with the truth", columns, rows, n_left=2)


def _table(title: str, columns: Sequence[str], rows: Rows, n_left: int = 1) -> None:
    print_table(title, columns, rows, tuple(range(n_left, len(columns))))
