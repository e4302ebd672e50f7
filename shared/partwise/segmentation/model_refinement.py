"""Model refinement: per-face probabilities to labels whose boundaries follow concave creases.

`RefinementProblem` holds what does not depend on the smoothness λ, so that trying many λ costs only the cuts.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float, Int

from partwise.errors import LabelError, NotEnoughDataError
from partwise.geometry.adjacency import EdgeAdjacency, edge_adjacency
from partwise.geometry.dihedral import is_concave, normal_angles
from partwise.geometry.faces import face_areas
from partwise.mesh import TriMesh
from partwise.metrics.accuracy import accuracy_by_area
from partwise.segmentation.alpha_expansion import alpha_expansion
from partwise.segmentation.energy import LabelProblem
from partwise.segmentation.parameters import SMOOTHNESS_CANDIDATES, RefinementParameters, check_smoothness

_DEFAULTS = RefinementParameters()
_MOST_PROBABILITY = 1.001  # stored probabilities are float16


@dataclass(frozen=True, slots=True, eq=False)
class RefinementProblem:
    """One mesh and one model's word on it, ready to be solved for any smoothness.

    first_choice : (m,) int64, most probable class of each face.
    at_unit_smoothness : the energy with λ = 1.
    max_sweeps : bound on rounds of alpha expansion.
    """

    first_choice: Int[np.ndarray, " m"]
    at_unit_smoothness: LabelProblem
    max_sweeps: int

    @classmethod
    def build(
        cls,
        mesh: TriMesh,
        probabilities: Float[np.ndarray, "m L"],
        parameters: RefinementParameters = _DEFAULTS,
    ) -> "RefinementProblem":
        """Costs of every label and of every cut; `parameters.smoothness` is not used here.

        Raises
        ------
        LabelError : not one row per face, or values that are no probabilities.
        """
        _check_probabilities(mesh, probabilities)
        adjacency = edge_adjacency(mesh)
        problem = LabelProblem(
            unary=data_costs(probabilities, face_areas(mesh), parameters),
            edges=adjacency.faces,
            weights=boundary_costs(mesh, adjacency, parameters),
        )
        return cls(np.argmax(probabilities, axis=1), problem, parameters.max_sweeps)

    def solve(self, smoothness: float) -> Int[np.ndarray, " m"]:
        """Class of each face, (m,) int64, columns of the probabilities. 0 gives the most probable class everywhere."""
        check_smoothness(smoothness)
        base = self.at_unit_smoothness
        problem = LabelProblem(base.unary, base.edges, base.weights * smoothness)
        return alpha_expansion(problem, self.first_choice, self.max_sweeps)


@dataclass(frozen=True, slots=True)
class SmoothnessChoice:
    """The λ with the highest accuracy, the smallest of equals, and what each candidate reached.

    accuracy_by_area : for each candidate, the mean over shapes of the share of labelled area that is right.
    """

    smoothness: float
    candidates: tuple[float, ...]
    accuracy_by_area: tuple[float, ...]


def refine(
    mesh: TriMesh, probabilities: Float[np.ndarray, "m L"], parameters: RefinementParameters = _DEFAULTS
) -> Int[np.ndarray, " m"]:
    """Class of each face, (m,) int64, that minimises Σ D + λ·Σ φ_S over labels, approximately.

    D(f, l) = −log max(p_f(l), floor)·A_f/mean A; φ_S = −log max(floor, c·a/π)·|e|/mean|e| where labels differ, a being
    the angle between normals and c = 1 at concave, 0.08 at convex edges.

    Raises
    ------
    LabelError : not one row of probabilities per face, or values that are no probabilities.

    Source: George et al. 2018. Differs: the paper prints ξ_D as a probability and minimises it; here both are costs
    ≥ 0, and angles are floored, so that alpha expansion's metric condition holds.
    """
    return RefinementProblem.build(mesh, probabilities, parameters).solve(parameters.smoothness)


def tune_smoothness(
    problems: Sequence[RefinementProblem],
    true_labels: Sequence[Int[np.ndarray, " m"]],
    areas: Sequence[Float[np.ndarray, " m"]],
    candidates: Sequence[float] = SMOOTHNESS_CANDIDATES,
) -> SmoothnessChoice:
    """Tries each λ on labelled shapes. True labels are columns of the probabilities, −1 where unlabelled.

    Raises
    ------
    NotEnoughDataError : no shapes, no candidates, or a shape without labelled area.
    LabelError : labels or areas do not fit their problem.
    """
    if not problems or not candidates:
        raise NotEnoughDataError(
            f"tuning needs shapes and candidates but has {len(problems)} and {len(candidates)}; confirm shapes first"
        )
    if not len(problems) == len(true_labels) == len(areas):
        raise LabelError(
            f"every problem must have labels and areas but there are {len(problems)}, {len(true_labels)}, {len(areas)}"
        )
    ordered = tuple(sorted(candidates))
    shapes = list(zip(problems, true_labels, areas, strict=True))
    reached = tuple(
        float(np.mean([accuracy_by_area(problem.solve(smoothness), truth, area) for problem, truth, area in shapes]))
        for smoothness in ordered
    )
    return SmoothnessChoice(ordered[int(np.argmax(reached))], ordered, reached)


def data_costs(
    probabilities: Float[np.ndarray, "m L"], areas: Float[np.ndarray, " m"], parameters: RefinementParameters
) -> Float[np.ndarray, "m L"]:
    """D(f, l), (m, L) float64, dimensionless, ≥ 0. A mesh without area counts its faces alike."""
    cost = -np.log(np.clip(probabilities.astype(np.float64), parameters.probability_floor, 1.0))
    mean = float(areas.mean())
    if not parameters.weight_by_area or not mean > 0:
        return cost
    return cost * (areas / mean)[:, None]


def boundary_costs(
    mesh: TriMesh, adjacency: EdgeAdjacency, parameters: RefinementParameters
) -> Float[np.ndarray, " k"]:
    """φ_S of each pair of faces, (k,) float64, dimensionless, ≥ 0; 0 for edges without length."""
    if not adjacency.lengths.any():
        return np.zeros(len(adjacency.lengths))
    c = np.where(is_concave(mesh, adjacency), 1.0, parameters.convex_factor)
    sharpness = np.clip(c * normal_angles(mesh, adjacency) / np.pi, parameters.angle_floor, 1.0)
    return -np.log(sharpness) * (adjacency.lengths / adjacency.lengths.mean())


def _check_probabilities(mesh: TriMesh, probabilities: np.ndarray) -> None:
    if probabilities.ndim != 2 or probabilities.shape[0] != mesh.n_faces or probabilities.shape[1] == 0:
        raise LabelError(
            f"probabilities must be ({mesh.n_faces}, L) but are {probabilities.shape}; are they another mesh's?"
        )
    if not (probabilities.min() >= 0 and probabilities.max() <= _MOST_PROBABILITY):  # NaN fails this too
        raise LabelError(
            f"probabilities must lie in [0, 1] but span {probabilities.min()} to {probabilities.max()}; logits?"
        )
