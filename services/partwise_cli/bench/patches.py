"""What over-segmentation allows: how much of a shape is right if each patch takes the true part that most of it has."""

import time
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from functools import partial
from typing import Any

import numpy as np
from jaxtyping import Float, Int

from partwise.errors import NotEnoughDataError
from partwise.features.shape_diameter import shape_diameter
from partwise.geometry.faces import face_areas
from partwise.mesh import TriMesh
from partwise.metrics.accuracy import accuracy_by_area
from partwise.segmentation.k_means_patches import KMeansPatches
from partwise.segmentation.patch_parameters import PatchMethod
from partwise.segmentation.patches import OverSegmentation
from partwise.segmentation.random_walk_patches import RandomWalkPatches
from partwise.unlabelled import NO_CLASS

N_PATCHES = (10, 20, 40, 80)


@dataclass(frozen=True, slots=True, eq=False)
class TrueShape:
    """A mesh and its true parts, (m,) int64 from 0, −1 where unknown."""

    name: str
    mesh: TriMesh
    truth: Int[np.ndarray, " m"]


@dataclass(frozen=True, slots=True)
class PatchRow:
    """One method on one shape.

    prepare_core_s : processor seconds of what is done once, the shape diameter not included.
    accuracy : for each of N_PATCHES, the upper bound by area, in [0, 1].
    core_ms : for each of N_PATCHES, processor milliseconds of a cut.
    """

    shape: str
    n_faces: int
    method: PatchMethod
    prepare_core_s: float
    accuracy: tuple[float, ...]
    core_ms: tuple[float, ...]


@dataclass(frozen=True, slots=True)
class PatchMeasurement:
    """All rows; `as_json` adds each method's means over the shapes and how far random walks are ahead."""

    n_patches: tuple[int, ...]
    rows: tuple[PatchRow, ...]

    def mean_accuracy(self, method: PatchMethod) -> tuple[float, ...]:
        """Upper bound by area for each number of patches, in [0, 1]; each shape counts the same."""
        return tuple(np.mean([row.accuracy for row in self.rows if row.method == method], axis=0).tolist())

    def as_json(self) -> dict[str, Any]:
        """Plain numbers, strings, lists and dicts. Shares in [0, 1]; lists run along n_patches."""
        walks, k_means = self.mean_accuracy("random_walks"), self.mean_accuracy("k_means")
        return {
            "n_patches": list(self.n_patches),
            "n_shapes": len({row.shape for row in self.rows}),
            "accuracy": {"random_walks": list(walks), "k_means": list(k_means)},
            "ahead": [first - second for first, second in zip(walks, k_means, strict=True)],
            "core_ms_at_10k_faces": {method: self._core_ms_at_10k(method) for method in ("random_walks", "k_means")},
            "rows": [
                {
                    "shape": row.shape,
                    "n_faces": row.n_faces,
                    "method": row.method,
                    "prepare_core_s": row.prepare_core_s,
                    "accuracy": list(row.accuracy),
                    "core_ms": list(row.core_ms),
                }
                for row in self.rows
            ],
        }

    def _core_ms_at_10k(self, method: str) -> list[float]:
        """Median over shapes of the time of a cut, scaled to 10,000 faces."""
        scaled = [np.array(row.core_ms) * 1e4 / row.n_faces for row in self.rows if row.method == method]
        return [round(value, 2) for value in np.median(scaled, axis=0).tolist()]


def measure_patches(
    shapes: Iterable[TrueShape],
    n_patches: Sequence[int] = N_PATCHES,
    on_shape: Callable[[str], None] | None = None,
) -> PatchMeasurement:
    """Cuts each shape by both methods and compares with the truth. Shapes are taken one at a time.

    A shape with fewer faces than patches are asked for is cut into its faces.

    Raises
    ------
    NotEnoughDataError : no shapes, or one without labelled area.
    """
    rows: list[PatchRow] = []
    warm = False
    for shape in shapes:
        diameters = shape_diameter(shape.mesh).astype(np.float64)
        if not warm:  # the first call compiles
            RandomWalkPatches(shape.mesh, diameters).patches(1)
            warm = True
        rows.append(_measured(shape, "random_walks", partial(RandomWalkPatches, shape.mesh, diameters), n_patches))
        rows.append(_measured(shape, "k_means", partial(KMeansPatches, shape.mesh), n_patches))
        if on_shape is not None:
            on_shape(shape.name)
    if not rows:
        raise NotEnoughDataError(
            "patches are measured on labelled shapes but there are none; name a folder that has some"
        )
    return PatchMeasurement(tuple(n_patches), tuple(rows))


def best_labels(
    patches: Int[np.ndarray, " m"], truth: Int[np.ndarray, " m"], areas: Float[np.ndarray, " m"]
) -> Int[np.ndarray, " m"]:
    """Each patch's true part of most area, for each of its faces, (m,) int64; −1 where a patch has no known truth.

    Ties go to the lower part.
    """
    known = truth != NO_CLASS
    n_parts = int(truth.max(initial=0)) + 1
    table = np.bincount(
        patches[known] * n_parts + truth[known], weights=areas[known], minlength=(int(patches.max()) + 1) * n_parts
    ).reshape(-1, n_parts)
    best = np.where(table.any(axis=1), np.argmax(table, axis=1), NO_CLASS)
    return best[patches]


def _measured(
    shape: TrueShape, method: PatchMethod, prepare: Callable[[], OverSegmentation], n_patches: Sequence[int]
) -> PatchRow:
    areas = face_areas(shape.mesh)
    started = time.process_time()
    prepared = prepare()
    prepare_core_s = time.process_time() - started
    accuracies, core_ms = [], []
    for n in n_patches:
        started = time.process_time()
        patches = prepared.patches(min(n, shape.mesh.n_faces))
        core_ms.append(round(1000 * (time.process_time() - started), 3))
        accuracies.append(accuracy_by_area(best_labels(patches, shape.truth, areas), shape.truth, areas))
    return PatchRow(shape.name, shape.mesh.n_faces, method, round(prepare_core_s, 4), tuple(accuracies), tuple(core_ms))
