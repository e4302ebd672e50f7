"""What boundary refinement gains where boundaries are off, and loses where they are true; what both refinements cost.

Boundaries of the truth are displaced (`displacement.py`), refined pass after pass, and compared with the truth; so is
the truth itself. The other start is what an annotator gives: 40 patches, half of them labelled.
"""

import time
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import asdict, dataclass, replace
from types import MappingProxyType
from typing import Any

import numpy as np
from jaxtyping import Float, Int

from partwise.errors import NotEnoughDataError
from partwise.features.shape_diameter import shape_diameter
from partwise.geometry.faces import face_areas
from partwise.mesh import TriMesh
from partwise.metrics.accuracy import accuracy_by_area
from partwise.metrics.boundary_distance import boundary_distance
from partwise.segmentation.boundary_refinement import BoundaryRefiner
from partwise.segmentation.model_refinement import RefinementProblem
from partwise.segmentation.parameters import PAPER_BOUNDARY, BoundaryParameters
from partwise.segmentation.random_walk_patches import RandomWalkPatches
from partwise.unlabelled import NO_CLASS
from partwise_cli.bench.displacement import FURTHEST, WAVELENGTH, displaced
from partwise_cli.bench.patches import TrueShape, best_labels
from partwise_cli.bench.shape_random import shape_rng

N_PASSES = 5
N_PATCHES = 40
VARIANTS: Mapping[str, BoundaryParameters] = MappingProxyType(
    {
        "default": BoundaryParameters(),
        "default_plain": replace(BoundaryParameters(), angle_weight=1.0),
        "paper": PAPER_BOUNDARY,
        "paper_plain": replace(PAPER_BOUNDARY, angle_weight=1.0),
    }
)
"""Each form with shape diameters and, plain, without."""


@dataclass(frozen=True, slots=True)
class BoundaryRow:
    """One variant on one shape. Accuracies are shares of area in [0, 1], distances fractions of the diagonal.

    displaced, true : accuracy, and displaced_distance, true_distance : boundary distance, of each start and after each
        pass, so one more than there are passes. Passes have no anchor: each starts afresh from the labels of the last.
    patches : accuracy of half the patches filled up with the nearest part, and after one pass.
    first_core_ms : processor milliseconds of preparing the mesh and one pass. pass_core_ms : of one more pass.
    """

    shape: str
    n_faces: int
    n_parts: int
    variant: str
    displaced: tuple[float, ...]
    true: tuple[float, ...]
    displaced_distance: tuple[float, ...]
    true_distance: tuple[float, ...]
    patches: tuple[float, float]
    first_core_ms: float
    pass_core_ms: float


@dataclass(frozen=True, slots=True)
class BoundaryMeasurement:
    """All rows, and the seed and size of the displacement."""

    seed: int
    furthest: float
    wavelength: float
    rows: tuple[BoundaryRow, ...]

    @property
    def _variants(self) -> list[str]:
        return list(dict.fromkeys(row.variant for row in self.rows))

    def mean(self, variant: str, category: str | None = None) -> dict[str, Any]:
        """Means over shapes, each counting the same. Gain and loss in points of area per pass, distances in percent of
        the diagonal. category : shapes `<category>/…` only; None for all."""
        rows = [row for row in self.rows if row.variant == variant and category in (None, category_of(row.shape))]

        def mean_of(name: str) -> Float[np.ndarray, " n"]:
            return 100 * np.mean([getattr(row, name) for row in rows], axis=0)

        start, *passes = mean_of("displaced")
        filled, refined = mean_of("patches")
        return {
            "displaced": round(float(start), 3),
            "gain": [round(float(value - start), 3) for value in passes],
            "loss": [round(float(100 - value), 3) for value in mean_of("true")[1:]],
            "displaced_distance": mean_of("displaced_distance").round(4).tolist(),
            "true_distance": mean_of("true_distance").round(4).tolist(),
            "half_of_patches_filled": round(float(filled), 3),
            "half_of_patches_refined": round(float(refined), 3),
            "first_core_ms_at_10k_faces": _median_at_10k([(row.first_core_ms, row.n_faces) for row in rows]),
            "pass_core_ms_at_10k_faces": _median_at_10k([(row.pass_core_ms, row.n_faces) for row in rows]),
        }

    def as_json(self) -> dict[str, Any]:
        """Plain numbers, strings, lists and dicts."""
        return {
            "seed": self.seed,
            "furthest": self.furthest,
            "wavelength": self.wavelength,
            "n_shapes": len({row.shape for row in self.rows}),
            "means": {variant: self.mean(variant) for variant in self._variants},
            "by_category": {
                category: {variant: self.mean(variant, category) for variant in self._variants}
                for category in sorted({category_of(row.shape) for row in self.rows})
            },
            "rows": [_plain(row) for row in self.rows],
        }


def category_of(shape: str) -> str:
    """`Cup` of `Cup/21`; empty where shapes have no categories."""
    return shape.rpartition("/")[0]


@dataclass(frozen=True, slots=True)
class ModelRefinementRow:
    """first_core_ms : processor milliseconds of costs and one cut. solve_core_ms : of one more cut, for another λ."""

    shape: str
    n_faces: int
    n_labels: int
    first_core_ms: float
    solve_core_ms: float


@dataclass(frozen=True, slots=True)
class ModelRefinementMeasurement:
    """All rows, and the seed of the probabilities."""

    seed: int
    rows: tuple[ModelRefinementRow, ...]

    def as_json(self) -> dict[str, Any]:
        """Plain numbers, strings, lists and dicts."""
        times = {
            str(n): {
                name: _median_at_10k([(getattr(row, name), row.n_faces) for row in self.rows if row.n_labels == n])
                for name in ("first_core_ms", "solve_core_ms")
            }
            for n in sorted({row.n_labels for row in self.rows})
        }
        return {"seed": self.seed, "core_ms_at_10k_faces": times, "rows": [_plain(row) for row in self.rows]}


def measure_boundary_refinement(
    shapes: Iterable[TrueShape],
    seed: int,
    n_passes: int = N_PASSES,
    furthest: float = FURTHEST,
    wavelength: float = WAVELENGTH,
    on_shape: Callable[[str], None] | None = None,
) -> BoundaryMeasurement:
    """Every variant on every shape, one shape at a time; each shape has random numbers of its own.

    Raises
    ------
    NotEnoughDataError : no shapes.
    LabelError : a shape with unlabelled faces.
    """
    rows: list[BoundaryRow] = []
    for shape in shapes:
        rng = shape_rng(seed, shape.name, "boundaries")
        moved = displaced(shape.mesh, shape.truth, rng, furthest, wavelength)
        diameters = shape_diameter(shape.mesh).astype(np.float64)
        patches = RandomWalkPatches(shape.mesh, diameters).patches(min(N_PATCHES, shape.mesh.n_faces))
        partly = half_labelled(patches, shape.truth, face_areas(shape.mesh), rng)
        rows += [_measured(shape, variant, (moved, partly), diameters, n_passes) for variant in VARIANTS]
        if on_shape is not None:
            on_shape(shape.name)
    if not rows:
        raise NotEnoughDataError("refinement is measured on labelled shapes but there are none; name a folder of some")
    return BoundaryMeasurement(seed, furthest, wavelength, tuple(rows))


def measure_model_refinement_time(
    shapes: Iterable[TrueShape],
    seed: int,
    n_labels: Sequence[int] = (4, 8),
    on_shape: Callable[[str], None] | None = None,
) -> ModelRefinementMeasurement:
    """Times the cut on probabilities that favour displaced truth, with noise on every face: harder than a model's.

    Raises
    ------
    NotEnoughDataError : no shapes.
    LabelError : a shape with unlabelled faces.
    """
    rows: list[ModelRefinementRow] = []
    for shape in shapes:
        rng = shape_rng(seed, shape.name, "model")
        moved = displaced(shape.mesh, shape.truth, rng)
        rows += [_timed(shape, noisy_probabilities(moved, n, rng)) for n in n_labels]
        if on_shape is not None:
            on_shape(shape.name)
    if not rows:
        raise NotEnoughDataError("refinement is measured on labelled shapes but there are none; name a folder of some")
    return ModelRefinementMeasurement(seed, tuple(rows))


def half_labelled(
    patches: Int[np.ndarray, " m"],
    truth: Int[np.ndarray, " m"],
    areas: Float[np.ndarray, " m"],
    rng: np.random.Generator,
) -> Int[np.ndarray, " m"]:
    """Half the patches, rounded up, with the true part that most of each has, (m,) int64; the others −1.

    The largest patch of every part is among them, as with a person who leaves no part out; the rest is random. So more
    than half are labelled where more than half are the largest of a part.
    """
    best = best_labels(patches, truth, areas)
    n_patches = int(patches.max()) + 1
    size = np.bincount(patches, weights=areas, minlength=n_patches)
    part_of = np.full(n_patches, NO_CLASS)
    part_of[patches] = best
    needed = [int(np.argmax(np.where(part_of == part, size, -1.0))) for part in np.unique(part_of[part_of != NO_CLASS])]
    others = rng.permutation(np.setdiff1d(np.arange(n_patches), needed))
    chosen = np.concatenate([needed, others]).astype(np.int64)[: max(len(needed), (n_patches + 1) // 2)]
    return np.where(np.isin(patches, chosen), best, NO_CLASS)


def noisy_probabilities(
    labels: Int[np.ndarray, " m"], n_labels: int, rng: np.random.Generator
) -> Float[np.ndarray, "m L"]:
    """Rows that sum to 1 and favour each face's label (modulo their number), with Gaussian noise on the logits."""
    logits = rng.standard_normal((len(labels), n_labels))
    logits[np.arange(len(labels)), labels % n_labels] += 3.0
    weights = np.exp(logits)
    return weights / weights.sum(axis=1, keepdims=True)


def _measured(
    shape: TrueShape,
    variant: str,
    starts: tuple[Int[np.ndarray, " m"], Int[np.ndarray, " m"]],
    diameters: Float[np.ndarray, " m"],
    n_passes: int,
) -> BoundaryRow:
    moved, partly = starts
    mesh, truth, parameters, areas = shape.mesh, shape.truth, VARIANTS[variant], face_areas(shape.mesh)
    started = time.process_time()
    refiner = BoundaryRefiner.build(mesh, diameters)
    refiner.refine(moved, parameters)
    prepared = time.process_time()
    refiner.refine(moved, parameters)
    finished = time.process_time()
    displaced_passes, true_passes = (_passes(refiner, labels, parameters, n_passes) for labels in (moved, truth))
    filled, refined = refiner.filled(partly), refiner.refine(partly, parameters)
    return BoundaryRow(
        shape=shape.name,
        n_faces=mesh.n_faces,
        n_parts=len(np.unique(truth)),
        variant=variant,
        displaced=tuple(accuracy_by_area(labels, truth, areas) for labels in displaced_passes),
        true=tuple(accuracy_by_area(labels, truth, areas) for labels in true_passes),
        displaced_distance=_distances(mesh, displaced_passes, truth),
        true_distance=_distances(mesh, true_passes, truth),
        patches=(accuracy_by_area(filled, truth, areas), accuracy_by_area(refined, truth, areas)),
        first_core_ms=round(1000 * (prepared - started), 2),
        pass_core_ms=round(1000 * (finished - prepared), 2),
    )


def _passes(
    refiner: BoundaryRefiner, labels: Int[np.ndarray, " m"], parameters: BoundaryParameters, n_passes: int
) -> list[Int[np.ndarray, " m"]]:
    reached = [labels]
    for _ in range(n_passes):
        latest = refiner.refine(reached[-1], parameters)
        if np.array_equal(latest, reached[-1]):  # and so would be all that follow
            return reached + [reached[-1]] * (n_passes + 1 - len(reached))
        reached.append(latest)
    return reached


def _distances(
    mesh: TriMesh, labellings: Sequence[Int[np.ndarray, " m"]], truth: Int[np.ndarray, " m"]
) -> tuple[float, ...]:
    known: dict[int, float] = {}
    for labels in labellings:
        if id(labels) not in known:  # passes that changed nothing
            known[id(labels)] = boundary_distance(mesh, labels, truth)
    return tuple(known[id(labels)] for labels in labellings)


def _timed(shape: TrueShape, probabilities: Float[np.ndarray, "m L"]) -> ModelRefinementRow:
    started = time.process_time()
    problem = RefinementProblem.build(shape.mesh, probabilities)
    problem.solve(1.0)
    solved = time.process_time()
    problem.solve(0.5)
    again = time.process_time()
    first_ms, again_ms = round(1000 * (solved - started), 2), round(1000 * (again - solved), 2)
    return ModelRefinementRow(shape.name, shape.mesh.n_faces, probabilities.shape[1], first_ms, again_ms)


def _median_at_10k(times: Sequence[tuple[float, int]]) -> float:
    """Median over shapes of milliseconds scaled to 10,000 faces."""
    return round(float(np.median([ms * 1e4 / n_faces for ms, n_faces in times])), 2)


def _plain(row: BoundaryRow | ModelRefinementRow) -> dict[str, Any]:
    return {name: list(value) if isinstance(value, tuple) else value for name, value in asdict(row).items()}
