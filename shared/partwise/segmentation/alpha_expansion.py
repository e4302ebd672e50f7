"""Alpha expansion: many labels by a series of two-label minimum cuts."""

import maxflow
import numpy as np
from jaxtyping import Int

from partwise.segmentation.energy import LabelProblem, check_labels, energy

_RELATIVE_GAIN = 1e-12  # less than this is rounding in the sums, not a better labelling


def alpha_expansion(
    problem: LabelProblem, initial: Int[np.ndarray, " m"], max_sweeps: int = 20
) -> Int[np.ndarray, " m"]:
    """Labelling that no expansion of a single label improves, within twice the least energy there is.

    A sweep tries each label once, cheapest in total first, so that the result does not depend on how labels are
    numbered. A move is accepted only if the energy falls; nodes that a move leaves indifferent keep their label.

    Parameters
    ----------
    problem : costs and graph.
    initial : (m,) int64 in [0, L), where to start; returned unchanged if no move helps.
    max_sweeps : bound on rounds over all labels.

    Returns
    -------
    labels : (m,) int64.

    Raises
    ------
    LabelError : `initial` does not fit the problem.

    Source: Boykov, Veksler, Zabih 2001; max-flow of Boykov & Kolmogorov 2004.
    """
    check_labels(problem, initial)
    labels = initial.astype(np.int64)
    lowest = energy(problem, labels)
    order = np.argsort(problem.unary.sum(axis=0), kind="stable").tolist()
    n_idle = 0
    for alpha in order * max_sweeps:
        proposal = _expand(problem, labels, alpha)
        reached = energy(problem, proposal)
        if reached < lowest - _RELATIVE_GAIN * abs(lowest):
            labels, lowest, n_idle = proposal, reached, 0
        n_idle += 1
        if n_idle >= problem.n_labels:  # every label has been tried since the last gain
            break
    return labels


def _expand(problem: LabelProblem, labels: Int[np.ndarray, " m"], alpha: int) -> Int[np.ndarray, " m"]:
    """Best labelling in which each node keeps its label (x = 0) or takes `alpha` (x = 1): one minimum cut.

    With A, B, C the edge's costs at x = (0,0), (0,1), (1,0) and 0 at (1,1), the cost of an edge is
    A + (C−A)·x_i − C·x_j + (B+C−A)·(1−x_i)·x_j, and B + C ≥ A because Potts is a metric.
    """
    i, j = problem.edges[:, 0], problem.edges[:, 1]
    w = problem.weights
    at_both, at_first, at_second = labels[i] != labels[j], labels[j] != alpha, labels[i] != alpha
    A, B, C = w * at_both, w * at_second, w * at_first
    m = problem.n_nodes
    take = problem.unary[:, alpha].copy()
    keep = problem.unary[np.arange(m), labels]
    take += np.bincount(i, weights=C - A, minlength=m)
    take -= np.bincount(j, weights=C, minlength=m)
    graph = maxflow.GraphFloat(m, len(w))
    nodes = graph.add_grid_nodes(m)
    capacity = B + C - A
    used = capacity > 0
    graph.add_edges(i[used], j[used], capacity[used], np.zeros(int(used.sum())))
    # Only the difference matters, and capacities may not be negative. Paying the source's side means x = 1.
    difference = take - keep
    graph.add_grid_tedges(nodes, np.maximum(difference, 0.0), np.maximum(-difference, 0.0))
    graph.maxflow()
    return np.where(graph.get_grid_segments(nodes), alpha, labels)
