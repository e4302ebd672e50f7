"""All that is measured of the annotator's toolbox, over one folder of labelled meshes."""

import time
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from enum import StrEnum
from pathlib import Path
from types import MappingProxyType
from typing import Any

from partwise.errors import ParameterError
from partwise_cli.bench.annotating import TARGETS, AnnotatingMeasurement, measure_annotating
from partwise_cli.bench.labelled_folder import ShapeFile, fully_labelled, labelled_files, sampled, tasks
from partwise_cli.bench.patches import PatchMeasurement, TrueShape, measure_patches
from partwise_cli.bench.refinement import (
    BoundaryMeasurement,
    ModelRefinementMeasurement,
    measure_boundary_refinement,
    measure_model_refinement_time,
)
from partwise_cli.terminal import Advance


class Subject(StrEnum):
    """What can be measured by itself."""

    PATCHES = "patches"
    BOUNDARIES = "boundaries"
    MODEL = "model"
    ANNOTATOR = "annotator"


USUAL_LIMITS: Mapping[Subject, int | None] = MappingProxyType(
    {Subject.PATCHES: None, Subject.BOUNDARIES: None, Subject.MODEL: 2, Subject.ANNOTATOR: 3}
)
"""Shapes a category where nobody says; None for all."""

Measurement = PatchMeasurement | BoundaryMeasurement | ModelRefinementMeasurement | AnnotatingMeasurement


@dataclass(frozen=True, slots=True)
class ToolboxRequest:
    """What to measure. limit : shapes a category, None for `USUAL_LIMITS`. predictions : as `tasks` takes them.

    Raises
    ------
    ParameterError : nothing to measure, or no targets, or one outside (0, 1].
    """

    folder: Path
    subjects: tuple[Subject, ...] = tuple(Subject)
    limit: int | None = None
    seed: int = 0
    targets: tuple[float, ...] = TARGETS
    predictions: Path | None = None

    def __post_init__(self) -> None:
        if not self.subjects:
            raise ParameterError(f"there must be something to measure but nothing is named; choose of {_choices()}")
        if not self.targets or not all(0 < target <= 1 for target in self.targets):
            raise ParameterError(f"targets must be in (0, 1] but are {list(self.targets)}; 0.95 is usual")

    def limit_of(self, subject: Subject) -> int | None:
        return USUAL_LIMITS[subject] if self.limit is None else self.limit


@dataclass(frozen=True, slots=True)
class Measured:
    """One subject: its measurement, processor seconds, how many shapes it was of, and why others were left out."""

    subject: Subject
    result: Measurement
    core_s: float
    n_shapes: int
    refused: tuple[str, ...]


def parse_subjects(text: str | None) -> tuple[Subject, ...]:
    """Of names with commas between them, in the usual order; all without.

    Raises
    ------
    ParameterError : a name that is no subject.
    """
    if text is None:
        return tuple(Subject)
    names = {name.strip() for name in text.split(",")}
    unknown = sorted(names - {subject.value for subject in Subject})
    if unknown:
        raise ParameterError(f"--only must name some of {_choices()} but names {unknown[0]!r}; correct it")
    return tuple(subject for subject in Subject if subject.value in names)


def run_toolbox(request: ToolboxRequest, on_progress: Callable[[str], Advance]) -> Iterator[Measured]:
    """Subject after subject. `on_progress` gives, for a title, what is told how far it is.

    Raises
    ------
    NotFoundError, NotEnoughDataError : the folder is missing or has no labelled meshes, or none that can be used.
    """
    files = labelled_files(request.folder, on_progress("read parts"))
    for subject in request.subjects:
        chosen = sampled(files, request.limit_of(subject))
        advance, n_done = on_progress(subject.value), 0

        def on_shape(name: str, advance: Advance = advance, total: int = len(chosen)) -> None:
            nonlocal n_done
            n_done += 1
            advance(n_done, total, name)

        started, refused = time.process_time(), list[str]()
        result = _measure(subject, request, chosen, on_shape, refused)
        yield Measured(subject, result, round(time.process_time() - started, 2), n_done, tuple(refused))


def toolbox_json(request: ToolboxRequest, measured: Sequence[Measured]) -> dict[str, Any]:
    """Plain numbers, strings, lists and dicts: the request, processor seconds, and each subject's own JSON."""
    return {
        "folder": str(request.folder),
        "seed": request.seed,
        "n_shapes": {each.subject.value: each.n_shapes for each in measured},
        "core_s": {each.subject.value: each.core_s for each in measured},
        **{each.subject.value: each.result.as_json() for each in measured},
    }


def _measure(
    subject: Subject,
    request: ToolboxRequest,
    files: Sequence[ShapeFile],
    on_shape: Callable[[str], None],
    refused: list[str],
) -> Measurement:
    if subject is Subject.PATCHES:
        return measure_patches((file.read() for file in files), on_shape=on_shape)
    if subject is Subject.ANNOTATOR:
        shapes = tasks(files, request.predictions, refused)
        return measure_annotating(shapes, request.seed, request.targets, on_shape)
    labelled: Iterator[TrueShape] = (shape for _, shape in fully_labelled(files, refused))
    if subject is Subject.BOUNDARIES:
        return measure_boundary_refinement(labelled, request.seed, on_shape=on_shape)
    return measure_model_refinement_time(labelled, request.seed, on_shape=on_shape)


def _choices() -> str:
    return ", ".join(subject.value for subject in Subject)
