"""The Potts energy of a labelling on a graph of faces."""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float, Int

from partwise.errors import LabelError, ParameterError


@dataclass(frozen=True, slots=True, eq=False)
class LabelProblem:
    """Cost of labelling m nodes with L labels: Σ unary[i, l_i] + Σ weights[e]·[l_i ≠ l_j] over edges e = (i, j).

    unary : (m, L) float64, finite; cost of each label at each node.
    edges : (k, 2) int64, pairs of different nodes. A pair may come up more than once; its weights add.
    weights : (k,) float64, finite and ≥ 0: Potts with such weights is a metric, as alpha expansion asks.

    Raises
    ------
    ParameterError : a shape does not fit, a value is not finite, a weight is negative, an edge leaves the nodes or is
        a loop.
    """

    unary: Float[np.ndarray, "m L"]
    edges: Int[np.ndarray, "k 2"]
    weights: Float[np.ndarray, " k"]

    def __post_init__(self) -> None:
        if self.unary.ndim != 2 or 0 in self.unary.shape:
            raise ParameterError(
                f"unary must be a non-empty (m, L) array but is {self.unary.shape}; give every label a cost"
            )
        if self.edges.ndim != 2 or self.edges.shape[1] != 2 or self.weights.shape != (len(self.edges),):
            raise ParameterError(
                f"edges must be (k, 2) with a weight each but are {self.edges.shape} and {self.weights.shape}"
            )
        if not np.isfinite(self.unary).all() or not np.isfinite(self.weights).all():
            raise ParameterError(
                "costs and weights must be finite but some are not; floor probabilities before the log"
            )
        if len(self.weights) and float(self.weights.min()) < 0:
            raise ParameterError(f"weights must be ≥ 0 but one is {self.weights.min()}; alpha expansion needs a metric")
        if len(self.edges) and (int(self.edges.min()) < 0 or int(self.edges.max()) >= self.n_nodes):
            raise ParameterError(f"edges must join nodes below {self.n_nodes} but reach {int(self.edges.max())}")
        if (self.edges[:, 0] == self.edges[:, 1]).any():
            raise ParameterError("edges must join two different nodes but some are loops; drop them")

    @property
    def n_nodes(self) -> int:
        return self.unary.shape[0]

    @property
    def n_labels(self) -> int:
        return self.unary.shape[1]


def energy(problem: LabelProblem, labels: Int[np.ndarray, " m"]) -> float:
    """Cost of a labelling, dimensionless.

    Raises
    ------
    LabelError : the labels' number or range does not fit the problem.
    """
    check_labels(problem, labels)
    data = problem.unary[np.arange(problem.n_nodes), labels].sum()
    cut = labels[problem.edges[:, 0]] != labels[problem.edges[:, 1]]
    return float(data + problem.weights[cut].sum())


def check_labels(problem: LabelProblem, labels: Int[np.ndarray, " m"]) -> None:
    """Raises LabelError unless there is one label in [0, L) for each node."""
    if labels.shape != (problem.n_nodes,):
        raise LabelError(f"labels must be ({problem.n_nodes},) but are {labels.shape}; are they another mesh's?")
    if int(labels.min()) < 0 or int(labels.max()) >= problem.n_labels:
        bad = int(labels.min()) if int(labels.min()) < 0 else int(labels.max())
        raise LabelError(f"labels must be in [0, {problem.n_labels}) but one is {bad}; map part ids to columns first")
