"""What labelling a shape costs a simulated person: from blank, patches, predicted and refined labels.

Each with and without boundary refinement, on the same shapes, so that costs are compared shape by shape.
"""

from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import asdict, dataclass
from enum import StrEnum
from typing import Any

import numpy as np
from jaxtyping import Float, Int

from partwise.errors import NotEnoughDataError
from partwise.features.shape_diameter import shape_diameter
from partwise.labels.palette import default_colour
from partwise.labels.schema import Part, PartSchema
from partwise.segmentation.boundary_refinement import BoundaryRefiner
from partwise.segmentation.random_walk_patches import RandomWalkPatches
from partwise.simulate.annotator.motor import Tool
from partwise.simulate.annotator.session import Annotation, Equipment, annotate
from partwise.simulate.annotator.sight import Sight
from partwise_cli.bench.agreement import Agreement, agreement, mean_agreement
from partwise_cli.bench.paired import PairedDifference, paired_difference
from partwise_cli.bench.patches import TrueShape
from partwise_cli.bench.shape_random import shape_rng
from partwise_cli.bench.simulated_predictions import drawn_accuracy, simulate_prediction

TARGETS = (0.95, 0.97)
SLIDER = (10, 20, 40, 80, 160)
"""Positions of the slider: how many patches."""


class Start(StrEnum):
    """What a person begins with. Blank is for painting only; with patches and labels there are all tools."""

    BLANK = "blank"
    PATCHES = "patches"
    PREDICTED = "predicted"
    REFINED = "refined"


ALL_TOOLS = frozenset({Tool.PAINT, Tool.PATCHES, Tool.SEGMENT_WIDE})


@dataclass(frozen=True, slots=True, eq=False)
class TaskShape:
    """A shape to annotate. part_names : of its category; truth and labels are indices into them.

    predicted, refined : (m,) int64, labels to start from, −1 = unlabelled; None to simulate both.
    """

    shape: TrueShape
    part_names: tuple[str, ...]
    predicted: Int[np.ndarray, " m"] | None = None
    refined: Int[np.ndarray, " m"] | None = None


@dataclass(frozen=True, slots=True)
class TaskRow:
    """One simulated person at one shape up to one target.

    start_right : share of area right before the first stroke. reached : whether the target was; cost is of all that
    was done if it was not. The rest is `AnnotationCost`.
    """

    shape: str
    start: Start
    refinement: bool
    target: float
    start_right: float
    reached: bool
    strokes: int
    clicks: int
    undos: int
    active_s: float


@dataclass(frozen=True, slots=True)
class AnnotatingMeasurement:
    """rows : of every shape, start, way and target. agreements : (start, "start" | "plain" | "refinement") → of all
    shapes: of the labels begun with, and of those made without and with boundary refinement."""

    seed: int
    simulated: bool
    targets: tuple[float, ...]
    rows: tuple[TaskRow, ...]
    agreements: dict[tuple[Start, str], Agreement]

    def values(self, start: Start, refinement: bool, target: float, name: str) -> list[float]:
        """A cost of each shape, in the order of shapes."""
        return [float(getattr(row, name)) for row in self._rows(start, refinement, target)]

    def summary(self) -> list[dict[str, Any]]:
        """Medians and means of each start, way and target."""
        return [
            {
                "start": start.value,
                "refinement": refinement,
                "target": target,
                "n": len(rows),
                "n_unreached": sum(not row.reached for row in rows),
                "median_start_right": _rounded(np.median([row.start_right for row in rows]), 4),
                **{
                    f"{statistic.__name__}_{name}": _rounded(statistic([getattr(row, name) for row in rows]))
                    for name in ("strokes", "clicks", "active_s")
                    for statistic in (np.median, np.mean)
                },
            }
            for target in self.targets
            for start in Start
            for refinement in (False, True)
            if (rows := self._rows(start, refinement, target))
        ]

    def comparisons(self, name: str = "strokes") -> list[tuple[str, float, PairedDifference]]:
        """(what, target, first less second): with refinement against without, and each start against the one before."""
        pairs = [(f"{start}: with − without refinement", (start, True), (start, False)) for start in Start]
        pairs += [
            (f"{later} − {earlier}, {'with' if way else 'without'} refinement", (later, way), (earlier, way))
            for earlier, later in zip(list(Start), list(Start)[1:], strict=False)
            for way in (False, True)
        ]
        rng = np.random.default_rng(self.seed)
        return [
            (what, target, paired_difference(values, others, rng))
            for target in self.targets
            for what, first, second in pairs
            if (values := self.values(*first, target, name)) and (others := self.values(*second, target, name))
        ]

    def as_json(self) -> dict[str, Any]:
        """Plain numbers, strings, lists and dicts."""
        return {
            "seed": self.seed,
            "predictions": "simulated" if self.simulated else "given",
            "n_shapes": len({row.shape for row in self.rows}),
            "summary": self.summary(),
            "comparisons": {
                name: [
                    {"what": what, "target": target, **_plain(pair)} for what, target, pair in self.comparisons(name)
                ]
                for name in ("strokes", "clicks", "active_s")
            },
            "agreement": [
                {"start": start.value, "labels": which, **asdict(value)}
                for (start, which), value in self.agreements.items()
            ],
            "rows": [{**asdict(row), "start": row.start.value} for row in self.rows],
        }

    def _rows(self, start: Start, refinement: bool, target: float) -> list[TaskRow]:
        return [row for row in self.rows if (row.start, row.refinement, row.target) == (start, refinement, target)]


def measure_annotating(
    tasks: Iterable[TaskShape],
    seed: int,
    targets: Sequence[float] = TARGETS,
    on_shape: Callable[[str], None] | None = None,
) -> AnnotatingMeasurement:
    """One simulated person for each shape, start and way. A shape's outcome does not depend on the other shapes.

    A start whose labels are missing where others were given is left out.

    Raises
    ------
    NotEnoughDataError : no shapes.
    LabelError : a shape with unlabelled faces.
    """
    rows: list[TaskRow] = []
    found: dict[tuple[Start, str], list[Agreement]] = {}
    simulated = True
    for task in tasks:
        simulated = simulated and task.predicted is None and task.refined is None
        for start, which, value, made in _annotated(task, seed, max(targets)):
            found.setdefault((start, which), []).append(value)
            if made is not None:
                rows += [_row(task.shape.name, start, which == "refinement", target, made) for target in targets]
        if on_shape is not None:
            on_shape(task.shape.name)
    if not rows:
        raise NotEnoughDataError("annotating is measured on labelled shapes but there are none; name a folder of some")
    means = {key: mean_agreement(values) for key, values in found.items()}
    return AnnotatingMeasurement(seed, simulated, tuple(targets), tuple(rows), means)


def schema_of(part_names: Sequence[str]) -> PartSchema:
    """Parts 1, 2, … of these names."""
    return PartSchema(1, tuple(Part(i, name, default_colour(i)) for i, name in enumerate(part_names, start=1)))


def _annotated(task: TaskShape, seed: int, target: float) -> Iterator[tuple[Start, str, Agreement, Annotation | None]]:
    mesh, truth = task.shape.mesh, task.shape.truth
    category = task.shape.name.rpartition("/")[0]
    names = [f"{category}/{name}" if category else name for name in task.part_names]  # each has its own "body"
    diameters = shape_diameter(mesh).astype(np.float64)
    sight, schema = Sight.of(mesh, truth + 1), schema_of(task.part_names)
    cutter, refiner = RandomWalkPatches(mesh, diameters), BoundaryRefiner.build(mesh, diameters)
    patches = [cutter.patches(min(n, mesh.n_faces)) for n in SLIDER]
    for start, labels in _starts(task, shape_rng(seed, task.shape.name, "prediction")).items():
        if labels is not None:
            yield start, "start", agreement(mesh, labels, truth, names), None
        for refinement in (False, True):
            which = "refinement" if refinement else "plain"
            tools = frozenset({Tool.PAINT}) if start is Start.BLANK else ALL_TOOLS
            equipment = Equipment(
                tools=tools | {Tool.BOUNDARY_REFINEMENT} if refinement else tools,
                patches=patches if Tool.PATCHES in tools else (),
                refine=refiner.refine if refinement else None,
                target=target,
            )
            rng = shape_rng(
                seed, task.shape.name, start
            )  # the same with and without: logs differ only from the first refinement on
            made = annotate(mesh, sight, schema, equipment, rng, None if labels is None else labels + 1)
            yield start, which, agreement(mesh, made.labels.astype(np.int64) - 1, truth, names), made


def _starts(task: TaskShape, rng: np.random.Generator) -> dict[Start, Int[np.ndarray, " m"] | None]:
    """The labels that each start begins with, None for blank."""
    starts: dict[Start, Int[np.ndarray, " m"] | None] = {Start.BLANK: None, Start.PATCHES: None}
    predicted, refined = task.predicted, task.refined
    if predicted is None and refined is None:
        made = simulate_prediction(task.shape.mesh, task.shape.truth, len(task.part_names), drawn_accuracy(rng), rng)
        predicted, refined = made.predicted, made.refined
    given = {Start.PREDICTED: predicted, Start.REFINED: refined}
    return starts | {start: labels for start, labels in given.items() if labels is not None}


def _row(name: str, start: Start, refinement: bool, target: float, made: Annotation) -> TaskRow:
    cost = made.cost(target)
    return TaskRow(
        shape=name,
        start=start,
        refinement=refinement,
        target=target,
        start_right=round(made.begun_with, 5),
        reached=made.n_strokes_to(target) is not None,
        strokes=cost.strokes,
        clicks=cost.clicks,
        undos=cost.undos,
        active_s=round(cost.active_s, 2),
    )


def _plain(pair: PairedDifference) -> dict[str, Any]:
    values = {name: _rounded(value) if isinstance(value, float) else value for name, value in asdict(pair).items()}
    return {**values, "interval": [_rounded(value) for value in pair.interval], "is_less": pair.is_less}


def _rounded(value: Float[np.ndarray, ""] | float, digits: int = 3) -> float:
    return round(float(value), digits)
