"""`fit`: from labelled shapes to a model and, by inner validation, the smoothness of its graph cut.

What a confirmed shape triggers and what leave-one-out measures are this one function.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np
from jaxtyping import Int64

from partwise.errors import NotEnoughDataError
from partwise.geometry.faces import face_areas
from partwise.learning.dataset import CodedGrids, FacePool, LabelledFaces
from partwise.learning.ensemble import predict
from partwise.learning.model import TrainedModel
from partwise.learning.network import NetworkSpec
from partwise.learning.recipe import Recipe
from partwise.learning.trainer import train
from partwise.mesh import TriMesh
from partwise.segmentation.model_refinement import RefinementProblem, SmoothnessChoice, tune_smoothness
from partwise.segmentation.parameters import RefinementParameters

MIN_SHAPES_TO_TUNE = 3
VALIDATION_SHARE = 0.2
MAX_VALIDATION_SHAPES = 10
MAX_INNER_SHAPES = 200
"""The inner model learns from at most so many shapes: it only has to be about as unsure as the real one."""


@dataclass(frozen=True, slots=True, eq=False)
class LabelledShape:
    """A described mesh and its labels.

    grids : branch name to histograms of all m faces. classes : (m,) int64 into the part ids, −1 unlabelled.
    """

    mesh: TriMesh
    grids: dict[str, CodedGrids]
    classes: Int64[np.ndarray, " m"]


@dataclass(frozen=True, slots=True, eq=False)
class Fitted:
    """A model, and the smoothness chosen for it; None where there were too few shapes to choose."""

    model: TrainedModel
    tuning: SmoothnessChoice | None


def fit(
    shapes: Sequence[LabelledShape],
    part_ids: tuple[int, ...],
    recipe: Recipe,
    refinement: RefinementParameters | None,
    progress: Callable[[int, int], None] | None = None,
    n_threads: int | None = None,
) -> Fitted:
    """Trains on all shapes. With `refinement`, first chooses its smoothness on a fifth of them, held out.

    The inner model that the fifth is predicted with trains for one of the recipe's M cycles on the other shapes, so
    tuning adds about 1/M to the time. Shapes are read one at a time, so the sequence may load them as it is indexed.

    Parameters
    ----------
    progress : called with (iterations done, iterations in all), the inner model's included.

    Raises
    ------
    NotEnoughDataError : no shape has a labelled face.

    Source: George et al. 2018 tune λ on the training set. Differs: on held-out shapes, as a network is too sure of
    shapes it has seen.
    """
    if len(shapes) == 0:
        raise NotEnoughDataError("training needs at least one labelled shape but there is none; confirm some first")
    tunes = refinement is not None and len(shapes) >= MIN_SHAPES_TO_TUNE
    inner = replace(recipe, n_iterations=max(1, recipe.n_iterations // recipe.n_snapshots), n_snapshots=1)
    n_inner = inner.n_iterations if tunes else 0
    n_total = n_inner + recipe.n_iterations

    def report(offset: int) -> Callable[[int, float], None] | None:
        return None if progress is None else lambda done, _loss: progress(offset + done, n_total)

    tuning = None
    if tunes and refinement is not None:
        tuning = _tune(shapes, part_ids, inner, refinement, report(0), n_threads)
    model = _train(shapes, range(len(shapes)), part_ids, recipe, report(n_inner), n_threads)
    return Fitted(model, tuning)


def _train(
    shapes: Sequence[LabelledShape],
    chosen: Sequence[int],
    part_ids: tuple[int, ...],
    recipe: Recipe,
    progress: Callable[[int, float], None] | None,
    n_threads: int | None,
) -> TrainedModel:
    faces = (LabelledFaces(shape.grids, shape.classes) for shape in (shapes[index] for index in chosen))
    pool = FacePool.from_shapes(faces, part_ids, recipe.n_draws, np.random.default_rng(recipe.seed))
    return train(pool, NetworkSpec(len(part_ids)), recipe, progress, n_threads=n_threads)


def _tune(
    shapes: Sequence[LabelledShape],
    part_ids: tuple[int, ...],
    recipe: Recipe,
    refinement: RefinementParameters,
    progress: Callable[[int, float], None] | None,
    n_threads: int | None,
) -> SmoothnessChoice:
    order = np.random.default_rng(recipe.seed).permutation(len(shapes)).tolist()
    n_validation = min(MAX_VALIDATION_SHAPES, max(1, round(VALIDATION_SHARE * len(shapes))))
    held_out, others = order[:n_validation], order[n_validation : n_validation + MAX_INNER_SHAPES]
    model = _train(shapes, sorted(others), part_ids, recipe, progress, n_threads)
    validation = [shapes[index] for index in held_out]
    validation = [shape for shape in validation if (shape.classes >= 0).any()]
    problems = [
        RefinementProblem.build(shape.mesh, predict(model, shape.grids).probabilities, refinement)
        for shape in validation
    ]
    return tune_smoothness(
        problems, [shape.classes for shape in validation], [face_areas(shape.mesh) for shape in validation]
    )
